"""Light that falls on level ground."""

from functools import lru_cache

import numpy as np

from .grid import map_grid
from .luminary import Luminary

ROWS = 128


def direct(luminary: Luminary) -> np.ndarray:
    """By the disc, linear sRGB, lx."""
    return luminary.level_irradiance()


def diffuse(luminary: Luminary) -> np.ndarray:
    """By the sky, linear sRGB, lx."""
    grid, weights = _upper_half()
    return weights @ np.asarray(luminary.sky().rgb(grid), np.float64)


def total(luminary: Luminary) -> np.ndarray:
    return direct(luminary) + diffuse(luminary)


@lru_cache(maxsize=1)
def _upper_half() -> tuple[np.ndarray, np.ndarray]:
    """Directions, and their solid angles times the cosine of incidence."""
    grid = map_grid(ROWS)
    upper = grid.directions[ROWS // 2 :].reshape(-1, 3)
    edges = np.sin(grid.edges[ROWS // 2 :])
    rows = (edges[1:] ** 2 - edges[:-1] ** 2) / 2.0 * np.pi / ROWS
    return np.ascontiguousarray(upper), np.repeat(rows, 2 * ROWS)
