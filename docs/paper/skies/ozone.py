"""Figure 5: what ozone does to the colour of the sky."""

import numpy as np

from . import colour, panels, views
from .ask import WAVELENGTHS, Air, Scene

SUNS = [30.0, -3.0]
OZONE = {"none": 0.0, "hole, 100 DU": 100.0, "healthy, 345 DU": 345.0}
VISIBILITY = 131_800.0


def make(commands, pick):
    view = views.up(pick(32, 104, 200))
    figure, axes = panels.sheet(len(SUNS), len(OZONE), (2.3, 2.3))
    panels.titles(axes, OZONE)
    panels.row_labels(axes, [f"sun at {sun:g}°" for sun in SUNS])
    traced = {name: _traced(commands, view, dobson, pick(32, 160, 480)) for name, dobson in OZONE.items()}
    facts = {}
    for i, (row, sun) in enumerate(zip(axes, SUNS)):
        pictures = {name: traced[name][i] for name in OZONE}
        white = 2.5 * colour.geometric_mean(pictures["healthy, 345 DU"])
        facts[f"white of sun {sun:g}, cd/m²"] = white
        for axis, (name, picture) in zip(row, pictures.items()):
            whole = views.mirrored(picture)
            panels.show(axis, colour.develop(whole, white), np.isfinite(whole[..., 0]))
            facts[f"zenith, sun {sun:g}, {name}"] = zenith(view, picture)
    return figure, facts


def _traced(commands, view, dobson, walks):
    air = Air(VISIBILITY, ozone=dobson)
    scenes = [Scene(np.radians(sun), visibility=VISIBILITY) for sun in SUNS]
    lights = commands.trace(air, scenes, view.lines, WAVELENGTHS, walks)
    return [view.picture(colour.linear_srgb(light.radiance, WAVELENGTHS)) for light in lights]


def zenith(view, picture):
    """Luminance (cd/m²) and blue over red within 20° of the zenith."""
    near = view.directions[..., 2] > np.cos(np.radians(20))
    rgb = picture[near].mean(0)
    return {"luminance": float(colour.luminance(rgb)), "blue over red": float(rgb[2] / rgb[0])}


def check(facts):
    at = lambda sun, name: facts[f"zenith, sun {sun:g}, {name}"]  # noqa: E731
    names = list(OZONE)
    ratios = [at(-3, name)["blue over red"] for name in names]
    assert ratios[2] > 1.5 * ratios[0], f"ozone does not make twilight bluer: {ratios}"
    assert ratios[2] > ratios[1] > ratios[0], f"the hole is not between: {ratios}"
    light = [at(-3, name)["luminance"] for name in names]
    assert light[2] < 0.8 * light[0], f"ozone does not darken twilight: {light}"
    day = [at(30, name)["luminance"] for name in names]
    assert abs(day[2] / day[0] - 1) < 0.08, f"ozone matters by day: {day}"
