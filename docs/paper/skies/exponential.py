"""Figure 13: haze in layers against haze that falls off exponentially."""

import numpy as np

from . import colour, panels, views
from .ask import WAVELENGTHS, Air, Scene

VISIBILITY = 20_000.0
ALTITUDES = [0.0, 1000.0, 2500.0, 5000.0, 10_000.0]
SUN = 15.0
AZIMUTHS = np.radians([150.0, 30.0])
ELEVATIONS = np.radians([18.0, -27.0])


def make(commands, pick):
    size = pick((24, 24), (72, 30), (160, 66))
    view = views.strip(size, AZIMUTHS, ELEVATIONS)
    walks = pick(32, 64, 192)
    figure, axes = panels.sheet(len(ALTITUDES), 3, (3.0, 1.25))
    panels.titles(axes, ["exponential, brute force", "layers, model", "layers, brute force"])
    panels.row_labels(axes, [f"{altitude / 1e3:g} km" for altitude in ALTITUDES])
    scenes = [Scene(np.radians(SUN), altitude, VISIBILITY) for altitude in ALTITUDES]
    traced = [
        commands.trace(Air(VISIBILITY, aerosol_profile=profile), scenes, view.lines, WAVELENGTHS, walks)
        for profile in ("exponential", "smooth")
    ]
    facts = {}
    for row, altitude, scene, exponential, layers in zip(axes, ALTITUDES, scenes, *traced):
        model = commands.model("relative_radiance", scene, view.lines, WAVELENGTHS)
        columns = (exponential.radiance, model, layers.radiance)
        pictures = [view.picture(colour.linear_srgb(values, WAVELENGTHS)) for values in columns]
        white = 2 * colour.geometric_mean(pictures[2])
        facts[f"white at {altitude / 1e3:g} km, cd/m²"] = white
        for axis, picture in zip(row, pictures):
            panels.show(axis, colour.develop(picture, white))
        apart = [difference(picture, pictures[2]) for picture in pictures[:2]]
        facts[f"exponential against layers, luminance of rows, mean difference, %, {altitude / 1e3:g} km"] = apart[0]
        facts[f"model against layers, luminance of rows, mean difference, %, {altitude / 1e3:g} km"] = apart[1]
    return figure, facts


def difference(picture, reference):
    """Mean relative difference of rows, signs dropped; the black ground near by has no light to have a share of."""
    a, b = (colour.luminance(p).mean(1) for p in (picture, reference))
    lit = b > 0.02 * np.median(b)
    return float(100 * np.mean(np.abs(a[lit] / b[lit] - 1)))


def check(facts):
    def apart(which, altitude):
        return facts[f"{which} against layers, luminance of rows, mean difference, %, {altitude / 1e3:g} km"]

    high = [apart("exponential", altitude) for altitude in ALTITUDES[2:]]
    assert max(high) > 1.5 * apart("exponential", 0.0), f"exponential and layered air agree high up: {high}"
    for altitude in ALTITUDES:
        assert apart("model", altitude) < 4, f"the model is {apart('model', altitude)} % off at {altitude} m"
