"""Lambertian ground below the horizon, in the light of sun and sky, behind the air before it.

The sky has the light of that air already. At the place that is seen the sun stands higher or lower than above the
observer: so its light is taken from a table over solar elevation.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from . import illuminance
from .grid import MapGrid, map_grid
from .luminary import Luminary, default_model

STEP = np.radians(0.5)
"""Between the suns of the table."""


def add_ground(image: np.ndarray, grid: MapGrid, light: Luminary) -> None:
    """Adds the ground to the rows (lowest first) that see it."""
    conditions = light.conditions
    factors, distance_angles = _air(conditions.visibility, max(conditions.altitude, 0.0), grid.rows)
    rows = len(factors)
    if not rows:
        return
    low, radiance = _table(light, float(distance_angles.max()))
    if len(radiance) == 1:
        image[:rows] += _with_alpha(factors * np.exp(radiance[0]))[:, None]
        return
    place = (_local_elevations(grid, light, distance_angles) - low) / STEP
    index = np.clip(place.astype(np.int32), 0, len(radiance) - 2)
    share = np.clip(place - index, 0.0, 1.0).astype(np.float32)
    for channel in range(3):
        table = radiance[:, channel].astype(np.float32)
        logarithm = table[index] + share * (table[index + 1] - table[index])
        image[:rows, :, channel] += factors[:, None, channel] * np.exp(logarithm)


def _with_alpha(rgb: np.ndarray) -> np.ndarray:
    """Colours to be added to pixels whose alpha stays; adding four numbers is faster than three of four."""
    return np.pad(rgb, ((0, 0), (0, 1))).astype(np.float32)


def _local_elevations(grid: MapGrid, light: Luminary, distance_angles: np.ndarray) -> np.ndarray:
    """Elevation of the luminary above the ground that pixels show: (rows, columns)."""
    elevation = light.conditions.solar_elevation
    turn = np.cos(grid.azimuths - light.conditions.solar_azimuth).astype(np.float32)
    away = (np.sin(distance_angles) * np.cos(elevation)).astype(np.float32)[:, None]
    here = (np.cos(distance_angles) * np.sin(elevation)).astype(np.float32)[:, None]
    return np.arcsin(np.clip(away * turn + here, -1.0, 1.0))


def _table(light: Luminary, reach: float) -> tuple[float, np.ndarray]:
    """Its first elevation, and logarithms of the radiance of the ground (suns, 3)."""
    conditions = light.conditions
    if reach == 0.0:
        return conditions.solar_elevation, _ground(light, conditions.solar_elevation)[None]
    low, high = light.model.solar_elevation_range
    first = int(np.floor((conditions.solar_elevation - reach) / STEP))
    last = max(int(np.ceil((conditions.solar_elevation + reach) / STEP)), first + 1)
    suns = [float(np.clip(i * STEP, low, high)) for i in range(first, last + 1)]
    return first * STEP, np.stack([_ground(light, sun) for sun in suns])


def _ground(light: Luminary, elevation: float) -> np.ndarray:
    """Logarithm of the radiance of the ground under a sun, cd m⁻². Azimuths are all the same to level ground."""
    below = replace(light.conditions, altitude=0.0, solar_elevation=elevation, solar_azimuth=0.0)
    return _ground_under(light.kind, light.model, below)


@lru_cache(maxsize=256)
def _ground_under(kind, model, conditions) -> np.ndarray:
    there = Luminary(kind, model, conditions, model.solar_disc(conditions))
    radiance = conditions.albedo / np.pi * illuminance.total(there)
    return np.log(np.maximum(radiance, np.finfo(np.float32).tiny))


@lru_cache(maxsize=4)
def _air(visibility: float, altitude: float, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Of rows that see the ground: factors of the air in linear sRGB (rows, 3), and angles at the planet's centre."""
    radius = default_model().planet_radius
    height = radius + altitude
    elevations = map_grid(rows).elevations
    sine, cosine = np.sin(elevations), np.cos(elevations)
    inside = radius**2 - (height * cosine) ** 2
    seen = (sine < 0.0) & (inside >= 0.0)
    sine, cosine = sine[seen], cosine[seen]
    distance = -height * sine - np.sqrt(inside[seen])
    if altitude == 0.0:
        return np.ones((len(sine), 3), np.float32), np.zeros(len(sine))
    points = np.stack([distance * cosine, np.zeros_like(sine), altitude + distance * sine], -1)
    # Which sun shines does not count for what the air takes.
    air = default_model().colour_aerial_perspective(visibility=visibility)
    _, factors = air.rgb([0.0, 0.0, altitude], points)
    return np.asarray(factors, np.float32), np.arctan2(distance * cosine, height + distance * sine)
