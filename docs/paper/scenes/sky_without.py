"""The emitters `ground_level_sky` and `unpolarised_sky`: what models of less can do."""

import drjit as dr
import mitsuba as mi
import mitsuba_welkin

Sky = mitsuba_welkin.register()


class GroundLevelSky(Sky):
    """A sky that is known above the horizon of an observer on the ground: below, the horizon goes on."""

    def emission(self, d, wavelengths, active, bodies=None):
        local = self.to_local(d)
        flat = dr.norm(mi.Vector2f(local.x, local.y))
        least = 0.002 * dr.maximum(flat, 1e-6)
        local = dr.normalize(mi.Vector3f(local.x, local.y, dr.maximum(local.z, least)))
        return super().emission(self.to_world @ local, wavelengths, active, bodies)


class UnpolarisedSky(Sky):
    """The same radiance, of which nothing is polarised."""

    def emission(self, d, wavelengths, active, bodies=None):
        return mi.depolarizer(mi.unpolarized_spectrum(super().emission(d, wavelengths, active, bodies)))
