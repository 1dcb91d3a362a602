"""Figure 8: in-scattered light from the ground to space, seen sideways."""

import numpy as np

from . import colour, panels, views
from .ask import GREEN, WAVELENGTHS, Air, Scene

ALTITUDES = [0.0, 3500.0, 7000.0, 15_000.0, 75_000.0]
HIGHEST_OF_MODEL = 15_000.0
SUN = 8.0


def make(commands, draft):
    view = views.sideways(32 if draft else 124)
    figure, axes = panels.sheet(3, len(ALTITUDES), (1.9, 1.9))
    panels.titles(axes, [f"{altitude / 1e3:g} km" for altitude in ALTITUDES])
    panels.row_labels(axes, ["traced", "model", "traced, polarised"])
    white, facts = None, {}
    for column, altitude in zip(axes.T, ALTITUDES):
        scene = Scene(np.radians(SUN), altitude)
        light = commands.trace(Air(), scene, view.lines, WAVELENGTHS, 32 if draft else 96)
        traced = view.picture(colour.linear_srgb(light.radiance, WAVELENGTHS))
        white = white or 3 * colour.geometric_mean(traced)
        panels.show(column[0], colour.develop(traced, white), view.seen)
        panels.show(column[2], overlay(view, traced, light, white), view.seen)
        below = view.directions[..., 2] < -0.5
        facts[f"luminance below, {altitude / 1e3:g} km"] = float(colour.luminance(traced[below]).mean())
        facts[f"luminance at the zenith, {altitude / 1e3:g} km"] = float(
            colour.luminance(traced[view.directions[..., 2] > 0.9]).mean()
        )
        if altitude > HIGHEST_OF_MODEL:
            place = {"ha": "center", "va": "center", "fontsize": 8, "color": "grey"}
            column[1].text(0.5, 0.5, "above the\nmodel's 15 km", transform=column[1].transAxes, **place)
            continue
        answer = commands.model("relative_radiance", scene, view.lines, WAVELENGTHS)
        model = view.picture(colour.linear_srgb(answer, WAVELENGTHS))
        panels.show(column[1], colour.develop(model, white), view.seen)
        apart = colour.luminance(model[view.seen]) / colour.luminance(traced[view.seen]) - 1
        facts[f"model less traced, median, {altitude / 1e3:g} km"] = float(np.median(apart))
    facts["white, cd/m²"] = white
    return figure, facts


def overlay(view, picture, light, white):
    """Grey for the luminance, the redder the higher the degree of polarisation at 550 nm."""
    at = WAVELENGTHS.index(GREEN[0])
    degree = np.hypot(light.q[:, at], light.u[:, at]) / np.maximum(light.radiance[:, at], 1e-30)
    share = np.nan_to_num(view.picture(np.minimum(degree, 1)))[..., None]
    grey = colour.develop(np.repeat(colour.luminance(picture)[..., None], 3, -1), white)
    return (1 - share) * grey + share * np.array([0.85, 0.05, 0.05])


def check(facts):
    below = [facts[f"luminance below, {altitude / 1e3:g} km"] for altitude in ALTITUDES]
    assert below[0] < 0.05 * below[-1], f"the nearest ground is not black: {below}"
    zenith = [facts[f"luminance at the zenith, {altitude / 1e3:g} km"] for altitude in ALTITUDES]
    assert all(a > b for a, b in zip(zenith, zenith[1:])), f"the sky does not darken with altitude: {zenith}"
    for name, apart in facts.items():
        assert not name.startswith("model less traced") or abs(apart) < 0.02, f"{name}: {apart}"
