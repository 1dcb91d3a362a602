"""Makes figures: `python -m skies BINARIES KEPT NAME… [--draft] [--fine] [--check] [--out FOLDER]`."""

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from . import against_tracer, altitudes, exponential, frames, haze, inversion, ozone, ozone_axis, panels, transmittance, twilight
from .ask import Commands

FIGURES = {
    "5": ozone,
    "6": inversion,
    "8": altitudes,
    "9": twilight,
    "10": frames,
    "11": transmittance,
    "12": against_tracer,
    "13": exponential,
    "haze": haze,
    "ozone-axis": ozone_axis,
}


def main():
    usage = "figure FIGURE… [--draft | --fine] [--check] [--out FOLDER]"
    parser = argparse.ArgumentParser(prog="figure", usage=usage)
    parser.add_argument("binaries", type=Path)
    parser.add_argument("kept", type=Path)
    parser.add_argument("figures", nargs="+", choices=[*FIGURES, "all"], metavar="FIGURE")
    quality = parser.add_mutually_exclusive_group()
    quality.add_argument("--draft", action="store_true", help="small, with few walks")
    quality.add_argument("--fine", action="store_true", help="twice as large, with three times the walks")
    parser.add_argument("--check", action="store_true", help="fail where the physics does not hold")
    parser.add_argument("--out", type=Path, default=Path(__file__).resolve().parents[1], help="folder of the PNG")
    args = parser.parse_args()
    if not args.out.is_dir():
        parser.error(f"{args.out} is no folder")
    commands = Commands(args.binaries, args.kept)
    names = [*FIGURES] if "all" in args.figures else args.figures
    for name in names:
        make(name, commands, args)


def make(name, commands, args):
    start = core_seconds()
    quality = 0 if args.draft else 2 if args.fine else 1
    figure, facts = FIGURES[name].make(commands, lambda *qualities: qualities[quality])
    path = args.out / (f"figure-{int(name):02}.png" if name.isdigit() else f"{name}.png")
    panels.save(figure, path)
    print(f"{path.name}: {core_seconds() - start:.0f} core-seconds")
    print(json.dumps(facts, indent=2, ensure_ascii=False), flush=True)
    if args.check:
        looks_right(path)
        FIGURES[name].check(facts)


def core_seconds():
    """Of this process and of the commands that it ran."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def looks_right(path):
    """Whether a file holds a picture of some size that is not the same everywhere."""
    image = panels.plt.imread(path)
    assert image.shape[0] >= 150 and image.shape[1] >= 600, f"{path.name} is {image.shape[1]} x {image.shape[0]}"
    assert np.isfinite(image).all() and image[..., :3].std() > 0.1, f"{path.name} shows nothing"
    assert path.stat().st_size <= 400_000, f"{path.name} is larger than 400 kB"


try:
    main()
except AssertionError as error:
    sys.exit(f"error: {error}")
except (OSError, RuntimeError, subprocess.CalledProcessError) as error:
    # The command has said what is wrong, if it was one.
    print(f"error: {error}", file=sys.stderr)
    sys.exit(2)
