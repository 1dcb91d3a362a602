"""Directions, horizon and lengths of rays (sections 7.1 and 7.2). All in f64."""

from dataclasses import dataclass

import numpy as np

from .errors import DirectionError

SOLAR_RADIUS = 0.004654793
"""Angular radius of the sun's disc, rad."""


def unit_vectors(directions):
    """Normalises directions (…, 3) of any length: (N, 3). Raises DirectionError."""
    directions = np.asarray(directions, dtype=np.float64)
    if directions.ndim == 0 or directions.shape[-1] != 3:
        raise DirectionError("directions must have the shape (…, 3)")
    directions = directions.reshape(-1, 3)
    largest = np.max(np.abs(directions), axis=-1, keepdims=True)
    # Also catches NaN.
    if not np.all((largest > 0.0) & np.isfinite(largest)):
        raise DirectionError("a direction is zero or not finite")
    scaled = directions / largest
    return scaled / np.linalg.norm(scaled, axis=-1, keepdims=True)


def sun_vector(elevation, azimuth):
    """Unit vector (3,) towards the sun."""
    horizontal = np.cos(elevation)
    return np.array(
        [horizontal * np.cos(azimuth), horizontal * np.sin(azimuth), np.sin(elevation)]
    )


def azimuthal_fade(sine):
    """What the azimuth counts where the sine of the sun's zenith angle is `sine` (7.1)."""
    t = np.minimum(1.0, 20.0 * sine)
    return t * (3.0 - t * t) / 2.0


def azimuth_from_sun(units, azimuth):
    """Signed azimuth of units (N, 3) less that of the sun, −π..=π; 0 at zenith and nadir."""
    x, y = units[:, 0], units[:, 1]
    along = x * np.cos(azimuth) + y * np.sin(azimuth)
    across = y * np.cos(azimuth) - x * np.sin(azimuth)
    return np.where((x == 0.0) & (y == 0.0), 0.0, np.arctan2(across, along))


def elevation_of(units):
    return np.arctan2(units[:, 2], np.hypot(units[:, 0], units[:, 1]))


def sun_across(elevation, solar_elevation, phi):
    """Components of the sun's direction along e1 and e2 of the vertical frame of views (7.5)."""
    p1 = np.cos(elevation) * np.sin(solar_elevation)
    p1 = p1 - np.sin(elevation) * np.cos(solar_elevation) * np.cos(phi)
    return p1, np.cos(solar_elevation) * np.sin(phi)


def horizon_dip(planet_radius, altitude):
    """Angle of the geometric horizon below the horizontal, rad."""
    return np.arctan(np.sqrt(altitude * (2.0 * planet_radius + altitude)) / planet_radius)


@dataclass(frozen=True)
class Observer:
    """An observer above a planet. Lengths in metres."""

    planet_radius: float
    top_altitude: float
    altitude: float

    @property
    def dip(self):
        """Angle of the geometric horizon below the horizontal, rad."""
        return horizon_dip(self.planet_radius, self.altitude)

    def ray_length(self, elevation, is_up):
        """Distance (N,) to the top of the atmosphere, or to the ground where `is_up` is false."""
        h, radius = self.altitude, self.planet_radius
        along = (radius + h) * np.sin(elevation)
        to_top = (self.top_altitude - h) * (2.0 * radius + self.top_altitude + h)
        to_ground = h * (2.0 * radius + h)
        far = np.sqrt(along**2 + to_top)
        up = np.where(along > 0.0, to_top / (np.abs(along) + far), far - along)
        near = np.sqrt(np.maximum(0.0, along**2 - to_ground))
        down_divisor = np.where(is_up, 1.0, near - along)
        return np.where(is_up, up, to_ground / down_divisor)
