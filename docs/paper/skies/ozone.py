"""Figure 5: what ozone does to the colour of the sky."""

import numpy as np

from . import colour, panels, views
from .ask import WAVELENGTHS, Air, Scene

SUNS = [30.0, -3.0]
OZONE = {"none": 0.0, "hole, 100 DU": 100.0, "healthy, 345 DU": 345.0}
# Many walks in twilight, where most of what arrives was scattered more than once.
WALKS = {30.0: 96, -3.0: 320}
VISIBILITY = 131_800.0


def make(commands, draft):
    view = views.up(40 if draft else 150)
    figure, axes = panels.sheet(len(SUNS), len(OZONE), (2.6, 2.6))
    panels.titles(axes, OZONE)
    panels.row_labels(axes, [f"sun at {sun:g}°" for sun in SUNS])
    facts = {}
    for row, sun in zip(axes, SUNS):
        walks = 32 if draft else WALKS[sun]
        pictures = {name: _traced(commands, view, sun, dobson, walks) for name, dobson in OZONE.items()}
        white = 2.5 * colour.geometric_mean(pictures["healthy, 345 DU"])
        facts[f"white of sun {sun:g}, cd/m²"] = white
        for axis, (name, picture) in zip(row, pictures.items()):
            whole = views.mirrored(picture)
            panels.show(axis, colour.develop(whole, white), np.isfinite(whole[..., 0]))
            facts[f"zenith, sun {sun:g}, {name}"] = zenith(view, picture)
    return figure, facts


def _traced(commands, view, sun, dobson, walks):
    air = Air(VISIBILITY, ozone=dobson)
    scene = Scene(np.radians(sun), visibility=VISIBILITY)
    light = commands.trace(air, scene, view.lines, WAVELENGTHS, walks)
    return view.picture(colour.linear_srgb(light.radiance, WAVELENGTHS))


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
