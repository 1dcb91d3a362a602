"""The emitter `placed_welkin`: what is seen and the air are of the camera's place; things are lit as at another one.

An emitter of Mitsuba does not know which point it lights. A large scene is rendered several times, each time lit as at
one place, and `rendering.rendered_over_places` mixes the pictures by what is seen in each pixel.
"""

import math

import mitsuba as mi
import mitsuba_welkin
import numpy as np

from planet import RADIUS

CONDITIONS = ("solar_elevation", "solar_azimuth", "visibility", "albedo", "sky_scale", "sun_scale", "model")


def _sun_seen_from(elevation, azimuth, tilt):
    """Degrees of the sun at a place ahead (+x) whose vertical leans by `tilt` (rad), in that place's frame."""
    e, a = math.radians(elevation), math.radians(azimuth)
    x, y, z = math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)
    c, s = math.cos(tilt), math.sin(tilt)
    x, z = c * x - s * z, s * x + c * z
    return math.degrees(math.asin(max(-1.0, min(1.0, z)))), math.degrees(math.atan2(y, x))


class PlacedSky(mitsuba_welkin.register()):
    """Parameters: those of `welkin`; `altitude` and `ahead` (m) are of the place whose light falls on things."""

    def __init__(self, props):
        given = {name: props[name] for name in CONDITIONS if name in props}
        tilt = float(props.get("ahead", 0.0)) / RADIUS
        elevation, azimuth = _sun_seen_from(
            float(given.get("solar_elevation", 20.0)), float(given.get("solar_azimuth", 0.0)), tilt)
        given.update(solar_elevation=elevation, solar_azimuth=azimuth, altitude=props.get("altitude", 0.0))
        turned = mi.ScalarTransform4f().rotate([0, 1, 0], math.degrees(tilt))
        super().__init__(props)
        self.light = mi.load_dict({"type": "welkin", "to_world": turned, **given})

    def set_scene(self, scene):
        super().set_scene(scene)
        self.light.set_scene(scene)

    def eval(self, si, active=True):
        return self.light.eval(si, active)

    def eval_direction(self, it, ds, active=True):
        return self.light.eval_direction(it, ds, active)

    def sample_direction(self, it, sample, active=True):
        ds, weight = self.light.sample_direction(it, sample, active)
        ds.emitter = mi.EmitterPtr(self)
        return ds, weight

    def pdf_direction(self, it, ds, active=True):
        return self.light.pdf_direction(it, ds, active)
