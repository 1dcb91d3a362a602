"""Figure 9: the sky while the sun sinks from 0 to -6 degrees."""

import numpy as np

from . import colour, panels, views
from .ask import WAVELENGTHS, Scene

SUNS = range(0, -7, -1)
# Where the shadow of the Earth rises.
OPPOSITE = (np.radians([230.0, 130.0]), np.radians([30.0, 0.0]))


def make(commands, pick):
    view = views.up(pick(32, 160, 160))
    opposite = views.strip(pick((16, 20), (80, 60), (80, 60)), *OPPOSITE)
    figure, axes = panels.sheet(3, len(SUNS), (1.6, 1.6))
    panels.titles(axes, [f"{sun}°" for sun in SUNS])
    panels.row_labels(axes, ["each for itself", "exposed as at 0°", "opposite the sun"])
    first, facts = None, {}
    for column, sun in zip(axes.T, SUNS):
        scene = Scene(np.radians(float(sun)))

        def light(view, scene=scene):
            answer = commands.model("relative_radiance", scene, view.lines, WAVELENGTHS)
            return view.picture(colour.linear_srgb(answer, WAVELENGTHS))

        picture, low = views.mirrored(light(view)), light(opposite)
        own = 5 * colour.geometric_mean(picture)
        first = first or own
        for axis, white in zip(column, [own, first]):
            panels.show(axis, colour.develop(picture, white), np.isfinite(picture[..., 0]))
        panels.show(column[2], colour.develop(low, 2 * colour.geometric_mean(low)))
        facts[f"white of sun {sun}, cd/m²"] = own
        facts[f"elevation of the arch over sun {sun}, degrees"] = arch(opposite, low)
    return figure, facts


def arch(view, picture):
    """Elevation of the brightest light opposite the sun: above the shadow of the Earth."""
    middle = picture.shape[1] // 2
    light = colour.luminance(picture[:, middle])
    return float(np.degrees(np.arcsin(view.directions[np.argmax(light), middle, 2])))


def check(facts):
    whites = [facts[f"white of sun {sun}, cd/m²"] for sun in SUNS]
    assert all(a > 1.5 * b for a, b in zip(whites, whites[1:])), f"it does not get dark: {whites}"
    rise = [facts[f"elevation of the arch over sun {sun}, degrees"] for sun in SUNS]
    assert rise[0] < rise[2] < rise[3], f"the shadow of the Earth does not rise: {rise}"
