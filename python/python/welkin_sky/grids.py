"""Grids of directions for images, with the solid angle of each pixel."""

from dataclasses import dataclass
from operator import index
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InvalidValueError


@dataclass(frozen=True, eq=False)
class Grid:
    """Pixels of an image of the sky: `grid.image(sky.radiance_at(grid.visible, 550.0))`.

    Outside of the image, in the corners of a fish-eye, directions are NaN, which skies refuse: ask for `visible`.
    """

    directions: NDArray[np.float32]
    """Unit vectors (rows, columns, 3); NaN outside of the image."""
    solid_angle: NDArray[np.float64]
    """Solid angle of the pixels, sr: (rows, columns); 0 outside of the image."""
    inside: NDArray[np.bool_]
    """Which pixels show anything: (rows, columns)."""

    @property
    def visible(self) -> NDArray[np.float32]:
        """Directions of the pixels inside: (N, 3)."""
        return self.directions[self.inside]

    def image(self, values: ArrayLike, outside: float = np.nan) -> NDArray[Any]:
        """Values (N, …) of `visible` in their places: (rows, columns, …)."""
        values = np.asarray(values)
        image = np.full(self.inside.shape + values.shape[1:], outside, values.dtype)
        image[self.inside] = values
        return image


def fish_eye(size: int) -> Grid:
    """The upper hemisphere as an equidistant fish-eye of (size, size): zenith in the middle, horizon at the rim.

    +x is to the right and +y up, as on a map; who lies on the ground and looks up sees it mirrored.
    Directions in the corners are NaN: ask skies for `grid.visible`, and put the answers in place by `grid.image`.
    """
    size = _require(size, 1)
    step = (2 * np.arange(size) + 1) / size - 1
    x, y = np.meshgrid(step, -step)
    radius = np.hypot(x, y)
    inside = radius <= 1
    zenith_angle = radius * np.pi / 2
    # sin θ / r, which does not divide by zero in the middle.
    across = np.pi / 2 * np.sinc(zenith_angle / np.pi)
    directions = np.stack([across * x, across * y, np.cos(zenith_angle)], axis=-1)
    directions[~inside] = np.nan
    solid_angle = np.where(inside, np.pi / 2 * across * (2 / size) ** 2, 0)
    return Grid(directions.astype(np.float32), solid_angle, inside)


def lat_long(height: int) -> Grid:
    """The whole sphere as an equirectangular map of (height, 2 height).

    The top row is at the zenith, the middle of the columns looks along +x, and columns run clockwise seen from above:
    the environment map that renderers expect.
    """
    height = _require(height, 2)
    edges = np.pi / 2 - np.pi * np.arange(height + 1) / height
    elevation = (edges[:-1] + edges[1:]) / 2
    azimuth = np.pi - np.pi * (np.arange(2 * height) + 0.5) / height
    elevation, azimuth = np.meshgrid(elevation, azimuth, indexing="ij")
    rows = (np.sin(edges[:-1]) - np.sin(edges[1:])) * np.pi / height
    solid_angle = np.repeat(rows[:, None], 2 * height, axis=1)
    inside = np.ones(elevation.shape, dtype=bool)
    return Grid(directions(elevation, azimuth), solid_angle, inside)


def directions(elevation: ArrayLike, azimuth: ArrayLike) -> NDArray[np.float32]:
    """Unit vectors at elevations and azimuths (rad), which are broadcast: (…), (…) → (…, 3)."""
    elevation, azimuth = np.broadcast_arrays(elevation, azimuth)
    level = np.cos(elevation)
    parts = [level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)]
    return np.stack(parts, axis=-1).astype(np.float32)


def _require(size: int, least: int) -> int:
    try:
        size = index(size)
    except TypeError:
        raise TypeError(f"the rows of an image are a whole number, got {size!r}") from None
    if size < least:
        raise InvalidValueError(f"an image has at least {least} rows, got {size}")
    return size
