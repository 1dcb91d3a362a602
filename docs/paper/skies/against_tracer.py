"""Figure 12: brute force against the model, radiance and sun-aligned Q."""

import numpy as np

from . import colour, panels, stokes, views
from .ask import GREEN, WAVELENGTHS, Air, Scene
from .transmittance import quantiles

SCENE = Scene(np.radians(18.64), altitude=2495.0)


def make(commands, pick):
    view = views.sideways(pick(32, 96, 160))
    lines, at = view.lines, WAVELENGTHS.index(GREEN[0])
    walks = pick(64, 512, 1536)
    light = commands.trace(Air(), [SCENE], lines, WAVELENGTHS, walks)[0]
    model = commands.model("relative_radiance", SCENE, lines, WAVELENGTHS)
    model_q = commands.model("polarisation", SCENE, lines, GREEN)[:, 0]
    radiance = light.radiance[:, at]
    q, u = stokes.aligned(light.q[:, at], light.u[:, at], lines, SCENE.sun_elevation)
    figure, axes = panels.sheet(2, 3, (2.4, 2.4))
    panels.titles(axes, ["brute force", "model", "difference, 5 × 5 pixels"])
    panels.row_labels(axes, ["radiance", "sun-aligned Q, 550 nm"])
    pictures = [view.picture(colour.linear_srgb(values, WAVELENGTHS)) for values in (light.radiance, model)]
    white = 2.5 * colour.geometric_mean(pictures[0])
    for axis, picture in zip(axes[0], pictures):
        panels.show(axis, colour.develop(picture, white), view.seen)
    apart = averaged(colour.luminance(pictures[1])) / averaged(colour.luminance(pictures[0])) - 1
    panels.scale_bar(figure, axes[0, 2], panels.show_signed(axes[0, 2], 100 * apart, 2), "% of luminance")
    # Black ground right below has no light to have a share of.
    lit = radiance > 0.01 * np.median(radiance)
    degrees = [np.where(lit, q / radiance, np.nan), np.where(lit, model_q, np.nan)]
    for axis, degree in zip(axes[1], degrees):
        panels.scale_bar(figure, axis, panels.show_signed(axis, view.picture(degree), 0.8), "Q/I")
    differ = averaged(view.picture(degrees[1] - degrees[0]))
    panels.scale_bar(figure, axes[1, 2], panels.show_signed(axes[1, 2], differ, 0.02), "Q/I")
    facts = {"white, cd/m²": white, "walks per line of sight": walks}
    facts["luminance, 5 × 5 pixels, %, p95"] = 100 * float(np.nanquantile(np.abs(apart), 0.95))
    facts["Q/I, 5 × 5 pixels, p95"] = float(np.nanquantile(np.abs(differ), 0.95))
    facts |= errors(light, model, at, lit, degrees)
    facts["rms of the neglected U/I"] = float(np.sqrt(np.mean((u / radiance)[lit] ** 2)))
    return figure, facts


def averaged(picture, pixels=5):
    """Means over squares of pixels, where one sees something: less of the tracer's noise."""
    reach = pixels // 2
    around = np.pad(picture, reach, constant_values=np.nan)
    shifted = [
        around[i : i + picture.shape[0], j : j + picture.shape[1]] for i in range(pixels) for j in range(pixels)
    ]
    there = np.isfinite(shifted)
    mean = np.where(there, shifted, 0).sum(0) / np.maximum(there.sum(0), 1)
    return np.where(np.isfinite(picture), mean, np.nan)


def errors(light, model, at, lit, degrees):
    """Of all pixels: the tracer's noise is in them, and stated."""
    relative = np.abs(model[lit] / light.radiance[lit] - 1)
    noise = light.error[lit] / light.radiance[lit]
    facts = {f"radiance, all wavelengths, %, {name}": 100 * value for name, value in quantiles(relative).items()}
    facts |= {f"standard error of the tracer, %, {name}": 100 * value for name, value in quantiles(noise).items()}
    facts["radiance at 550 nm, mean of model over traced less 1, %"] = 100 * float(
        np.mean(model[lit, at]) / np.mean(light.radiance[lit, at]) - 1
    )
    apart = np.abs(degrees[1] - degrees[0])[lit]
    return facts | {f"Q/I, absolute, {name}": value for name, value in quantiles(apart).items()}


def check(facts):
    noise = facts["standard error of the tracer, %, p95"]
    apart = facts["radiance, all wavelengths, %, p95"]
    assert apart < 2 * noise + 1.5, f"radiance {apart} % off, noise {noise} %"
    assert abs(facts["radiance at 550 nm, mean of model over traced less 1, %"]) < 1, facts
    assert facts["luminance, 5 × 5 pixels, %, p95"] < 1 + 0.7 * noise, facts
    assert facts["Q/I, 5 × 5 pixels, p95"] < 0.02, facts
