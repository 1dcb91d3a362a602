"""The air between things: tables for paths from the camera, and coarser ones for all others."""

import math

import drjit as dr
import mitsuba as mi
import numpy as np

from .segment_arrays import Extent, SegmentArrays
from .segment_table import SegmentTable
from .stokes import to_spectrum
from .variants import number

LOWEST = -400.0
# Of paths: farther than the air is seen through from space.
FARTHEST = 2e6


class Place:
    """How the world lies above the ground: metres per unit, and the altitude of its origin."""

    def __init__(self, to_world, metres, altitude, planet):
        self.to_world, self.metres, self.altitude_of_origin, self.planet = to_world, metres, altitude, planet

    def point(self, p):
        """In metres, +z up, from the ground below the origin."""
        local = self.to_world.inverse() @ mi.Vector3f(p) * self.metres
        return mi.Vector3f(local.x, local.y, local.z + self.altitude_of_origin)

    def altitude(self, point):
        """Above a round planet, so that single precision does."""
        z = point.z + self.planet
        q = dr.fma(point.x, point.x, point.y * point.y) / (z * z)
        return point.z + z * q * (0.5 - 0.125 * q)

    def vertical(self, point):
        return dr.normalize(mi.Vector3f(point.x, point.y, point.z + self.planet))


class AerialPerspective:
    def __init__(self, emitter, place, box, camera):
        """`box`: corners of all things in the world; `camera`: its place in the world."""
        self.place, self.to_world = place, emitter.turn
        low, high, far = span(place, box, camera)
        far = min(far, FARTHEST)
        seen_from = number(place.altitude(place.point(camera)))
        planet = place.planet
        floor = max(min(low, seen_from), LOWEST)
        # Layers of haze end within some hundred metres.
        steps = min(max(math.ceil((high - floor) / 250.0), 1), 15) + 1
        camera = Extent(planet, floor, seen_from, seen_from, far, 1, 25, 33, 16)
        # Extinction of the camera's paths has no azimuths: it is told apart more finely.
        lengths = Extent(planet, floor, seen_from, seen_from, far, 1, 65, 1, 33)
        others = Extent(planet, floor, floor, max(high, floor + 1.0), far, steps, 17, 11, 12)
        self.tables = []
        for sources, body in zip(emitter.sources_from(emitter.values["altitude"]), emitter.bodies):
            arrays = lambda extent, joined=False: SegmentArrays(
                sources.model, sources.key, sources.conditions, extent, joined)
            coarse = arrays(others)
            self.tables.append((
                body, SegmentTable(arrays(camera, True), arrays(lengths), body.sky_scale),
                SegmentTable(coarse, coarse, body.sky_scale)))

    def is_near(self, start, eye):
        """Whether paths from here may count as paths from the camera: its lens and near plane are some metres at most."""
        offset = dr.norm(start - eye) * self.place.metres
        return offset <= 2.0 + 1e-4 * dr.abs(self.place.altitude(self.place.point(eye)))

    def along(self, start, d, length, wavelengths, from_camera, active):
        """Spectra of the light that the air scatters towards `start` along `d`, and of the transmittance. `from_camera`:
        whether all paths begin there."""
        point = self.place.point(start)
        up = self.place.vertical(point)
        altitude = self.place.altitude(point)
        local = dr.normalize(self.to_world.inverse() @ d)
        mu = dr.clip(dr.dot(local, up), -1.0, 1.0)
        metres = length * self.place.metres
        parts, transmittance = None, None
        for body, camera, others in self.tables:
            table = camera if from_camera else others
            turn, side = turn_from(local, up, mu, body.direction)
            taps, fine = table.locate(altitude, mu, metres, turn)
            depths = table.optical_depths(fine, metres, wavelengths, active)
            light = table.in_scattering(taps, depths, dr.dot(local, body.direction), wavelengths, active)
            if len(light) == 3:
                light[2] = light[2] * side
            parts = light if parts is None else [a + b for a, b in zip(parts, light)]
            transmittance = table.transmittance(depths)
        azimuth = self.tables[0][0].table.azimuth
        return to_spectrum(parts, local, self.to_world, azimuth, active), transmittance


def turn_from(d, up, mu, light):
    """The azimuth from the light, absolute, and 1 to the left of it, −1 to the right."""
    side, along = d - up * mu, light - up * dr.dot(light, up)
    cross = dr.dot(up, dr.cross(along, side))
    return dr.atan2(dr.abs(cross), dr.dot(along, side)), dr.copysign(1.0, cross)


def span(place, box, camera):
    """The altitudes between which things are and the longest path, in metres."""
    corners = [
        [(box.min, box.max)[(k >> axis) & 1][axis] for axis in range(3)] for k in range(8)]
    points = [place.point(mi.Point3f(*[float(c) for c in corner])) for corner in corners]
    altitudes = [number(place.altitude(point)) for point in points]
    # The bottom of a box may be lower than its corners.
    altitudes.append(min(number(point.z) for point in points))
    points.append(place.point(camera))
    places = np.array([[number(point[axis]) for axis in range(3)] for point in points])
    far = np.linalg.norm(places.max(0) - places.min(0))
    return min(altitudes), max(altitudes), max(float(far), 100.0)
