"""Asks the model (`welkin query`) and the tracer (`welkin-fit trace`) about lines of sight.

What was traced is kept, under all that decides about it, and a trace that was interrupted goes on where it was.
"""

import hashlib
import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .views import angles

WAVELENGTHS = list(range(400, 731, 30))
GREEN = [550]


@dataclass(frozen=True)
class Scene:
    """Conditions; lengths in metres, angles in radians."""

    sun_elevation: float
    altitude: float = 0.0
    visibility: float = 59_400.0
    albedo: float = 0.3


@dataclass(frozen=True)
class Air:
    """The air that is traced: as in the model, or varied."""

    visibility: float = 59_400.0
    ozone: float | None = None
    aerosol_profile: str = "smooth"


@dataclass(frozen=True)
class Traced:
    """Per unit of solar irradiance, 1/sr, by line of sight and wavelength; `error` is one standard error of I."""

    radiance: np.ndarray
    q: np.ndarray
    u: np.ndarray
    error: np.ndarray
    transmittance: np.ndarray


class Commands:
    """The two commands, and the folder of what was traced."""

    def __init__(self, binaries, kept):
        self.welkin = Path(binaries) / "welkin"
        self.fit = Path(binaries) / "welkin-fit"
        self.kept = Path(kept)
        self.kept.mkdir(parents=True, exist_ok=True)
        self._version = hashlib.sha256(self.fit.read_bytes()).hexdigest()

    def model(self, quantity, scene, lines, wavelengths, distance=None):
        """What the model says, by line of sight and wavelength."""
        header = (
            "quantity,visibility_km,albedo,altitude_m,solar_elevation_deg,"
            "view_zenith_deg,view_azimuth_deg,wavelength_nm,distance_m"
        )
        sun = np.degrees(scene.sun_elevation)
        start = f"{quantity},{scene.visibility / 1e3!r},{scene.albedo!r},{scene.altitude!r},{float(sun)!r}"
        rows = [header]
        for (zenith, azimuth), metres in zip(_degrees(lines), _lengths(distance, len(lines))):
            rows += [f"{start},{zenith!r},{azimuth!r},{nm!r},{metres}" for nm in wavelengths]
        # A row that got no answer ends the command.
        run = [str(self.welkin), "query", "--strict"]
        answer = subprocess.run(run, input="\n".join(rows) + "\n", capture_output=True, text=True, check=False)
        if answer.returncode:
            raise RuntimeError(f"welkin query: {answer.stderr.strip()}")
        values = [float(line.split(",")[-2]) for line in answer.stdout.splitlines()[1:]]
        return np.array(values).reshape(len(lines), len(wavelengths))

    def trace(self, air, scene, lines, wavelengths, walks, distance=None):
        """The light of the air alone: ground that is seen is black, but lights the air."""
        return self._kept(self._air(air, wavelengths), self._queries(scene, lines, distance), walks, len(wavelengths))

    def _air(self, air, wavelengths):
        options = ["--aerosol-profile", air.aerosol_profile]
        if air.ozone is not None:
            options += ["--ozone", repr(air.ozone)]
        nm = ",".join(map(str, wavelengths))
        run = [str(self.fit), "atmosphere", "--visibility", repr(air.visibility / 1e3), "--wavelengths", nm, *options]
        return subprocess.run(run, capture_output=True, check=True).stdout

    @staticmethod
    def _queries(scene, lines, distance):
        rows = ["altitude_m,solar_elevation_deg,albedo,view_zenith_deg,view_azimuth_deg,distance_m"]
        sun = float(np.degrees(scene.sun_elevation))
        start = f"{scene.altitude!r},{sun!r},{scene.albedo!r}"
        for (zenith, azimuth), metres in zip(_degrees(lines), _lengths(distance, len(lines))):
            rows.append(f"{start},{zenith!r},{azimuth!r},{metres}")
        return ("\n".join(rows) + "\n").encode()

    def _kept(self, air, queries, walks, wavelengths):
        order = ["--visible-ground", "black", "--orders", "all" if walks else "single"]
        if walks:
            order += ["--walks", str(walks)]
        key = hashlib.sha256(b"\0".join([self._version.encode(), air, queries, json.dumps(order).encode()]))
        out = self.kept / f"{key.hexdigest()[:24]}.csv"
        if not out.exists():
            files = {out.with_suffix(".air.json"): air, out.with_suffix(".queries.csv"): queries}
            for path, content in files.items():
                path.write_bytes(content)
            air_file, query_file = map(str, files)
            run = [str(self.fit), "trace", "--atmosphere", air_file, "--queries", query_file, *order, "--out", str(out)]
            subprocess.run(run, check=True, stdout=subprocess.DEVNULL)
            for path in files:
                path.unlink()
        return _read(out, wavelengths)


def _read(path, wavelengths):
    with open(path, encoding="utf-8") as file:
        header = file.readline().strip().split(",")
    names = ["I", "Q", "U", "I_se", "transmittance"]
    columns = [header.index(name) for name in names]
    table = np.loadtxt(path, delimiter=",", skiprows=1, usecols=columns, ndmin=2)
    return Traced(*(column.reshape(-1, wavelengths) for column in table.T))


def _degrees(lines):
    return np.degrees(np.stack(angles(lines), -1)).tolist()


def _lengths(distance, count):
    if distance is None:
        return [""] * count
    return ["" if np.isinf(metres) else repr(float(metres)) for metres in distance]


def replace(path, write):
    """Lets `write` fill a temporary file beside `path`, and renames it."""
    temporary = path.with_name(f".{path.name}.unfinished{path.suffix}")
    try:
        write(temporary)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
