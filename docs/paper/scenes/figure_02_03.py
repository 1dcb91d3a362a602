"""Figs. 2 and 3: mountains from 8 km near sunset; what is lost without in-scattering, attenuation and altitude."""

import os

import numpy as np

import mountains
import options
from development import display, labelled, luminance, save, white_of
from rendering import rendered, rendered_over_places

ALTITUDE, ELEVATION, AZIMUTH, VISIBILITY = 8000.0, 3.0, 65.0, 60e3
SIZE, DRAFT = (640, 360), (192, 108)
NAMES = {
    "full": "full", "no_in_scattering": "without in-scattering", "no_air": "without in-scattering and attenuation",
    "no_altitude": "a sky of the ground, and no air",
}


def pictures(size, samples, draft):
    import mitsuba as mi

    description = mountains.description(ALTITUDE, -7.0, 28.0, size, draft)
    sky, sun = mountains.light(ELEVATION, AZIMUTH, VISIBILITY)
    lit = {**description, "sun": sun}
    places = (*(mountains.DRAFT_PLACES if draft else mountains.PLACES), samples)
    air = lambda attenuation: {"type": "partial_air", "max_depth": 3, "attenuation": attenuation}
    yield "full", rendered_over_places(lit, sky, *places, "full")
    for name, attenuation in (("no_in_scattering", True), ("no_air", False)):
        yield name, rendered_over_places({**lit, "integrator": air(attenuation)}, sky, *places, name)
    # Sky and sun as on the ground, everywhere.
    ground = {**sky, "type": "ground_level_sky", "sun_scale": 1.0, "altitude": 0.0}
    scene = mi.load_dict({**description, "integrator": {"type": "path", "max_depth": 3}, "sky": ground})
    yield "no_altitude", rendered(scene, 4 * samples, 9, "no_altitude")


def main():
    arguments = options.parse(__doc__, "llvm_ad_spectral")
    made = dict(pictures(DRAFT if arguments.draft else SIZE, 2 if arguments.draft else 24, arguments.draft))
    white = white_of(made["full"], 0.985)
    for name, picture in made.items():
        save(arguments.out, f"figure_03_{name}.png", labelled(display(picture, white), NAMES[name]))
        print(f"  mean luminance: {luminance(picture).mean() / luminance(made['full']).mean():.3f} of the full picture")
    if arguments.arrays:
        np.savez(os.path.join(arguments.arrays, "figure_03.npz"), **made)


if __name__ == "__main__":
    main()
