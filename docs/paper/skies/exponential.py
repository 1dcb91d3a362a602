"""Figure 13: haze in layers against haze that falls off exponentially."""

import numpy as np

from . import colour, panels, views
from .ask import WAVELENGTHS, Air, Scene

ALTITUDES = [0.0, 1000.0, 3000.0, 6000.0, 10_000.0]
SUN = 15.0
SIZE = (150, 56)
AZIMUTHS = np.radians([150.0, 30.0])
ELEVATIONS = np.radians([18.0, -27.0])


def make(commands, draft):
    size = (36, 14) if draft else SIZE
    view = views.strip(size, AZIMUTHS, ELEVATIONS)
    walks = 32 if draft else 96
    figure, axes = panels.sheet(len(ALTITUDES), 3, (3.1, 3.1 * SIZE[1] / SIZE[0]))
    panels.titles(axes, ["exponential, brute force", "layers, model", "layers, brute force"])
    panels.row_labels(axes, [f"{altitude / 1e3:g} km" for altitude in ALTITUDES])
    facts = {}
    for row, altitude in zip(axes, ALTITUDES):
        scene = Scene(np.radians(SUN), altitude)
        traced = [
            commands.trace(Air(aerosol_profile=profile), scene, view.lines, WAVELENGTHS, walks).radiance
            for profile in ("exponential", "smooth")
        ]
        model = commands.model("relative_radiance", scene, view.lines, WAVELENGTHS)
        pictures = [
            view.picture(colour.linear_srgb(values, WAVELENGTHS)) for values in (traced[0], model, traced[1])
        ]
        white = 2 * colour.geometric_mean(pictures[2])
        facts[f"white at {altitude / 1e3:g} km, cd/m²"] = white
        for axis, picture in zip(row, pictures):
            panels.show(axis, colour.develop(picture, white))
        apart = [luminances(view, p, pictures[2]) for p in pictures[:2]]
        facts[f"exponential against layers, mean difference of luminance, %, {altitude / 1e3:g} km"] = apart[0]
        facts[f"model against layers, mean difference of luminance, %, {altitude / 1e3:g} km"] = apart[1]
    return figure, facts


def luminances(view, picture, reference):
    """Mean relative difference, signs dropped, where the reference has light; the black ground near by has little."""
    a, b = colour.luminance(picture), colour.luminance(reference)
    lit = b > 0.02 * np.median(b)
    return float(100 * np.mean(np.abs(a[lit] / b[lit] - 1)))


def check(facts):
    def apart(which, altitude):
        return facts[f"{which} against layers, mean difference of luminance, %, {altitude / 1e3:g} km"]

    high = [apart("exponential", altitude) for altitude in ALTITUDES[2:]]
    assert max(high) > 1.5 * apart("exponential", 0.0), f"exponential and layered air agree high up: {high}"
    for altitude in ALTITUDES:
        assert apart("model", altitude) < 4, f"the model is {apart('model', altitude)} % off at {altitude} m"
