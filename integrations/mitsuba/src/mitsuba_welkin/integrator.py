"""The integrator `welkin_path`: a path tracer with the air of the emitter `welkin` between things."""

import math

import drjit as dr
import mitsuba as mi

from .aerial_perspective import AerialPerspective, Place
from .emitter import WelkinSky
from .variants import given_number, number

EVERYWHERE = 2**31 - 1


class WelkinPath(mi.SamplingIntegrator):
    """Parameters: see README.md."""

    def __init__(self, props):
        super().__init__(props)
        if not dr.is_jit_v(mi.Float):
            raise ValueError("welkin_path needs a variant with arrays (llvm_…, cuda_…): others would call it ray by ray")
        self.max_depth = depth_of(props, "max_depth", -1, 0)
        self.rr_depth = depth_of(props, "rr_depth", 5, 1)
        self.hide_sky = bool(props.get("hide_emitters", False))
        self.altitude = mi.Float(given_number(props, "altitude", 0.0))
        self.metres = mi.Float(given_number(props, "metres_per_unit", 1.0))
        self.sensor, self.made_for = None, None

    def render(self, scene, sensor=0, *others, **named):
        self.sensor = scene.sensors()[sensor] if isinstance(sensor, int) else sensor
        return super().render(scene, sensor, *others, **named)

    def traverse(self, callback):
        callback.put("altitude", self.altitude, mi.ParamFlags.NonDifferentiable)
        callback.put("metres_per_unit", self.metres, mi.ParamFlags.NonDifferentiable)

    def prepare(self, scene):
        """Makes the tables anew where the sky, the camera or the place has changed."""
        emitter = sky_of(scene)
        if not 0.0 < number(self.metres) < math.inf:
            raise ValueError(f"metres_per_unit must be positive, got {number(self.metres)}")
        camera = self.camera(scene)
        box = scene.bbox()
        if not box.valid():
            box = mi.ScalarBoundingBox3f(mi.ScalarPoint3f([number(c) for c in camera]))
        corners = [float(c) for corner in (box.min, box.max) for c in corner]
        state = (id(scene), id(emitter), emitter.version, number(self.altitude), number(self.metres), *corners,
                 *(number(c) for c in camera))
        if state == self.made_for:
            return
        if not all(map(math.isfinite, (*corners, number(self.altitude)))):
            raise ValueError(f"welkin_path needs a scene of finite size and place, got {corners}")
        self.sky = emitter
        place = Place(emitter.turn, number(self.metres), number(self.altitude), emitter.model.planet_radius)
        self.air = AerialPerspective(emitter, place, box, camera)
        self.eye = mi.Point3f(*[dr.opaque(mi.Float, number(c)) for c in camera])
        seen_from = max(number(place.altitude(place.point(camera))), 0.0)
        self.seen = emitter.bodies_from(seen_from)
        # Between the altitude of the camera and that of what is lit: which sky is nearer.
        self.middle = dr.opaque(mi.Float, 0.5 * (seen_from + emitter.values["altitude"]))
        self.camera_is_higher = dr.opaque(mi.Bool, seen_from > emitter.values["altitude"])
        self.made_for = state

    def camera(self, scene):
        """The place of the camera that is rendered, of the first where another integrator asks."""
        sensor = self.sensor or (scene.sensors()[0] if scene.sensors() else None)
        if sensor is None:
            raise ValueError("welkin_path needs a sensor in the scene")
        return sensor.world_transform() @ mi.Point3f(0.0)

    def sample(self, scene, sampler, ray, medium=None, active=True):
        self.prepare(scene)
        radiance, valid = self.trace(scene, sampler, ray, active)
        return radiance, valid, []

    @dr.syntax
    def trace(self, scene, sampler, ray, active):
        context = mi.BSDFContext()
        ray = mi.Ray3f(ray)
        radiance, throughput = mi.Spectrum(0.0), mi.Spectrum(1.0)
        eta, active = mi.Float(1.0), mi.Bool(active) & (self.max_depth > 0)
        before, pdf_before, delta_before = dr.zeros(mi.Interaction3f), mi.Float(1.0), mi.Bool(True)

        # The first path, from the camera: finer tables know those that start where it is.
        si = scene.ray_intersect(ray, active)
        valid = mi.Bool(si.is_valid())
        at_eye = self.air.is_near(ray.o, self.eye)
        if dr.hint(not self.hide_sky, mode="scalar"):
            radiance = self.seen_sky(ray, active & ~valid)
        hit = active & valid
        scattered, factor = self.through_air(ray, si.t, True, hit & at_eye)
        if hit & ~at_eye:
            scattered, factor = self.through_air(ray, si.t, False, hit & ~at_eye)
        radiance = dr.select(hit, radiance + scattered, radiance)
        throughput = times(throughput, mi.Spectrum(factor))
        active = hit
        valid |= not self.hide_sky
        depth = mi.UInt32(0)

        while dr.hint(active, label="welkin_path"):
            # What the ray has come to: its own light.
            ds = mi.DirectionSample3f(scene, si, before)
            pdf = scene.pdf_emitter_direction(before, ds, active & ~delta_before)
            weight = balance(pdf_before, dr.select(delta_before, 0.0, pdf))
            light = si.emitter(scene, active)
            # Straight on or mirrored, no light was drawn there: the sky may be that of the camera.
            sky = active & delta_before & ~si.is_valid()
            emitted = light.eval(si, active & ~sky)
            if sky:
                emitted = self.seen_sky(ray, sky)
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
            survival = dr.select(depth + 1 >= self.rr_depth, dr.minimum(largest, 0.95), 1.0)
            going &= (largest > 0.0) & (sampler.next_1d(going) < survival)
            throughput = times(throughput, mi.Spectrum(1.0 / dr.maximum(survival, 1e-6)))

            si = scene.ray_intersect(ray, going)
            scattered, factor = self.through_air(ray, si.t, False, going & si.is_valid())
            radiance = dr.select(going & si.is_valid(), radiance + times(throughput, scattered), radiance)
            throughput = dr.select(going & si.is_valid(), times(throughput, mi.Spectrum(factor)), throughput)
            depth += 1
            active = going

        return radiance, valid

    @dr.syntax
    def seen_sky(self, ray, active):
        """The sky as from the altitude of the camera or from that of what is lit, which is nearer to where a ray starts."""
        altitude = self.air.place.altitude(self.air.place.point(ray.o))
        by_camera = active & ((altitude > self.middle) == self.camera_is_higher)
        light = mi.Spectrum(0.0)
        if by_camera:
            light = self.sky.emission(ray.d, ray.wavelengths, by_camera, self.seen)
        if active & ~by_camera:
            light = self.sky.emission(ray.d, ray.wavelengths, active & ~by_camera)
        return light

    def through_air(self, ray, length, from_camera, active):
        """In-scattered light and transmittance along a ray."""
        length = dr.select(active, length, 0.0)
        return self.air.along(ray.o, ray.d, length, ray.wavelengths, from_camera, active)

    def to_string(self):
        return f"WelkinPath[max_depth={self.max_depth}, altitude={number(self.altitude)}, metres_per_unit={number(self.metres)}]"


def depth_of(props, name, default, least):
    value = props.get(name, default)
    if not isinstance(value, int) or isinstance(value, bool) or (value < least and value != -1):
        raise ValueError(f"{name} must be a whole number from {least} or -1, got {value!r}")
    return EVERYWHERE if value == -1 else value


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
