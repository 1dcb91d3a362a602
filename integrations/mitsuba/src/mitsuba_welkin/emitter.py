"""The emitter `welkin`: the light of the clear sky and of the discs of sun and moon."""

import dataclasses
import math

import drjit as dr
import mitsuba as mi
import numpy as np
import welkin_sky

from .body import Body
from .sources import Sources
from .stokes import to_spectrum
from .variants import blank, given_number, number

# What is asked of welkin, with what holds where nothing is said. Of the moon the phase angle: 180 is new, and then not there.
CONDITIONS = {
    "solar_elevation": 20.0, "solar_azimuth": 0.0, "visibility": 59.4e3, "albedo": 0.2, "altitude": 0.0,
    "moon_phase": 180.0, "moon_elevation": 30.0, "moon_azimuth": 0.0,
}
SCALES = {"sky_scale": 1.0, "sun_scale": 1.0}


# Farther than all things, m or other units: Mitsuba does not tell emitters written in Python how large a scene is.
DISTANCE = 1e10


class WelkinSky(mi.Emitter):
    """Scene parameters (all but the model may be changed with `mi.traverse`): see README.md."""

    def __init__(self, props):
        super().__init__(props)
        self.path = props.get("model", "")
        self.model = welkin_sky.open(self.path) if self.path else welkin_sky.default_model()
        for name, default in (CONDITIONS | SCALES).items():
            setattr(self, name, mi.Float(given_number(props, name, default)))
        to_world = props.get("to_world", mi.ScalarTransform4f())
        self.to_world = mi.Transform4f(mi.Matrix4f(np.array(to_world.matrix)))
        self.m_flags = mi.EmitterFlags.Infinite | mi.EmitterFlags.SpatiallyVarying
        self.centre, self.radius = None, None
        self.version, self.values, self.turn = 0, None, None
        self.prepare()

    def traverse(self, callback):
        for name in (*CONDITIONS, *SCALES, "to_world"):
            callback.put(name, getattr(self, name), mi.ParamFlags.NonDifferentiable)

    def parameters_changed(self, keys=()):
        self.prepare()

    def prepare(self):
        """Takes the parameters over, all or, where one is bad, none: then what held before goes on."""
        before = self.values, self.turn
        try:
            self.values = {name: number(getattr(self, name)) for name in (*CONDITIONS, *SCALES)}
            self.turn = mi.Transform4f(self.to_world)
            self.check()
            self.bodies = self.bodies_from(self.values["altitude"])
        except Exception:
            self.values, self.turn = before
            raise
        fluxes = np.array([body.luminous_flux for body in self.bodies])
        shares = fluxes / fluxes.sum() if fluxes.sum() > 0.0 else np.full(len(fluxes), 1.0 / len(fluxes))
        self.first_share = dr.opaque(mi.Float, float(shares[0]))
        self.version += 1

    def check(self):
        for name in SCALES:
            if not 0.0 <= self.values[name] < math.inf:
                raise ValueError(f"{name} must be finite and not negative, got {self.values[name]}")
        turn = np.array(self.turn.matrix, np.float64).reshape(4, 4)[:3, :3]
        if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-4):
            raise ValueError("to_world must turn and move only, not scale")

    def lights(self):
        """(model, conditions) of the sun and of a moon that is not new: of two, those above the model's lowest sun."""
        of = self.values
        conditions = welkin_sky.Conditions(
            solar_elevation=math.radians(of["solar_elevation"]),
            solar_azimuth=math.radians(of["solar_azimuth"]),
            visibility=of["visibility"],
            albedo=of["albedo"],
            altitude=of["altitude"],
        )
        if of["moon_phase"] == 180.0:
            return [(self.model, conditions)]
        moon = welkin_sky.Moon(
            elevation=math.radians(of["moon_elevation"]), azimuth=math.radians(of["moon_azimuth"]),
            phase_angle=math.radians(of["moon_phase"]))
        both = [(self.model, conditions), (self.model.moonlit(moon), moon.conditions(conditions))]
        lowest = self.model.solar_elevation_range[0]
        return [pair for pair in both if pair[1].solar_elevation >= lowest] or both[:1]

    def sources_from(self, altitude):
        """Of each light, as seen from an altitude."""
        return [
            Sources(model, (self.path, self.values["moon_phase"] if model.is_moonlit else None),
                    dataclasses.replace(conditions, altitude=altitude))
            for model, conditions in self.lights()]

    def bodies_from(self, altitude):
        scales = self.values["sky_scale"], self.values["sun_scale"]
        try:
            return [Body(sources, *scales) for sources in self.sources_from(altitude)]
        except welkin_sky.RangeError as error:
            raise ValueError(f"{error} (radians here; parameters of scenes are in degrees)") from error

    # Geometry

    def set_scene(self, scene):
        """Tells where the scene is: for light that is traced from the sky (`sample_ray`), and not needed else."""
        box = scene.bbox()
        if box.valid():
            sphere = box.bounding_sphere()
            self.centre = mi.Point3f(sphere.center)
            self.radius = mi.Float(max(1e-4, sphere.radius * (1.0 + 1e-4)))

    def bbox(self):
        return mi.ScalarBoundingBox3f()

    def to_local(self, d):
        return dr.normalize(self.turn.inverse() @ mi.Vector3f(d))

    # Light

    def emission(self, d, wavelengths, active, bodies=None):
        """From direction `d` of the world, in which light travels along −d."""
        local = self.to_local(d)
        bodies = bodies or self.bodies
        parts = [body.stokes(local, wavelengths, active) for body in bodies]
        total = [sum(same[1:], same[0]) for same in zip(*parts)]
        return to_spectrum(total, local, self.turn, bodies[0].table.azimuth, active)

    def eval(self, si, active=True):
        return self.emission(-si.wi, si.wavelengths, active)

    def eval_direction(self, it, ds, active=True):
        return self.emission(ds.d, it.wavelengths, active)

    # Sampling

    def draw(self, sample):
        """A direction of the local frame and its density, sr⁻¹."""
        if len(self.bodies) == 1:
            d = self.bodies[0].draw(sample)
            return d, self.density_of(d)
        is_first = sample.x < self.first_share
        low = sample.x / dr.maximum(self.first_share, 1e-9)
        high = (sample.x - self.first_share) / dr.maximum(1.0 - self.first_share, 1e-9)
        u = mi.Point2f(dr.clip(dr.select(is_first, low, high), 0.0, 1.0 - 2.0**-24), sample.y)
        d = dr.select(is_first, self.bodies[0].draw(u), self.bodies[1].draw(u))
        return d, self.density_of(d)

    def density_of(self, d):
        first = self.bodies[0].pdf(d)
        if len(self.bodies) == 1:
            return first
        second = self.bodies[1].pdf(d)
        return dr.fma(self.first_share, first - second, second)

    def sample_direction(self, it, sample, active=True):
        local, pdf = self.draw(sample)
        d = dr.normalize(self.turn @ local)
        ds = blank(mi.DirectionSample3f)
        ds.d, ds.n = d, -d
        ds.dist = mi.Float(DISTANCE)
        ds.p = it.p + d * ds.dist
        ds.time = it.time
        ds.pdf = dr.select(active, pdf, 0.0)
        ds.delta = mi.Bool(False)
        ds.emitter = mi.EmitterPtr(self) if dr.is_jit_v(mi.Float) else self
        active = active & (pdf > 0.0)
        weight = dr.select(active, 1.0 / dr.maximum(pdf, 1e-30), 0.0)
        return ds, self.emission(d, it.wavelengths, active) * weight

    def pdf_direction(self, it, ds, active=True):
        return dr.select(active, self.density_of(self.to_local(ds.d)), 0.0)

    def sample_ray(self, time, wavelength_sample, sample2, sample3, active=True):
        if self.radius is None:
            raise ValueError("light is traced from the emitter welkin only after emitter.set_scene(scene)")
        local, pdf = self.draw(sample3)
        d = -dr.normalize(self.turn @ local)
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

    def sample_position(self, time, sample, active=True):
        """Of infinite emitters none is drawn: integrators ask all and take others'."""
        return blank(mi.PositionSample3f), mi.Float(0.0)

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
        return f"WelkinSky[{self.lights()[0][1]}]"
