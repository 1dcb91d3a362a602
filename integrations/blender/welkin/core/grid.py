"""Directions of the pixels of an equirectangular map, in the order that Blender stores them: the lowest row first."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np


@dataclass(frozen=True, eq=False)
class MapGrid:
    edges: np.ndarray
    """Elevations between the rows, rad: (rows + 1,)."""
    elevations: np.ndarray
    azimuths: np.ndarray
    directions: np.ndarray
    """Unit vectors, float32: (rows, 2 rows, 3)."""

    @property
    def rows(self) -> int:
        return len(self.elevations)

    @property
    def solid_angles(self) -> np.ndarray:
        """Of one pixel of each row, sr: (rows,)."""
        return np.diff(np.sin(self.edges)) * np.pi / self.rows


@lru_cache(maxsize=2)
def map_grid(rows: int) -> MapGrid:
    """Of (rows, 2 rows) pixels. The middle of the columns looks along +x, and azimuths grow to the left."""
    edges = np.linspace(-np.pi / 2, np.pi / 2, rows + 1)
    elevations = (edges[1:] + edges[:-1]) / 2
    azimuths = np.pi - np.pi * (np.arange(2 * rows) + 0.5) / rows
    directions = np.empty((rows, 2 * rows, 3), np.float32)
    level = np.cos(elevations)[:, None]
    directions[..., 0] = level * np.cos(azimuths)
    directions[..., 1] = level * np.sin(azimuths)
    directions[..., 2] = np.sin(elevations)[:, None]
    return MapGrid(edges, elevations, azimuths, directions)
