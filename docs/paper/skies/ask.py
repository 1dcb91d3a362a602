"""Asks the model (`welkin query`) and the tracer (`welkin-fit trace`) about lines of sight.

What was traced is kept, under all that decides about it, and a trace that was interrupted goes on where it was.
"""

import hashlib
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .views import angles

# Where the lines of water vapour and oxygen, which the tracer's air lacks, take less than 0.1 %.
WAVELENGTHS = [400, 430, 460, 490, 520, 550, 570, 610, 630, 650, 660, 780]
GREEN = [550]
# Lines of sight that are traced and kept together.
PART = 6000


@dataclass(frozen=True)
class Scene:
    """Conditions; lengths in metres, angles in radians."""

    sun_elevation: float
    altitude: float = 0.0
    visibility: float = 59_400.0
    albedo: float = 0.3


@dataclass(frozen=True)
class Air:
    """The air that is traced: as in the model, or varied; or that of a recipe."""

    visibility: float = 59_400.0
    ozone: float | None = None
    aerosol_profile: str = "smooth"
    recipe: str | None = None


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

    def make(self, recipe, *options):
        """A model of one's own, with `welkin-fit make`."""
        key = hashlib.sha256("\0".join([self._version, recipe, *options]).encode()).hexdigest()[:24]
        out = self.kept / f"{key}.welkin"
        if not out.exists():
            run = [str(self.fit), "make", recipe, *options, "--work", str(self.kept / key), "--out", str(out)]
            subprocess.run(run, stdout=sys.stderr, check=True)
        return out

    def model(self, quantity, scene, lines, wavelengths, distance=None, options=()):
        """What the model says, by line of sight and wavelength; `options` name another one, or a value of its axis."""
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
        run = [str(self.welkin), "query", "--strict", *options]
        answer = subprocess.run(run, input="\n".join(rows) + "\n", capture_output=True, text=True, check=False)
        if answer.returncode:
            raise RuntimeError(f"welkin query: {answer.stderr.strip()}")
        values = [float(line.split(",")[-2]) for line in answer.stdout.splitlines()[1:]]
        return np.array(values).reshape(len(lines), len(wavelengths))

    def trace(self, air, scenes, lines, wavelengths, walks, distance=None):
        """The light of the air alone, for each scene: ground that is seen is black, but lights the air.

        No walks: of light that is scattered once, and transmittances.
        """
        queries = self._queries(scenes, lines, distance)
        table = self._kept(self._air(air, wavelengths), queries, walks)
        return [Traced(*part) for part in table.reshape(-1, len(scenes), len(lines), len(wavelengths)).swapaxes(0, 1)]

    def _air(self, air, wavelengths):
        nm = ["--wavelengths", ",".join(map(str, wavelengths))]
        if air.recipe is not None:
            options = [air.recipe, "--set", f"ozone={air.ozone!r}", "--out", "-"]
        else:
            options = ["--visibility", repr(air.visibility / 1e3), "--aerosol-profile", air.aerosol_profile]
            options += [] if air.ozone is None else ["--ozone", repr(air.ozone)]
        run = [str(self.fit), "atmosphere", *options, *nm]
        return subprocess.run(run, capture_output=True, check=True, text=True).stdout

    @staticmethod
    def _queries(scenes, lines, distance):
        rows = ["altitude_m,solar_elevation_deg,albedo,view_zenith_deg,view_azimuth_deg,distance_m"]
        views = list(zip(_degrees(lines), _lengths(distance, len(lines))))
        for scene in scenes:
            sun = float(np.degrees(scene.sun_elevation))
            start = f"{scene.altitude!r},{sun!r},{scene.albedo!r}"
            rows += [f"{start},{zenith!r},{azimuth!r},{metres}" for (zenith, azimuth), metres in views]
        return rows

    def _kept(self, air, queries, walks):
        """The columns of `Traced`, row by row; from parts, each of which is traced once."""
        header, *rows = queries
        parts = [rows[i : i + PART] for i in range(0, len(rows), PART)]
        tables = []
        for i, part in enumerate(parts):
            if sys.stderr.isatty():
                print(f"part {i + 1} of {len(parts)}", file=sys.stderr)
            tables.append(self._part(air, "\n".join([header, *part]) + "\n", walks, seed=1 + i * PART))
        return np.concatenate(tables, 1)

    def _part(self, air, queries, walks, seed):
        order = ["--visible-ground", "black", "--orders", "all" if walks else "single"]
        if walks:
            # Each line of sight has a seed of its own, counted from this one.
            order += ["--walks", str(walks), "--seed", str(seed)]
        key = hashlib.sha256("\0".join([self._version, air, queries, *order]).encode())
        out = self.kept / f"{key.hexdigest()[:24]}.csv"
        if not out.exists():
            with tempfile.TemporaryDirectory(dir=self.kept) as folder:
                files = [Path(folder) / name for name in ("air.json", "queries.csv")]
                for path, content in zip(files, (air, queries)):
                    path.write_text(content, encoding="utf-8")
                run = [str(self.fit), "trace", "--atmosphere", str(files[0]), "--queries", str(files[1]), *order]
                # To standard output: a file of its own for each line of sight takes longer than to trace it.
                answer = subprocess.run(run, stdout=subprocess.PIPE, check=True).stdout
            replace(out, lambda to: to.write_bytes(answer))
        return _read(out)


def _read(path):
    """The columns of `Traced`."""
    with open(path, encoding="utf-8") as file:
        header = file.readline().strip().split(",")
    columns = [header.index(name) for name in ("I", "Q", "U", "I_se", "transmittance")]
    return np.loadtxt(path, delimiter=",", skiprows=1, usecols=columns, ndmin=2).T


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
