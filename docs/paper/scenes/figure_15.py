"""Fig. 15: glass fronts and water under a sky that is polarised and the same sky that is not; through a filter."""

import os

import mitsuba as mi
import numpy as np

import facade
import options
from development import display, diverging, labelled, luminance, ramp, save, white_of
from rendering import camera, rendered

ELEVATION, AZIMUTH, VISIBILITY = 24.0, 118.0, 80e3
SIZE, DRAFT = (560, 420), (160, 120)
WORST = 0.15


def scene(sky, size, draft):
    conditions = {"solar_elevation": ELEVATION, "solar_azimuth": AZIMUTH, "visibility": VISIBILITY, "albedo": 0.25}
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "stokes", "nested": {"type": "path", "max_depth": 10}},
        "sensor": camera([-92.0, -5.0, 3.0], [60.0, 2.0, 27.0], 48.0, size),
        **facade.meshes(0.4 if draft else 1.0),
        "sky": {"type": sky, "sun_scale": 0.0, **conditions},
        # The disc itself, mirrored onto paving, is not what a path tracer finds.
        "sun": {"type": "placed_sun", "reach": 10e3, **conditions},
    })


def stokes(sky, size, samples, draft):
    """(height, width, 4, 3): Stokes vectors of linear sRGB, Q along the picture's width."""
    picture = rendered(scene(sky, size, draft), samples, label=sky)
    return picture[..., -12:].reshape(*picture.shape[:2], 4, 3)


def through_filter(light, turn):
    """What passes a filter at `turn` (rad) from the picture's width; twice, so that what is unpolarised stays."""
    return light[..., 0, :] + np.cos(2.0 * turn) * light[..., 1, :] + np.sin(2.0 * turn) * light[..., 2, :]


def degree(light):
    i, q, u = (luminance(light[..., k, :]) for k in range(3))
    return np.hypot(q, u) / np.maximum(i, 1e-9)


def relative_difference(light, other, white):
    """Of luminance; where hardly anything is to be seen, in hundredths of display white instead."""
    return (luminance(light) - luminance(other)) / np.maximum(luminance(other), 0.01 * white)


def draw(polarised, plain, folder):
    with_it, without = polarised[..., 0, :], plain[..., 0, :]
    white = white_of(without, 0.96)
    relative = relative_difference(with_it, without, white)
    pictures = {
        "polarising": (display(with_it, white), "polarised sky"),
        "plain": (display(without, white), "the same, unpolarised"),
        "difference": (diverging(relative, WORST), f"polarised over unpolarised: blue -{WORST:.0%}, red +{WORST:.0%}"),
        "degree": (ramp(degree(polarised)), "degree of linear polarisation, 0 to 1"),
        "filter_across": (display(through_filter(polarised, 0.0), white), "filter passes horizontal vibrations"),
        "filter_upright": (display(through_filter(polarised, 0.5 * np.pi), white), "filter passes vertical vibrations"),
    }
    for name, (picture, text) in pictures.items():
        save(folder, f"figure_15_{name}.png", labelled(picture, text))
    shares = [f"{s:.0%} of pixels below {np.quantile(relative, s):+.1%}" for s in (0.01, 0.05, 0.5, 0.95, 0.99)]
    print("  polarised over unpolarised: " + ", ".join(shares))


def main():
    arguments = options.parse(__doc__, "llvm_ad_spectral_polarized")
    size, samples = (DRAFT, 16) if arguments.draft else (SIZE, 96)
    polarised, plain = (stokes(sky, size, samples, arguments.draft) for sky in ("welkin", "unpolarised_sky"))
    draw(polarised, plain, arguments.out)
    if arguments.arrays:
        np.savez(os.path.join(arguments.arrays, "figure_15.npz"), polarised=polarised, plain=plain)


if __name__ == "__main__":
    main()
