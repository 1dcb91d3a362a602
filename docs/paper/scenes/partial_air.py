"""The integrator `partial_air`: a path tracer whose air has no in-scattering, or neither that nor attenuation."""

import mitsuba as mi
import mitsuba_welkin

mitsuba_welkin.register()
# Of the variant that is set.
from mitsuba_welkin.integrator import WelkinPath  # noqa: E402


class PartialAir(WelkinPath):
    """Parameters: those of `welkin_path`, and `attenuation`: whether the air takes light away."""

    def __init__(self, props):
        super().__init__(props)
        self.attenuates = bool(props.get("attenuation", True))

    def through_air(self, ray, length, from_camera, active):
        scattered, factor = super().through_air(ray, length, from_camera, active)
        return scattered * 0.0, factor if self.attenuates else mi.UnpolarizedSpectrum(1.0)
