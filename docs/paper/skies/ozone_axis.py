"""Figure 5 again, by a model whose axis is the column of ozone, beside the tracer."""

import numpy as np

from . import colour, panels, views
from .ask import WAVELENGTHS, Air, Scene
from .ozone import SUNS, zenith
from .transmittance import quantiles

RECIPE = "continental-clean"
# Between nodes and at one.
OZONE = [100.0, 345.0, 450.0]
NODES = "ozone=100,200,300,400,500"


def make(commands, pick):
    view = views.up(pick(24, 80, 160))
    grid = ["--altitudes", "0", "--elevations", "-6..30", "--quality", pick("draft", "draft", "good")]
    model = commands.make(RECIPE, "--axis", NODES, *grid)
    names = [f"{how}, {dobson:g} DU" for dobson in OZONE for how in ("traced", "model")]
    figure, axes = panels.sheet(len(SUNS), len(names), (1.6, 1.6))
    panels.titles(axes, names)
    panels.row_labels(axes, [f"sun at {sun:g}°" for sun in SUNS])
    facts = {"bytes": model.stat().st_size}
    for i, sun in enumerate(SUNS):
        pairs = [_pair(commands, model, view, dobson, np.radians(sun), pick(32, 160, 480)) for dobson in OZONE]
        white = 2.5 * colour.geometric_mean(view.picture(pairs[1][0]))
        for j, (dobson, pair) in enumerate(zip(OZONE, pairs)):
            for k, (how, rgb) in enumerate(zip(("traced", "model"), pair)):
                picture = view.picture(rgb)
                whole = views.mirrored(picture)
                panels.show(axes[i, 2 * j + k], colour.develop(whole, white), np.isfinite(whole[..., 0]))
                facts[f"zenith, sun {sun:g}, {dobson:g} DU, {how}"] = zenith(view, picture)
            apart = np.abs(pair[1] / pair[0] - 1)[np.all(pair[0] > 0, axis=1)]
            name = f"linear sRGB, sun {sun:g}, {dobson:g} DU, model over traced, %"
            facts |= {f"{name}, {q}": 100 * value for q, value in quantiles(apart).items()}
    return figure, facts


def _pair(commands, model, view, dobson, sun, walks):
    """Linear sRGB of the lines of sight: traced, and of the model."""
    scene = Scene(sun)
    air = Air(ozone=dobson, recipe=RECIPE)
    light = commands.trace(air, [scene], view.lines, WAVELENGTHS, walks)[0].radiance
    options = ["--model", str(model), "--parameter", repr(dobson)]
    asked = commands.model("relative_radiance", scene, view.lines, WAVELENGTHS, options=options)
    return [colour.linear_srgb(values, WAVELENGTHS) for values in (light, asked)]


def check(facts):
    at = lambda sun, dobson, how: facts[f"zenith, sun {sun:g}, {dobson:g} DU, {how}"]  # noqa: E731
    for sun in SUNS:
        for dobson in OZONE:
            traced, model = (at(sun, dobson, how)["luminance"] for how in ("traced", "model"))
            # Drafts of both: 3 % apart.
            assert abs(model / traced - 1) < 0.05, f"sun {sun:g}, {dobson:g} DU: {model} is not {traced}"
    for how in ("traced", "model"):
        ratios = [at(-3, dobson, how)["blue over red"] for dobson in OZONE]
        assert ratios[0] < ratios[1] < ratios[2], f"{how}: more ozone does not make twilight bluer: {ratios}"
