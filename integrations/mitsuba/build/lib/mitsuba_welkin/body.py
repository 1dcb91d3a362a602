"""One light of the sky, the sun or the moon: the air that it lights and its disc, evaluated and drawn from."""

import math

import drjit as dr
import mitsuba as mi

from .sky_table import SkyTable
from .sources import COUNT, DISC, EFFICACY, FIRST, SOLAR_ANGULAR_RADIUS, STEP, Y_INTEGRAL
from .variants import gather, storage

COLOURS = EFFICACY * Y_INTEGRAL


def from_xyz(xyz):
    """Mitsuba's colour of XYZ in cd m⁻² (lm m⁻² of a plane)."""
    xyz = [value / COLOURS for value in xyz]
    rgb = mi.xyz_to_srgb(mi.Color3f(*xyz))
    return mi.UnpolarizedSpectrum(xyz[1]) if mi.is_monochromatic else mi.UnpolarizedSpectrum(rgb)


def between_wavelengths(wavelength, active):
    """The lower of two of the wavelengths that are known, the share of the upper, and whether light is known here."""
    node = (wavelength - FIRST) / STEP
    cell = dr.clip(dr.floor(node), 0.0, COUNT - 2.0)
    known = active & (node >= -1e-3) & (node <= COUNT - 1 + 1e-3)
    return mi.UInt32(cell), dr.clip(node - cell, 0.0, 1.0), known


class Body:
    """Directions are of the local frame: +z up. Radiance is W m⁻² sr⁻¹ nm⁻¹, of colours as Mitsuba scales spectra."""

    def __init__(self, sources, sky_scale, disc_scale):
        self.table = SkyTable(sources.buffers)
        self.density = mi.MarginalContinuous2D0(sources.density())
        self.azimuth = dr.opaque(mi.Float, sources.conditions.solar_azimuth)
        lattice, side, up = sources.disc_lattice()
        self.disc = storage(lattice)
        vector = lambda v: mi.Vector3f(*[dr.opaque(mi.Float, float(c)) for c in v])
        self.direction, self.side, self.up = vector(sources.disc.direction), vector(side), vector(up)
        self.tangent = math.tan(SOLAR_ANGULAR_RADIUS)
        self.sky_scale, self.disc_scale = dr.opaque(mi.Float, sky_scale), dr.opaque(mi.Float, disc_scale)
        disc = sources.disc_luminous_flux() * disc_scale
        sky = sources.sky_luminous_flux() * sky_scale
        self.luminous_flux = disc + sky
        share = 0.0 if disc <= 0.0 else min(max(disc / (disc + sky), 0.1), 0.9)
        self.disc_share = dr.opaque(mi.Float, share)

    # Light

    def colour(self, d, active):
        place = self.table.locate(d)
        x, y, inside = self.on_disc(d)
        values = [self.table.value(place, c, active) * self.sky_scale for c in range(3)]
        disc = [self.disc_value(x, y, c, active & inside) * self.disc_scale for c in range(3)]
        return from_xyz([v + dr.select(inside, s, 0.0) for v, s in zip(values, disc)])

    def spectrum(self, d, wavelengths, active):
        """I, and Q and U in welkin's vertical frame where light is polarised."""
        place = self.table.locate(d)
        x, y, inside = self.on_disc(d)
        light, q, u = [], [], []
        for wavelength in wavelengths:
            first, t, known = between_wavelengths(wavelength, active)
            sky = [self.table.value(place, first + k, known) * self.sky_scale for k in (0, 1)]
            disc = [self.disc_value(x, y, first + k, known & inside) * self.disc_scale for k in (0, 1)]
            mix = lambda pair: dr.select(known, dr.fma(t, pair[1] - pair[0], pair[0]), 0.0)
            light.append(mix(sky) + dr.select(inside, mix(disc), 0.0))
            if mi.is_polarized:
                degrees = [self.table.degrees(place, first + k, known) for k in (0, 1)]
                q.append(mix([sky[k] * degrees[k][0] for k in (0, 1)]))
                u.append(mix([sky[k] * degrees[k][1] for k in (0, 1)]))
        parts = (light, q, u) if mi.is_polarized else (light,)
        return [mi.UnpolarizedSpectrum(part) for part in parts]

    def stokes(self, d, wavelengths, active):
        if mi.is_spectral or mi.is_polarized:
            return self.spectrum(d, wavelengths, active)
        return [self.colour(d, active)]

    def on_disc(self, d):
        along = dr.dot(d, self.direction)
        shrink = 1.0 / (dr.maximum(along, 1e-6) * self.tangent)
        x, y = dr.dot(d, self.side) * shrink, dr.dot(d, self.up) * shrink
        inside = (along > 0.0) & (dr.fma(x, x, y * y) <= 1.0)
        return x, y, inside

    def disc_value(self, x, y, channel, active):
        """Radiance of the disc, bilinear in its lattice."""
        last = DISC - 1
        column, row = 0.5 * (x + 1.0) * last, 0.5 * (y + 1.0) * last
        i, j = (dr.clip(dr.floor(v), 0.0, last - 1.0) for v in (column, row))
        s, t = column - i, row - j
        base = mi.UInt32(channel) * (DISC * DISC) + mi.UInt32(j) * DISC + mi.UInt32(i)
        at = lambda k: gather(self.disc, base + k, active)
        low = dr.fma(s, at(1) - at(0), at(0))
        high = dr.fma(s, at(DISC + 1) - at(DISC), at(DISC))
        return dr.fma(t, high - low, low)

    # Sampling

    def draw(self, sample):
        """A direction."""
        is_disc = sample.x < self.disc_share
        low = sample.x / dr.maximum(self.disc_share, 1e-6)
        high = (sample.x - self.disc_share) / dr.maximum(1.0 - self.disc_share, 1e-6)
        u = mi.Point2f(dr.clip(dr.select(is_disc, low, high), 0.0, 1.0 - 2.0**-24), sample.y)
        place, _ = self.density.sample(u)
        return dr.select(is_disc, self.disc_direction(u), self.sky_direction(place))

    def disc_direction(self, u):
        place = mi.warp.square_to_uniform_disk_concentric(u) * self.tangent
        return dr.normalize(self.direction + place.x * self.side + place.y * self.up)

    def sky_direction(self, place):
        share = 2.0 * place.y - 1.0
        z = dr.clip(share * dr.abs(share), -1.0, 1.0)
        sin_phi, cos_phi = dr.sincos(self.azimuth + (place.x - 0.5) * (2.0 * dr.pi))
        flat = dr.safe_sqrt(1.0 - z * z)
        return mi.Vector3f(flat * cos_phi, flat * sin_phi, z)

    def pdf(self, d):
        """Of `draw`, sr⁻¹."""
        _, _, inside = self.on_disc(d)
        along = dr.dot(d, self.direction)
        # A uniform disc on the tangent plane.
        area = dr.pi * self.tangent * self.tangent
        disc = dr.select(inside, 1.0 / (area * along * along * along), 0.0)
        share = dr.sqrt(dr.abs(d.z))
        v = 0.5 + 0.5 * dr.copysign(share, d.z)
        turn = dr.atan2(d.y, d.x) - self.azimuth
        u = turn * dr.inv_two_pi + 0.5
        u -= dr.floor(u)
        sky = self.density.eval(mi.Point2f(u, v)) / dr.maximum(8.0 * dr.pi * share, 1e-9)
        return dr.fma(self.disc_share, disc - sky, sky)
