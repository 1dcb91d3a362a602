"""The emitter `welkin`: the light of the clear sky and of the sun's disc."""

import math

import drjit as dr
import mitsuba as mi
import numpy as np
import welkin_sky

from .sky_table import SkyTable, gather, storage
from .sources import COUNT, DISC, EFFICACY, FIRST, SOLAR_ANGULAR_RADIUS, STEP, Y_INTEGRAL, Sources

COLOURS = EFFICACY * Y_INTEGRAL


def blank(kind):
    """All zeros; `dr.zeros` makes no structures of scalar variants."""
    return dr.zeros(kind) if dr.is_jit_v(mi.Float) else kind()


class WelkinSky(mi.Emitter):
    """Scene parameters (all may be changed with `mi.traverse`): see README.md."""

    def __init__(self, props):
        super().__init__(props)
        path = props.get("model", "")
        self.key = path
        self.model = welkin_sky.open(path) if path else welkin_sky.default_model()
        self.solar_elevation = mi.Float(props.get("solar_elevation", 20.0))
        self.solar_azimuth = mi.Float(props.get("solar_azimuth", 0.0))
        self.visibility = mi.Float(props.get("visibility", 59.4e3))
        self.albedo = mi.Float(props.get("albedo", 0.2))
        self.altitude = mi.Float(props.get("altitude", 0.0))
        self.sky_scale = mi.Float(props.get("sky_scale", 1.0))
        self.sun_scale = mi.Float(props.get("sun_scale", 1.0))
        to_world = props.get("to_world", mi.ScalarTransform4f())
        self.to_world = mi.Transform4f(mi.Matrix4f(np.array(to_world.matrix)))
        self.m_flags = mi.EmitterFlags.Infinite | mi.EmitterFlags.SpatiallyVarying
        self.centre, self.radius = mi.Point3f(0.0), mi.Float(1.0)
        self.prepare()

    def traverse(self, callback):
        for name in ("solar_elevation", "solar_azimuth", "visibility", "albedo", "altitude"):
            callback.put(name, getattr(self, name), mi.ParamFlags.NonDifferentiable)
        for name in ("sky_scale", "sun_scale", "to_world"):
            callback.put(name, getattr(self, name), mi.ParamFlags.NonDifferentiable)

    def parameters_changed(self, keys=()):
        self.prepare()

    def conditions(self):
        one = lambda value: float(dr.slice(value)) if dr.is_jit_v(value) else float(value)
        return welkin_sky.Conditions(
            solar_elevation=math.radians(one(self.solar_elevation)),
            solar_azimuth=math.radians(one(self.solar_azimuth)),
            visibility=one(self.visibility),
            albedo=one(self.albedo),
            altitude=one(self.altitude),
        )

    def prepare(self):
        sources = Sources(self.model, self.key, self.conditions())
        self.table = SkyTable(sources.buffers)
        self.density = mi.MarginalContinuous2D0(sources.density())
        self.azimuth = dr.opaque(mi.Float, sources.conditions.solar_azimuth)
        lattice, side, up = sources.disc_lattice()
        self.disc = storage(lattice)
        vector = lambda v: mi.Vector3f(*[dr.opaque(mi.Float, float(c)) for c in v])
        self.sun, self.side, self.up = vector(sources.disc.direction), vector(side), vector(up)
        self.cosine = math.cos(SOLAR_ANGULAR_RADIUS)
        self.tangent = math.tan(SOLAR_ANGULAR_RADIUS)
        sun = sources.sun_luminous_flux() if sources.disc.is_visible else 0.0
        sky = sources.sky_luminous_flux()
        one = lambda value: float(dr.slice(value)) if dr.is_jit_v(value) else float(value)
        sun, sky = sun * one(self.sun_scale), sky * one(self.sky_scale)
        share = 0.0 if sun <= 0.0 else min(max(sun / (sun + sky), 0.1), 0.9)
        self.sun_share = dr.opaque(mi.Float, share)

    # Geometry

    def set_scene(self, scene):
        box = scene.bbox()
        if box.valid():
            sphere = box.bounding_sphere()
            self.centre = mi.Point3f(sphere.center)
            self.radius = mi.Float(max(1e-4, sphere.radius * (1.0 + 1e-4)))

    def bbox(self):
        return mi.ScalarBoundingBox3f()

    def to_local(self, d):
        return dr.normalize(self.to_world.inverse() @ mi.Vector3f(d))

    # Light

    def radiance(self, d, wavelengths, active):
        """Light from direction `d` of the local frame, which travels along −d in the world."""
        place = self.table.locate(d)
        x, y, inside = self.on_disc(d)
        if not (mi.is_spectral or mi.is_polarized):
            values = [self.table.value(place, c, active) * self.sky_scale for c in range(3)]
            sun = [self.disc_value(x, y, c, active & inside) * self.sun_scale for c in range(3)]
            xyz = [(v + dr.select(inside, s, 0.0)) / COLOURS for v, s in zip(values, sun)]
            return self.from_xyz(xyz)
        return self.spectrum(place, (x, y, inside), wavelengths, active)

    def from_xyz(self, xyz):
        rgb = mi.xyz_to_srgb(mi.Color3f(*xyz))
        return mi.UnpolarizedSpectrum(xyz[1]) if mi.is_monochromatic else mi.UnpolarizedSpectrum(rgb)

    def on_disc(self, d):
        along = dr.dot(d, self.sun)
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

    def spectrum(self, place, disc, wavelengths, active):
        x, y, inside = disc
        light, q, u = [], [], []
        for wavelength in wavelengths:
            node = (wavelength - FIRST) / STEP
            cell = dr.clip(dr.floor(node), 0.0, COUNT - 2.0)
            t, first = dr.clip(node - cell, 0.0, 1.0), mi.UInt32(cell)
            known = active & (node >= -1e-3) & (node <= COUNT - 1 + 1e-3)
            sky = [self.table.value(place, first + k, known) * self.sky_scale for k in (0, 1)]
            sun = [self.disc_value(x, y, first + k, known & inside) * self.sun_scale for k in (0, 1)]
            mix = lambda pair: dr.select(known, dr.fma(t, pair[1] - pair[0], pair[0]), 0.0)
            light.append(mix(sky) + dr.select(inside, mix(sun), 0.0))
            if mi.is_polarized:
                degrees = [self.table.degrees(place, first + k, known) for k in (0, 1)]
                q.append(mix([sky[k] * degrees[k][0] for k in (0, 1)]))
                u.append(mix([sky[k] * degrees[k][1] for k in (0, 1)]))
        if not mi.is_polarized:
            return mi.UnpolarizedSpectrum(light)
        return [mi.UnpolarizedSpectrum(part) for part in (light, q, u)]

    def emission(self, d, si_wavelengths, active):
        """The full spectrum of Mitsuba: with polarisation its first column is the Stokes vector."""
        local = self.to_local(d)
        value = self.radiance(local, si_wavelengths, active)
        if not mi.is_polarized:
            return value & active if dr.is_jit_v(mi.Float) else (value if active else value * 0.0)
        light, q, u = value
        forward = -d
        # welkin's first axis: up in the vertical plane, carried to the world.
        flat = dr.sqrt(dr.fma(local.x, local.x, local.y * local.y))
        shrink = 1.0 / dr.maximum(flat, 1e-20)
        c, s = self.table.azimuth
        cos_a = dr.select(flat > 0.0, local.x * shrink, c)
        sin_a = dr.select(flat > 0.0, local.y * shrink, s)
        axis = mi.Vector3f(-local.z * cos_a, -local.z * sin_a, flat)
        axis = dr.normalize(self.to_world @ axis)
        turn = mi.mueller.rotate_stokes_basis(forward, axis, mi.mueller.stokes_basis(forward))
        # Mitsuba counts angles about the direction in which light travels, welkin as it is seen: U has the other sign.
        q, u = turn[1, 1] * q - turn[1, 2] * u, turn[2, 1] * q - turn[2, 2] * u
        spectrum = mi.Spectrum(0.0)
        zero = mi.UnpolarizedSpectrum(0.0)
        spectrum[0, 0] = dr.select(active, light, zero)
        spectrum[1, 0] = dr.select(active, q, zero)
        spectrum[2, 0] = dr.select(active, u, zero)
        return spectrum

    def eval(self, si, active=True):
        return self.emission(-si.wi, si.wavelengths, active)

    def eval_direction(self, it, ds, active=True):
        return self.emission(ds.d, it.wavelengths, active)

    # Sampling

    def draw(self, sample):
        """A direction of the local frame and its density, sr⁻¹."""
        is_sun = sample.x < self.sun_share
        low = sample.x / dr.maximum(self.sun_share, 1e-6)
        high = (sample.x - self.sun_share) / dr.maximum(1.0 - self.sun_share, 1e-6)
        u = mi.Point2f(dr.clip(dr.select(is_sun, low, high), 0.0, 1.0 - 2.0**-24), sample.y)
        place, _ = self.density.sample(u)
        d = dr.select(is_sun, self.disc_direction(u), self.sky_direction(place))
        return d, self.density_of(d)

    def disc_direction(self, u):
        place = mi.warp.square_to_uniform_disk_concentric(u) * self.tangent
        return dr.normalize(self.sun + place.x * self.side + place.y * self.up)

    def sky_direction(self, place):
        share = 2.0 * place.y - 1.0
        z = dr.clip(share * dr.abs(share), -1.0, 1.0)
        sin_phi, cos_phi = dr.sincos(self.azimuth + (place.x - 0.5) * (2.0 * dr.pi))
        flat = dr.safe_sqrt(1.0 - z * z)
        return mi.Vector3f(flat * cos_phi, flat * sin_phi, z)

    def density_of(self, d):
        _, _, inside = self.on_disc(d)
        along = dr.dot(d, self.sun)
        # A uniform disc on the tangent plane.
        area = dr.pi * self.tangent * self.tangent
        sun = dr.select(inside, 1.0 / (area * along * along * along), 0.0)
        share = dr.sqrt(dr.abs(d.z))
        v = 0.5 + 0.5 * dr.copysign(share, d.z)
        turn = dr.atan2(d.y, d.x) - self.azimuth
        u = turn * dr.inv_two_pi + 0.5
        u -= dr.floor(u)
        sky = self.density.eval(mi.Point2f(u, v)) / dr.maximum(8.0 * dr.pi * share, 1e-9)
        return dr.fma(self.sun_share, sun - sky, sky)

    def sample_direction(self, it, sample, active=True):
        local, pdf = self.draw(sample)
        d = dr.normalize(self.to_world @ local)
        ds = blank(mi.DirectionSample3f)
        ds.d, ds.n = d, -d
        ds.dist = self.distance(it)
        ds.p = it.p + d * ds.dist
        ds.time = it.time
        ds.pdf = dr.select(active, pdf, 0.0)
        ds.delta = mi.Bool(False)
        ds.emitter = mi.EmitterPtr(self) if dr.is_jit_v(mi.Float) else self
        active = active & (pdf > 0.0)
        weight = dr.select(active, 1.0 / dr.maximum(pdf, 1e-30), 0.0)
        return ds, self.emission(d, it.wavelengths, active) * weight

    def distance(self, it):
        return 2.0 * dr.maximum(self.radius, dr.norm(it.p - self.centre))

    def pdf_direction(self, it, ds, active=True):
        return dr.select(active, self.density_of(self.to_local(ds.d)), 0.0)

    def sample_ray(self, time, wavelength_sample, sample2, sample3, active=True):
        local, pdf = self.draw(sample3)
        d = -dr.normalize(self.to_world @ local)
        place = mi.warp.square_to_uniform_disk_concentric(sample2)
        offset = mi.Frame3f(d).to_world(mi.Vector3f(place.x, place.y, 0.0))
        origin = self.centre + (offset - d) * self.radius
        si = blank(mi.SurfaceInteraction3f)
        si.time, si.p, si.wi = time, origin, d
        wavelengths, _ = self.sample_wavelengths(si, wavelength_sample, active)
        si.wavelengths = wavelengths
        area = dr.pi * self.radius * self.radius
        weight = self.emission(-d, wavelengths, active) * (area / pdf)
        if mi.is_spectral:
            weight *= self.wavelength_range()
        return mi.Ray3f(origin, d, time, wavelengths), weight

    @staticmethod
    def wavelength_range():
        return mi.MI_CIE_MAX - mi.MI_CIE_MIN if hasattr(mi, "MI_CIE_MAX") else 470.0

    def sample_wavelengths(self, si, sample, active=True):
        if not mi.is_spectral:
            return mi.Color0f() if hasattr(mi, "Color0f") else si.wavelengths, self.eval(si, active)
        shifted = mi.math.sample_shifted(mi.UnpolarizedSpectrum, sample) if hasattr(mi.math, "sample_shifted") else None
        if shifted is None:
            n = len(si.wavelengths)
            shifted = [(lambda v: v - dr.floor(v))(sample + i / n) for i in range(n)]
        wavelengths = type(si.wavelengths)([360.0 + self.wavelength_range() * v for v in shifted])
        si.wavelengths = wavelengths
        return wavelengths, self.eval(si, active) * self.wavelength_range()

    def to_string(self):
        return f"WelkinSky[{self.conditions()}]"
