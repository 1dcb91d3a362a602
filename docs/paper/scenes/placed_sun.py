"""The emitter `placed_sun`: sunlight on a round planet, at each point through the air above it, until the sun sets.

Directions are drawn over the disc, so that shadows have soft edges, but no other ray meets it: a mirror does not show
it. Spectral variants only. The frame is that of `planet`.
"""

import math

import drjit as dr
import mitsuba as mi
import numpy as np
import welkin_sky

from planet import RADIUS

FIRST, STEP, COUNT = 360.0, 10.0, 48
SOLAR_ANGULAR_RADIUS = 0.004654793
HIGHEST = 30e3
ALTITUDES, ELEVATIONS = 41, 65


def _table(model, elevations, visibility, albedo):
    """Irradiance of a plane that faces the sun: (altitudes, elevations, wavelengths), W m⁻² nm⁻¹."""
    centres = FIRST + STEP * np.arange(COUNT)
    triangle = [0.0, 1.0, 0.0]
    bands = model.bands([
        welkin_sky.Response.table([c - STEP, c, c + STEP], triangle).normalised() for c in centres])

    def irradiance(altitude, elevation):
        conditions = welkin_sky.Conditions(
            solar_elevation=elevation, visibility=visibility, albedo=albedo, altitude=altitude)
        disc = model.band_solar_disc(bands, conditions)
        return disc.irradiance(np.asarray(disc.direction, np.float32))

    altitudes = HIGHEST * np.linspace(0.0, 1.0, ALTITUDES) ** 2
    return np.array([[irradiance(a, e) for e in elevations] for a in altitudes], np.float32)


class PlacedSun(mi.Emitter):
    """Parameters: `solar_elevation`, `solar_azimuth` (degrees, at the origin), `visibility` (m), `albedo`, `reach` (m):
    how far from the origin things are."""

    def __init__(self, props):
        super().__init__(props)
        if not mi.is_spectral:
            raise ValueError("placed_sun needs a spectral variant")
        elevation = math.radians(props.get("solar_elevation", 20.0))
        azimuth = math.radians(props.get("solar_azimuth", 0.0))
        reach = props.get("reach", 400e3) / RADIUS + 0.005
        self.lowest, self.highest = elevation - reach, elevation + reach
        model = welkin_sky.default_model()
        low, high = (max(bound, model.solar_elevation_range[0]) for bound in (self.lowest, self.highest))
        elevations = np.clip(np.linspace(self.lowest, self.highest, ELEVATIONS), low, min(high, 0.5 * math.pi))
        self.table = mi.TensorXf(
            _table(model, elevations, props.get("visibility", 59.4e3), props.get("albedo", 0.2))).array
        flat = math.cos(elevation)
        self.sun = mi.Vector3f(flat * math.cos(azimuth), flat * math.sin(azimuth), math.sin(elevation))
        self.side = mi.Vector3f(-math.sin(azimuth), math.cos(azimuth), 0.0)
        self.up = dr.cross(self.sun, self.side)
        self.m_flags = mi.EmitterFlags.Infinite | mi.EmitterFlags.DeltaDirection
        self.length = mi.Float(2e6)

    def traverse(self, callback):
        pass

    def bbox(self):
        return mi.ScalarBoundingBox3f()

    def set_scene(self, scene):
        box = scene.bbox()
        if box.valid():
            self.length = mi.Float(4.0 * box.bounding_sphere().radius)

    def place(self, p):
        """Rows of the table for points: of the altitude and of the sun's elevation there."""
        flat = p.x * p.x + p.y * p.y
        far = dr.sqrt(flat + dr.square(p.z + RADIUS))
        altitude = (flat + p.z * (p.z + 2.0 * RADIUS)) / (far + RADIUS)
        sine = (dr.dot(self.sun, p) + self.sun.z * RADIUS) / far
        row = dr.sqrt(dr.clip(altitude / HIGHEST, 0.0, 1.0)) * (ALTITUDES - 1)
        share = (dr.asin(dr.clip(sine, -1.0, 1.0)) - self.lowest) / (self.highest - self.lowest)
        return row, dr.clip(share, 0.0, 1.0) * (ELEVATIONS - 1)

    def irradiance(self, p, wavelengths, active):
        cells = []
        for value, count in zip(self.place(p), (ALTITUDES, ELEVATIONS)):
            cell = dr.clip(dr.floor(value), 0.0, count - 2.0)
            cells.append((mi.UInt32(cell), value - cell))
        (i, s), (j, t) = cells
        values = []
        for wavelength in wavelengths:
            node = (wavelength - FIRST) / STEP
            cell = dr.clip(dr.floor(node), 0.0, COUNT - 2.0)
            k, u = mi.UInt32(cell), dr.clip(node - cell, 0.0, 1.0)
            total = mi.Float(0.0)
            for di, dj, dk in np.ndindex(2, 2, 2):
                weight = (s if di else 1.0 - s) * (t if dj else 1.0 - t) * (u if dk else 1.0 - u)
                index = ((i + di) * ELEVATIONS + (j + dj)) * COUNT + (k + dk)
                total = dr.fma(weight, dr.gather(mi.Float, self.table, index, active), total)
            values.append(total)
        return mi.UnpolarizedSpectrum(values)

    def sample_direction(self, it, sample, active=True):
        place = mi.warp.square_to_uniform_disk_concentric(sample) * math.tan(SOLAR_ANGULAR_RADIUS)
        d = dr.normalize(self.sun + place.x * self.side + place.y * self.up)
        ds = dr.zeros(mi.DirectionSample3f)
        ds.d, ds.n, ds.dist = d, -d, self.length
        ds.p = it.p + d * ds.dist
        ds.time, ds.pdf, ds.delta = it.time, dr.select(active, mi.Float(1.0), 0.0), mi.Bool(True)
        ds.emitter = mi.EmitterPtr(self)
        light = self.irradiance(it.p, it.wavelengths, active)
        return ds, mi.depolarizer(dr.select(active, light, mi.UnpolarizedSpectrum(0.0)))

    def pdf_direction(self, it, ds, active=True):
        return mi.Float(0.0)

    def eval_direction(self, it, ds, active=True):
        return mi.Spectrum(0.0)

    def eval(self, si, active=True):
        return mi.Spectrum(0.0)
