"""Scenes to arrays."""

import sys

import mitsuba as mi
import numpy as np

from places import weights
from planet import height_of

# Samples that are drawn at once: what fits into 2 GB in spectral variants with polarisation.
AT_ONCE = 6_000_000


def camera(origin, target, field_of_view, size):
    """A pinhole of `field_of_view` degrees over the height of pictures of `size` (width, height)."""
    film = {"type": "hdrfilm", "width": size[0], "height": size[1], "rfilter": {"type": "box"}}
    to_world = mi.ScalarTransform4f().look_at(origin, target, [0, 0, 1])
    lens = {"fov": field_of_view, "fov_axis": "y", "near_clip": 0.5, "far_clip": 2e6}
    return {"type": "perspective", "to_world": to_world, "film": film, **lens}


def rendered(scene, samples, seed=0, label=""):
    """(height, width, channels): the mean of `samples` per pixel, drawn a few million at a time."""
    width, height = scene.sensors()[0].film().size()
    step = max(1, min(samples, AT_ONCE // (width * height)))
    passes = -(-samples // step)
    total = 0.0
    for k in range(passes):
        total = total + np.array(mi.render(scene, spp=step, seed=1000 * seed + k), np.float64)
        if sys.stderr.isatty():
            print(f"\r{label} {k + 1}/{passes} ", end="", file=sys.stderr, flush=True)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    picture = (total / passes).astype(np.float32)
    if not np.isfinite(picture).all():
        raise ValueError(f"{label}: {np.count_nonzero(~np.isfinite(picture))} values are not finite")
    return picture


def seen_points(description):
    """What is seen at a place in each pixel: points (height, width, 3), and whether there is anything."""
    scene = mi.load_dict({**description, "integrator": {"type": "aov", "aovs": "p:position,t:depth"}})
    picture = np.array(mi.render(scene, spp=1, seed=0), np.float64)
    return picture[..., -4:-1], picture[..., -1] > 0.0


def rendered_over_places(description, sky, altitudes, ahead, samples, label=""):
    """A scene lit as each point of it is: linear between renderings lit as at `altitudes` and places `ahead` (m).

    `sky` is the emitter without its place. All renderings share the camera, its air and the sky behind.
    """
    points, _ = seen_points(description)
    by_altitude, by_place = weights(altitudes, height_of(points)), weights(ahead, points[..., 0])
    total = 0.0
    for i, altitude in enumerate(altitudes):
        for j, place in enumerate(ahead):
            share = (by_altitude[i] * by_place[j])[..., None]
            if not share.any():
                continue
            lit = {**sky, "type": "placed_welkin", "altitude": altitude, "ahead": place}
            scene = mi.load_dict({**description, "sky": lit})
            seed = 1 + i * len(ahead) + j
            total = total + share * rendered(scene, samples, seed, f"{label} lit at {altitude:g} m, {place:g} m")
    return total
