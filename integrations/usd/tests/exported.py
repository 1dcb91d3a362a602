"""Calls of the command that is tested."""

import itertools
import json
import math
import os
import subprocess
from pathlib import Path

import numpy as np
import OpenEXR

WELKIN = os.environ["WELKIN"]
# Libraries keep layers by their paths.
NUMBERS = itertools.count()


def export(folder: Path, renderer: str, *options: str) -> Path:
    """The path of the layer."""
    out = folder / f"sky-{next(NUMBERS)}"
    call = [WELKIN, "export", "--for", renderer, "--out", str(out), *options]
    subprocess.run(call, check=True, stdout=subprocess.PIPE)
    return out.with_suffix(".usda")


def light(*options: str) -> dict:
    """What `welkin light` says of the same sky."""
    return json.loads(subprocess.run([WELKIN, "light", "--json", *options], check=True, stdout=subprocess.PIPE).stdout)


def sky(elevation: float, azimuth: float) -> list[str]:
    """Options for a sun."""
    return ["--sun-elevation", str(elevation), "--sun-azimuth", str(azimuth)]


def sun(elevation: float, azimuth: float, up: str = "z") -> np.ndarray:
    """Unit vector to the sun in the axes of a stage."""
    e, a = math.radians(elevation), math.radians(azimuth)
    x, y, z = math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)
    return np.array([x, z, -y] if up == "y" else [x, y, z])


def pixels(path: Path) -> np.ndarray:
    """Rows of columns of red, green and blue."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        return np.stack([channels[name].pixels for name in "RGB"], axis=-1).astype(np.float64)
