"""Sun and moon as sources of the light of a sky."""

from dataclasses import dataclass, replace
from functools import lru_cache
from math import acos, pi, tan

import numpy as np
import welkin_sky
from welkin_sky import Conditions, Moon

RINGS, SPOKES = 16, 32
"""Rays over a disc; at the horizon, whose edge crosses it, four times as many each way."""


@dataclass(frozen=True)
class Luminary:
    """The sun, or the moon in its place."""

    kind: str
    model: welkin_sky.Model
    conditions: Conditions
    """Of the air, with this luminary as the sun."""
    disc: welkin_sky.SolarDisc

    @property
    def direction(self) -> np.ndarray:
        return np.asarray(self.disc.direction, np.float64)

    @property
    def angular_radius(self) -> float:
        return acos(1.0 - self.disc.solid_angle / (2.0 * pi))

    def sky(self) -> welkin_sky.BakedColourSky:
        """The sky in its light alone, as tables."""
        return _sky(self.model, self.conditions)

    def irradiance(self) -> np.ndarray:
        """Linear sRGB, lx, of a plane that faces it, by what of the disc is above the horizon."""
        return _irradiances(self)[0].copy()

    def level_irradiance(self) -> np.ndarray:
        """The same of a level plane that looks up."""
        return _irradiances(self)[1].copy()


def luminaries(conditions: Conditions, moon: Moon | None) -> list[Luminary]:
    """Those that light the air. One that is below the range of the model gives none.

    Raises `RangeError` for what else is out of range, whether or not anything shines.
    """
    model = default_model()
    lowest = model.solar_elevation_range[0]
    _check(model, conditions, lowest)
    found = []
    if conditions.solar_elevation >= lowest:
        found.append(Luminary("sun", model, conditions, model.solar_disc(conditions)))
    if moon is not None and moon.elevation >= lowest:
        moonlit, of_moon = moonlit_model(moon), moon.conditions(conditions)
        found.append(Luminary("moon", moonlit, of_moon, moonlit.solar_disc(of_moon)))
    return found


@lru_cache(maxsize=1)
def default_model() -> welkin_sky.Model:
    return welkin_sky.default_model()


@lru_cache(maxsize=4)
def moonlit_model(moon: Moon) -> welkin_sky.Model:
    return default_model().moonlit(moon)


def _check(model: welkin_sky.Model, conditions: Conditions, lowest: float) -> None:
    """Refuses what is out of range even if the sun is below it, and so nothing asked."""
    model.colour_sky(replace(conditions, solar_elevation=max(conditions.solar_elevation, lowest)))


@lru_cache(maxsize=8)
def _irradiances(luminary: Luminary) -> tuple[np.ndarray, np.ndarray]:
    """Of a plane that faces it, and of a level one."""
    if not luminary.disc.is_visible:
        return np.zeros(3), np.zeros(3)
    finer = 4 if luminary.direction[2] < 0.02 else 1
    rays, solid_angles = disc_rays(luminary.direction, luminary.angular_radius, finer * RINGS, finer * SPOKES)
    light = solid_angles[:, None] * disc_rgb(luminary.disc, rays)
    return (rays @ luminary.direction) @ light, np.maximum(rays[:, 2], 0.0) @ light


@lru_cache(maxsize=8)
def _sky(model: welkin_sky.Model, conditions: Conditions) -> welkin_sky.BakedColourSky:
    return model.colour_sky(conditions).bake()


def disc_rgb(disc: welkin_sky.SolarDisc, directions: np.ndarray) -> np.ndarray:
    """Linear sRGB radiance of the disc, cd m⁻²."""
    matrix = np.asarray(welkin_sky.colour_space_matrix("srgb"), np.float64)
    return np.asarray(disc.xyz(directions.astype(np.float32)), np.float64) @ matrix.T


def disc_rays(direction: np.ndarray, radius: float, rings: int, spokes: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions over a disc and their solid angles (sr).

    Rings are where Gauss has them over μ = √(1 − r²), in which limb darkening is smooth.
    """
    across = perpendicular(direction)
    up = np.cross(direction, across)
    nodes, weights = np.polynomial.legendre.leggauss(rings)
    mu, weights = (nodes + 1.0) / 2.0, weights / 2.0
    angle = 2.0 * pi * (np.arange(spokes) + 0.5) / spokes
    distance, angle = np.meshgrid(tan(radius) * np.sqrt(1.0 - mu**2), angle, indexing="ij")
    offsets = (distance * np.cos(angle))[..., None] * across + (distance * np.sin(angle))[..., None] * up
    rays = direction + offsets.reshape(-1, 3)
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    whole = 2.0 * pi * (1.0 - np.cos(radius))
    return rays, np.repeat(whole * 2.0 * mu * weights / spokes, spokes)


def perpendicular(direction: np.ndarray) -> np.ndarray:
    """A level unit vector at right angles to a direction."""
    level = np.cross([0.0, 0.0, 1.0], direction)
    length = np.linalg.norm(level)
    return level / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
