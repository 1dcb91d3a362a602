"""The disc of the sun in a map whose pixels are hardly smaller."""

import numpy as np

from .grid import MapGrid
from .luminary import Luminary, disc_rgb

PARTS = 16
"""Parts of a pixel along each side."""


def add_disc(image: np.ndarray, grid: MapGrid, light: Luminary) -> None:
    """Adds the disc. Pixels get what they hold of it; all together give the irradiance of the disc."""
    if not light.disc.is_visible:
        return
    rows, columns = _near(grid, light)
    # Of a low sun blue is beyond the gamut, and a map has no negative light.
    shares = np.maximum(_means(grid, light, rows, columns), 0.0)
    facing = grid.directions[rows, columns].astype(np.float64) @ light.direction
    given = (shares * (grid.solid_angles[rows] * facing)[:, None]).sum(axis=0)
    wanted = np.maximum(light.irradiance(), 0.0)
    # Of a sliver no part of a pixel may have met anything.
    scale = np.divide(wanted, given, out=np.zeros(3), where=given > 0)
    image[rows, columns, :3] += (shares * scale).astype(np.float32)


def _near(grid: MapGrid, light: Luminary) -> tuple[np.ndarray, np.ndarray]:
    """Pixels that the disc may reach."""
    # Half the diagonal of a pixel more than the radius.
    reach = light.angular_radius + np.pi / grid.rows
    band = np.abs(grid.elevations - np.arcsin(np.clip(light.direction[2], -1, 1))) <= reach
    first = int(np.argmax(band))
    close = grid.directions[band] @ light.direction.astype(np.float32) >= np.cos(reach) - 1e-6
    rows, columns = np.nonzero(close)
    return rows + first, columns


def _means(grid: MapGrid, light: Luminary, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """Mean radiance of the disc over pixels: (N, 3)."""
    step = np.pi / grid.rows
    offsets = step * ((np.arange(PARTS) + 0.5) / PARTS - 0.5)
    elevation = grid.elevations[rows][:, None, None] + offsets[:, None]
    azimuth = grid.azimuths[columns][:, None, None] + offsets
    elevation, azimuth = np.broadcast_arrays(elevation, azimuth)
    level = np.cos(elevation)
    parts = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], -1)
    values = disc_rgb(light.disc, parts.reshape(-1, 3)).reshape(*parts.shape)
    return (values * level[..., None]).sum(axis=(1, 2)) / level.sum(axis=(1, 2))[:, None]
