"""The integrator `welkin_path`: a path tracer with the air of the emitter `welkin` between things."""

import math

import drjit as dr
import mitsuba as mi

from .aerial_perspective import AerialPerspective, Place
from .emitter import WelkinSky
from .variants import number

EVERYWHERE = 2**31 - 1


class WelkinPath(mi.SamplingIntegrator):
    """Parameters: see README.md."""

    def __init__(self, props):
        super().__init__(props)
        if not dr.is_jit_v(mi.Float):
            raise ValueError("welkin_path needs a variant with arrays (llvm_…, cuda_…): others would call it ray by ray")
        depth = int(props.get("max_depth", -1))
        self.max_depth = EVERYWHERE if depth < 0 else depth
        self.rr_depth = int(props.get("rr_depth", 5))
        self.hide_sky = bool(props.get("hide_emitters", False))
        self.altitude = mi.Float(props.get("altitude", 0.0))
        self.metres = mi.Float(props.get("metres_per_unit", 1.0))
        self.made_for = None

    def traverse(self, callback):
        callback.put("altitude", self.altitude, mi.ParamFlags.NonDifferentiable)
        callback.put("metres_per_unit", self.metres, mi.ParamFlags.NonDifferentiable)

    def prepare(self, scene):
        """Makes the tables anew where the sky, the camera or the place has changed."""
        emitter = sky_of(scene)
        if not 0.0 < number(self.metres) < math.inf:
            raise ValueError(f"metres_per_unit must be positive, got {number(self.metres)}")
        camera = scene.sensors()[0].world_transform() @ mi.Point3f(0.0)
        state = (id(emitter), emitter.version, number(self.altitude), number(self.metres),
                 *(number(c) for c in camera))
        if state == self.made_for:
            return
        self.sky = emitter
        place = Place(emitter.to_world, number(self.metres), number(self.altitude), emitter.model.planet_radius)
        self.air = AerialPerspective(emitter, place, scene.bbox(), camera)
        self.seen = emitter.bodies_from(max(number(place.altitude(place.point(camera))), 0.0))
        self.made_for = state

    def sample(self, scene, sampler, ray, medium=None, active=True):
        self.prepare(scene)
        radiance, valid = self.trace(scene, sampler, ray, active)
        return radiance, valid, []

    @dr.syntax
    def trace(self, scene, sampler, ray, active):
        context = mi.BSDFContext()
        ray = mi.Ray3f(ray)
        radiance, throughput = mi.Spectrum(0.0), mi.Spectrum(1.0)
        eta, active = mi.Float(1.0), mi.Bool(active)
        before, pdf_before, delta_before = dr.zeros(mi.Interaction3f), mi.Float(1.0), mi.Bool(True)

        # The first path, from the camera.
        si = scene.ray_intersect(ray, active)
        valid = mi.Bool(si.is_valid())
        if dr.hint(not self.hide_sky, mode="scalar"):
            sky = self.sky.emission(ray.d, ray.wavelengths, active & ~valid, self.seen)
            radiance = dr.select(active & ~valid, sky, radiance)
        scattered, factor = self.through_air(ray, si.t, True, active & valid)
        radiance = dr.select(active & valid, radiance + scattered, radiance)
        throughput = times(throughput, mi.Spectrum(factor))
        active &= valid
        depth = mi.UInt32(0)

        while dr.hint(active, label="welkin_path"):
            # What the ray has come to: its own light.
            ds = mi.DirectionSample3f(scene, si, before)
            weight = mi.Float(1.0)
            pdf = scene.pdf_emitter_direction(before, ds, active & ~delta_before)
            weight = balance(pdf_before, dr.select(delta_before, 0.0, pdf))
            emitted = si.emitter(scene, active).eval(si, active)
            radiance = dr.select(active, radiance + times(throughput, emitted, mi.Spectrum(weight)), radiance)

            going = active & si.is_valid() & (depth + 1 < self.max_depth)
            bsdf = si.bsdf(ray)

            # Light that is drawn, through the air if it is in the scene.
            smooth = going & mi.has_flag(bsdf.flags(), mi.BSDFFlags.Smooth)
            ds, light = scene.sample_emitter_direction(si, sampler.next_2d(smooth), True, smooth)
            smooth &= ds.pdf != 0.0
            wo = si.to_local(ds.d)
            value, pdf = bsdf.eval_pdf(context, si, wo, smooth)
            value = si.to_world_mueller(value, -wo, si.wi)
            weight = dr.select(ds.delta, 1.0, balance(ds.pdf, pdf))
            near = smooth & ~mi.has_flag(ds.emitter.flags(), mi.EmitterFlags.Infinite)
            _, factor = self.through_air(si.spawn_ray(ds.d), ds.dist, False, near)
            light = dr.select(near, times(mi.Spectrum(factor), light), light)
            radiance = dr.select(smooth, radiance + times(throughput, value, light, mi.Spectrum(weight)), radiance)

            # The next path.
            sample, value = bsdf.sample(context, si, sampler.next_1d(going), sampler.next_2d(going), going)
            value = si.to_world_mueller(value, -sample.wo, si.wi)
            ray = si.spawn_ray(si.to_world(sample.wo))
            throughput = times(throughput, value)
            eta *= sample.eta
            before = mi.Interaction3f(si)
            pdf_before = sample.pdf
            delta_before = mi.has_flag(sample.sampled_type, mi.BSDFFlags.Delta)

            largest = dr.max(mi.unpolarized_spectrum(throughput)) * eta * eta
            survival = dr.select(depth >= self.rr_depth, dr.minimum(largest, 0.95), 1.0)
            going &= (largest > 0.0) & (sampler.next_1d(going) < survival)
            throughput = times(throughput, mi.Spectrum(1.0 / dr.maximum(survival, 1e-6)))

            si = scene.ray_intersect(ray, going)
            scattered, factor = self.through_air(ray, si.t, False, going & si.is_valid())
            radiance = dr.select(going & si.is_valid(), radiance + times(throughput, scattered), radiance)
            throughput = dr.select(going & si.is_valid(), times(throughput, mi.Spectrum(factor)), throughput)
            depth += 1
            active = going

        return radiance, valid

    def through_air(self, ray, length, from_camera, active):
        """In-scattered light and transmittance along a ray."""
        length = dr.select(active, length, 0.0)
        return self.air.along(ray.o, ray.d, length, ray.wavelengths, from_camera, active)

    def to_string(self):
        return "WelkinPath[]"


def times(first, *others):
    """The product of spectra: of Mueller matrices where light is polarised."""
    for other in others:
        first = first @ other if mi.is_polarized else first * other
    return first


def balance(a, b):
    """The power heuristic."""
    a, b = a * a, b * b
    return dr.select(a > 0.0, a / dr.maximum(a + b, 1e-30), 0.0)


def sky_of(scene):
    for emitter in scene.emitters():
        if isinstance(emitter, WelkinSky):
            return emitter
    raise ValueError("welkin_path needs an emitter of type welkin in the scene")
