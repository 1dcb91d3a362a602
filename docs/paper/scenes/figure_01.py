"""Fig. 1: mountains from 4.8 km under a low and a higher sun, and a city before and after sunset."""

import os

import numpy as np

import options
from development import display, save, white_of

SIZE, DRAFT = (640, 360), (192, 108)
# Name, solar elevation (degrees), its azimuth from the view's middle to the left, visibility (m).
MOUNTAINS = [("mountains_2", 2.0, 65.0, 30e3), ("mountains_15", 15.0, 65.0, 60e3)]
CITY = [("city_before", 9.0, 62.0, 60e3), ("city_after", -3.0, 48.0, 60e3)]


def mountains(size, samples, draft):
    import mountains as scene
    from rendering import rendered_over_places

    description = scene.description(4800.0, -5.0, 26.0, size, draft)
    places = scene.DRAFT_PLACES if draft else scene.PLACES
    for name, elevation, azimuth, visibility in MOUNTAINS:
        sky, sun = scene.light(elevation, azimuth, visibility)
        lit = {**description, "sun": sun}
        yield name, rendered_over_places(lit, sky, *places, samples, name)


def city(size, samples, draft):
    import city as scene
    from rendering import camera, rendered_over_places

    description = {
        "type": "scene", "integrator": {"type": "welkin_path", "max_depth": 4},
        "sensor": camera([0.0, 0.0, 230.0], [1000.0, 0.0, 195.0], 25.0, size), **scene.meshes(draft),
    }
    for name, elevation, azimuth, visibility in CITY:
        sky = {"visibility": visibility, "solar_elevation": elevation, "solar_azimuth": azimuth, "albedo": 0.15}
        lit = {**description, "sun": {"type": "placed_sun", "reach": 130e3, **sky}}
        # All that is lit here is low and near.
        yield name, rendered_over_places(lit, {**sky, "sun_scale": 0.0}, (30.0,), (0.0,), samples, name)


def main():
    arguments = options.parse(__doc__, "llvm_ad_spectral")
    draft = arguments.draft
    size = DRAFT if draft else SIZE
    pictures = dict(mountains(size, 2 if draft else 24, draft))
    pictures |= dict(city(size, 4 if draft else 64, draft))
    for name, picture in pictures.items():
        white = white_of(picture, 0.985)
        save(arguments.out, f"figure_01_{name}.png", display(picture, white))
        print(f"  display white: {white:.3g}")
    if arguments.arrays:
        np.savez(os.path.join(arguments.arrays, "figure_01.npz"), **pictures)


if __name__ == "__main__":
    main()
