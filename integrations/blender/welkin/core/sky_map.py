"""The equirectangular map of a sky."""

import numpy as np

from .disc_map import add_disc
from .grid import map_grid
from .ground import add_ground
from .luminary import Luminary
from .settings import Settings


def sky_map(settings: Settings, lights: list[Luminary]) -> np.ndarray:
    """Linear sRGB in cd m⁻² and an alpha of 1, float32, lowest row first: (rows, 2 rows, 4)."""
    grid = map_grid(settings.rows)
    image = np.zeros((grid.rows, 2 * grid.rows, 4), np.float32)
    image[..., 3] = 1.0
    # To who stands on the ground there is no air below the horizon.
    first = grid.rows // 2 if settings.conditions.altitude <= 0.0 else 0
    for light in lights:
        image[first:, :, :3] += light.sky().rgb(grid.directions[first:])
        if settings.ground:
            add_ground(image, grid, light)
        if settings.disc_in_map:
            add_disc(image, grid, light)
    return image
