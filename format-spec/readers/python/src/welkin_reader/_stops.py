"""The stops of rays, between which the estimates are summed up (section 7.2)."""

import numpy as np

from ._transmittance import altitude_on_line

_ALONG_THE_SHADOW = 1e-9
"""Square of the sine of the angle to the sun's axis below which a ray has no stops at rings."""
_REACH = 300e3
"""Metres into the day side of the planet over which stops at rings go to the observer."""


class Rays:
    """Rays (N,) from an observer through the air, and where the sun stands along them."""

    def __init__(self, observer, sun, view):
        self.end = view.ray_length[:, None]
        self._observer = observer
        self._sine = np.sin(view.elevation)[:, None]
        self._along = (observer.planet_radius + observer.altitude) * self._sine
        self._dips = view.is_up[:, None] & (self._along < 0.0)
        self._solar_sine, self._solar_cosine = sun[2], np.hypot(sun[0], sun[1])
        self._cos_to_sun = view.angle.cos
        self._square_across = view.angle.one_minus_cos * view.angle.one_plus_cos

    def altitude(self, distance):
        """Altitudes in m at distances (N, S)."""
        observer = self._observer
        line = observer.planet_radius, observer.altitude, self._sine
        return np.clip(altitude_on_line(*line, distance), 0.0, observer.top_altitude)

    def solar_sine(self, distance, altitude):
        """Sines of the sun's elevation at distances (N, S)."""
        radius = self._observer.planet_radius + altitude
        return np.clip(self._towards_sun(distance) / radius, -1.0, 1.0)

    def stops(self, levels, rings):
        """Distances in m, in their order: (N, S)."""
        start = np.zeros_like(self.end)
        nearest = np.where(self._dips, -self._along, 0.0)
        stops = np.concatenate(
            [start, nearest, self._crossings(levels), self._shadows(rings), self.end], axis=1
        )
        stops = np.sort(stops, axis=1)
        # What a ray does not have is another stop at 0. Where no ray has it, it is left out.
        first = int(np.argmax(np.any(stops > 0.0, axis=0)))
        return stops[:, max(0, first - 1) :]

    def _towards_sun(self, distance):
        """P · s at distances (N, S)."""
        start = (self._observer.planet_radius + self._observer.altitude) * self._solar_sine
        return start + distance * self._cos_to_sun

    def _crossings(self, levels):
        """Distances (N, 2·levels) at which altitudes are crossed, or 0."""
        radius, h = self._observer.planet_radius, self._observer.altitude
        roots = _roots(1.0, self._along, (h - levels) * (2.0 * radius + h + levels))
        return self._within(roots)

    def _shadows(self, rings):
        """Distances (N, 2·rings + 1) at which cylinders around the axis of the shadow are crossed, and at which that is
        nearest; or 0."""
        if len(rings) == 0:
            return np.zeros_like(self.end)
        radius, h = self._observer.planet_radius, self._observer.altitude
        across = (radius + h) * self._solar_cosine
        constant = (across - radius - rings) * (across + radius + rings)
        half = self._along - (radius + h) * self._solar_sine * self._cos_to_sun
        crossing = self._square_across >= _ALONG_THE_SHADOW
        square = np.where(crossing, self._square_across, 1.0)
        places = np.concatenate([_roots(square, half, constant), -half / square], axis=1)
        places = np.minimum(places, self.end)
        share = np.clip(self._towards_sun(places) / _REACH, 0.0, 1.0)
        moved = places * (1.0 - share * share * (3.0 - 2.0 * share))
        return np.where(crossing, self._within(moved), 0.0)

    def _within(self, distance):
        return np.where((distance > 0.0) & (distance < self.end), distance, 0.0)


def _roots(square, half, constant):
    """Roots (N, 2·M) of square·t² + 2·half·t + constant = 0, without cancellation; nan for none."""
    discriminant = half * half - square * constant
    sum_ = half + np.copysign(np.sqrt(np.maximum(0.0, discriminant)), half)
    real = (discriminant >= 0.0) & (sum_ != 0.0)
    near, far = constant / np.where(real, -sum_, 1.0), -sum_ / square
    return np.concatenate([np.where(real, near, np.nan), np.where(real, far, np.nan)], axis=1)
