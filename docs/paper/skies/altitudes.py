"""Figure 8: in-scattered light from the ground to space, seen sideways."""

import numpy as np

from . import colour, panels, views
from .ask import GREEN, WAVELENGTHS, Air, Scene

ALTITUDES = [0.0, 3500.0, 7000.0, 15_000.0, 75_000.0]
SUN = 8.0


def make(commands, pick):
    view = views.sideways(pick(28, 76, 150))
    figure, axes = panels.sheet(3, len(ALTITUDES), (1.9, 1.9))
    panels.titles(axes, [f"{altitude / 1e3:g} km" for altitude in ALTITUDES])
    panels.row_labels(axes, ["traced", "model", "traced, polarised"])
    scenes = [Scene(np.radians(SUN), altitude) for altitude in ALTITUDES]
    lights = commands.trace(Air(), scenes, view.lines, WAVELENGTHS, pick(32, 64, 192))
    white, facts = None, {}
    for column, altitude, scene, light in zip(axes.T, ALTITUDES, scenes, lights):
        traced = view.picture(colour.linear_srgb(light.radiance, WAVELENGTHS))
        white = white or 3 * colour.geometric_mean(traced)
        panels.show(column[0], colour.develop(traced, white), view.seen)
        panels.show(column[2], overlay(view, traced, light, white), view.seen)
        below = view.directions[..., 2] < -0.5
        facts[f"luminance below, {altitude / 1e3:g} km"] = float(colour.luminance(traced[below]).mean())
        facts[f"luminance at the zenith, {altitude / 1e3:g} km"] = float(
            colour.luminance(traced[view.directions[..., 2] > 0.9]).mean()
        )
        answer = commands.model("relative_radiance", scene, view.lines, WAVELENGTHS)
        model = view.picture(colour.linear_srgb(answer, WAVELENGTHS))
        panels.show(column[1], colour.develop(model, white), view.seen)
        facts[f"light of model over traced, {altitude / 1e3:g} km"] = ratio(model, traced)
    facts["white, cd/m²"] = white
    return figure, facts


def ratio(model, traced):
    """Of the whole pictures."""
    return float(np.nansum(colour.luminance(model)) / np.nansum(colour.luminance(traced)))


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
    for altitude in ALTITUDES:
        light = facts[f"light of model over traced, {altitude / 1e3:g} km"]
        assert abs(light - 1) < 0.02, f"model over traced at {altitude} m: {light}"
