"""Fig. 14: towers on a planet seen from 8 km, path-traced through the air beside the model, and the difference.

The path-traced pictures take minutes of a core for each pass; what is done is kept in --work and not done again.
"""

import os

import numpy as np

import options
import towers
from development import display, diverging, labelled, luminance, save, sheet, white_of
from path_traced import traced
from rendering import camera, rendered_over_places, seen_points

ELEVATIONS = (20.0, 2.0, -1.0)
VIEW = {"altitude": 8000.0, "pitch": -3.0, "field_of_view": 36.0, "solar_azimuth": 165.0, "visibility": 59.4e3}
# Of the mean ground, to which the model's light belongs.
ALBEDO = 0.28
# Width and height, how many pixels on a side are averaged before they are compared, walks in a pass.
FULL, DRAFT = ((1500, 1000), 5, 8), ((150, 100), 2, 8)
ALTITUDES, AHEAD = (0.0, 4e3, 15e3), (0.0, 330e3)
# Mitsuba's light in cd m⁻²: 683 lm/W times the integral of its luminous efficiency.
LUMENS = 683.002 * 106.7502593994140625
WORST = 0.3


def description(size):
    altitude, pitch = VIEW["altitude"], np.radians(VIEW["pitch"])
    target = [1000.0, 0.0, altitude + 1000.0 * float(np.tan(pitch))]
    return {
        "type": "scene", "integrator": {"type": "welkin_path", "max_depth": 4},
        "sensor": camera([0.0, 0.0, altitude], target, VIEW["field_of_view"], size), **towers.meshes(),
    }


def modelled(elevation, size, samples, places):
    """Linear sRGB, cd m⁻²."""
    conditions = {"solar_elevation": elevation, "albedo": ALBEDO}
    conditions |= {name: VIEW[name] for name in ("solar_azimuth", "visibility")}
    lit = {**description(size), "sun": {"type": "placed_sun", **conditions}}
    sky = {**conditions, "sun_scale": 0.0}
    return LUMENS * rendered_over_places(lit, sky, *places, samples, f"{elevation:g} degrees")


def averaged(values, n):
    """Means of blocks of n × n pixels."""
    height, width = values.shape[0] // n, values.shape[1] // n
    return values[: n * height, : n * width].reshape(height, n, width, n, *values.shape[2:]).mean((1, 3))


def compared(model, truth, error, is_solid):
    """Lines that say how far luminances are apart where there is sky and where there are things."""
    relative, noise = luminance(model) / luminance(truth) - 1.0, error / luminance(truth)
    for name, where in (("sky", ~is_solid), ("things", is_solid)):
        median, p95 = np.quantile(np.abs(relative[where]), (0.5, 0.95))
        mean = luminance(model)[where].mean() / luminance(truth)[where].mean() - 1.0
        yield (f"  {name}: means {mean:+.2%} apart; block by block {median:.1%} / {p95:.1%} (median / p95), "
               f"of which noise of the path-traced {np.median(noise[where]):.1%} (median standard error)")


def main():
    more = lambda parser: (
        parser.add_argument("--passes", type=int, help="passes of 8 walks per pixel; 1 by default"),
        parser.add_argument("--samples", type=int, help="per pixel and lighting; 4 by default, 2 in drafts"),
        parser.add_argument("--work", default="work", help="folder of finished passes"),
        parser.add_argument("--full", help="folder that also gets the pictures in all their pixels"))
    arguments = options.parse(__doc__, "llvm_ad_spectral", more)
    draft = arguments.draft
    size, block, walks = DRAFT if draft else FULL
    places = ((0.0, 15e3), (0.0, 330e3)) if draft else (ALTITUDES, AHEAD)
    passes, samples = arguments.passes or 1, arguments.samples or (2 if draft else 4)
    solid = averaged(seen_points(description(size))[1].astype(float), block)
    arrays = {}
    for elevation in ELEVATIONS:
        truth, error = traced(VIEW, elevation, size, walks, passes, arguments.work)
        model = modelled(elevation, size, samples, places)
        pair = averaged(truth, block), averaged(model, block)
        # Pixels are independent of each other.
        error = np.sqrt(averaged(error**2, block)) / block
        white = white_of(pair[1], 0.97)
        relative = luminance(pair[1]) / np.maximum(luminance(pair[0]), 1e-4 * white) - 1.0
        name = f"figure_14_{elevation:g}".replace("-", "minus_")
        row = [
            labelled(display(pair[0], white), f"path-traced, {passes * walks * block**2} walks"),
            labelled(display(pair[1], white), f"model, sun at {elevation:g}°"),
            labelled(diverging(relative, WORST), f"model over path-traced: blue -{WORST:.0%}, red +{WORST:.0%}"),
        ]
        save(arguments.out, f"{name}.png", sheet([row]))
        print(f"  display white: {white:.3g} cd/m²")
        # A block is of things or of sky where it is nothing else.
        keep = (solid == 0.0) | (solid == 1.0)
        print("\n".join(compared(pair[1][keep], pair[0][keep], error[keep], solid[keep] == 1.0)))
        if arguments.full:
            save(arguments.full, f"{name}_path_traced.png", display(truth, white))
            save(arguments.full, f"{name}_model.png", display(model, white))
        arrays |= {f"truth_{elevation:g}": pair[0], f"model_{elevation:g}": pair[1], f"error_{elevation:g}": error}
    if arguments.arrays:
        np.savez(os.path.join(arguments.arrays, "figure_14.npz"), solid=solid, **arrays)


if __name__ == "__main__":
    main()
