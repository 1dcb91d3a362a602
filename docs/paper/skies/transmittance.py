"""Figure 11: the transmittance between a camera at 8 km and towers, ground and space."""

import numpy as np

from . import colour, panels, towers, views
from .ask import GREEN, WAVELENGTHS, Air, Scene

SCENE = Scene(np.radians(20.0), altitude=8000.0)


def make(commands, pick):
    size = pick((48, 28), (160, 90), (340, 192))
    view = views.perspective(size, 0.0, np.radians(-6.0), np.radians(32.0))
    distance, pattern = towers.seen(view.lines, SCENE.altitude)
    exact = commands.trace(Air(), [SCENE], view.lines, WAVELENGTHS, 0, distance)[0].transmittance
    model = commands.model("transmittance", SCENE, view.lines, WAVELENGTHS, distance)
    figure, axes = panels.sheet(1, 3, (3.4, 3.4 * size[1] / size[0]), left=0.05)
    panels.titles(axes, ["tracer", "model", "model less tracer at 550 nm"])
    for axis, values in zip(axes[0], [exact, model]):
        rgb = colour.filter_colour(values, WAVELENGTHS) * pattern[:, None]
        panels.show(axis, colour.encode(view.picture(rgb)))
    apart = model - exact
    green = view.picture(apart[:, WAVELENGTHS.index(GREEN[0])])
    panels.scale_bar(figure, axes[0, 2], panels.show_signed(axes[0, 2], green, 2e-4), "")
    facts = {f"transmittance, absolute error, {name}": value for name, value in quantiles(np.abs(apart)).items()}
    far = np.isfinite(distance)
    facts["farthest thing seen, km"] = float(distance[far].max() / 1e3)
    facts["transmittance at 550 nm from … to"] = [
        float(end) for end in (exact[:, WAVELENGTHS.index(550)].min(), exact[:, WAVELENGTHS.index(550)].max())
    ]
    return figure, facts


def quantiles(values):
    numbers = np.quantile(values, [0.5, 0.95, 0.99, 1])
    return dict(zip(["median", "p95", "p99", "max"], map(float, numbers)))


def check(facts):
    assert facts["transmittance, absolute error, p99"] < 0.01, facts
    low, high = facts["transmittance at 550 nm from … to"]
    assert low < 0.3 and high > 0.8, "the scene does not reach from near to far"
