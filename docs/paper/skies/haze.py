"""Haze lifted by a polarising filter: the landscape of the gallery."""

import shutil
import subprocess
from pathlib import Path

import numpy as np

from . import panels

SCRIPT = Path(__file__).resolve().parents[1] / "haze"
NAMES = {"passes": "the filter passes the haze", "lifts": "turned by 90°"}


def make(commands, pick):
    folder = commands.kept / "haze"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    subprocess.run(["bash", str(SCRIPT), str(commands.welkin), str(folder), str(pick(48, 160, 360))], check=True)
    pictures = [panels.plt.imread(folder / f"polariser-{name}.png")[..., :3] for name in NAMES]
    height, width = pictures[0].shape[:2]
    figure, axes = panels.sheet(1, 2, (4.6, 4.6 * height / width), left=0.05)
    panels.titles(axes, NAMES.values())
    facts = {}
    for axis, (name, picture) in zip(axes[0], zip(NAMES, pictures)):
        panels.show(axis, picture)
        ridge = picture[height // 3 : 2 * height // 3].mean(-1)
        facts[f"contrast of the middle third, {name}"] = float(np.std(ridge) / np.mean(ridge))
    return figure, facts


def check(facts):
    passes, lifts = (facts[f"contrast of the middle third, {name}"] for name in NAMES)
    assert lifts > 1.1 * passes, f"the filter does not lift the haze: contrast {passes} and {lifts}"
