"""The test scene by brute force: walks through the air by `welkin-fit picture`, in passes that are kept."""

import os
import subprocess

import mitsuba as mi
import numpy as np

import towers

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3)


def command():
    """Path of `welkin-fit`; `cargo build --release -p welkin-fitter` makes it."""
    target = os.environ.get("CARGO_TARGET_DIR", os.path.join(ROOT, "target"))
    path = os.path.abspath(os.path.join(target, "release", "welkin-fit"))
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path} is not there: cargo build --release -p welkin-fitter makes it")
    return path


def _write_scene(folder):
    for name, text in towers.obj().items():
        path = os.path.join(folder, name)
        with open(path + ".part", "w", encoding="ascii") as file:
            file.write(text)
        os.replace(path + ".part", path)


def _read(path):
    """Linear sRGB (height, width, 3) and the standard error of luminance, cd m⁻²."""
    bitmap = mi.Bitmap(path)
    names = [field.name for field in bitmap.struct_()]
    values = np.array(bitmap, np.float64)
    return values[..., [names.index(name) for name in "RGB"]], values[..., names.index("luminance_error")]


def traced(view, elevation, size, walks, passes, work):
    """The mean of `passes` pictures of `walks` per pixel, and its standard error. What `work` has is not made again."""
    folder = os.path.join(work, f"towers_{size[0]}x{size[1]}_{walks}")
    os.makedirs(folder, exist_ok=True)
    _write_scene(folder)
    total, square = 0.0, 0.0
    for seed in range(1, passes + 1):
        # The command renames what it has finished.
        path = os.path.join(folder, f"{elevation:g}_{seed}.exr")
        if not os.path.exists(path):
            options = {
                "mesh": os.path.join(folder, "towers.obj"), "mesh-at": "0,0", "width": size[0], "height": size[1],
                "field-of-view": view["field_of_view"], "pitch": view["pitch"], "altitude": view["altitude"] / 1e3,
                "solar-elevation": elevation, "solar-azimuth": view["solar_azimuth"],
                "visibility": view["visibility"] / 1e3, "albedo": towers.ALBEDO["ground"][0], "samples": walks,
                "seed": seed, "exr": path,
            }
            flags = [word for name, value in options.items() for word in (f"--{name}", str(value))]
            subprocess.run([command(), "picture", *flags], check=True)
        rgb, error = _read(path)
        total, square = total + rgb, square + error**2
    return total / passes, np.sqrt(square) / passes
