"""The air between a camera and what it sees: a volume over its frustum, as two pictures for a compositor.

The pictures hold slices above each other. Slice s of N is at the depth far · (s / (N − 1))²: the first, where the
camera is, takes nothing and adds nothing.
"""

from dataclasses import dataclass, replace

import numpy as np
from welkin_sky import Conditions

from .luminary import Luminary, default_model

COLUMNS, ROWS, SLICES = 48, 72, 48
FARTHEST = 500e3
"""m; the air is prepared for a part of the planet."""
LOWEST_CAMERA = 2.0
"""m; on the ground itself every ray that goes down has ended."""
LAST_PIECE = 0.95
"""Where the last piece of a ray to the ground begins, by which the air is continued."""


@dataclass(frozen=True)
class Frustum:
    """Axis of length 1, right and up as `ColourAerialPerspective.linear_srgb_volume` takes them; far in metres."""

    axis: tuple[float, float, float]
    right: tuple[float, float, float]
    up: tuple[float, float, float]
    far: float

    def depths(self) -> np.ndarray:
        return self.far * (np.arange(1, SLICES) / (SLICES - 1)) ** 2

    def spread(self) -> tuple[np.ndarray, np.ndarray]:
        """Right and up such that the centres of the outermost pixels are on the edges of the picture."""
        return np.asarray(self.right) * COLUMNS / (COLUMNS - 1), np.asarray(self.up) * ROWS / (ROWS - 1)

    def rays(self) -> np.ndarray:
        """Of the pixels of the volume, of depth 1: (rows, columns, 3)."""
        x, y = np.linspace(-1.0, 1.0, COLUMNS), np.linspace(1.0, -1.0, ROWS)
        return self.axis + x[:, None] * np.asarray(self.right) + y[:, None, None] * np.asarray(self.up)


def volume(conditions: Conditions, lights: list[Luminary], frustum: Frustum) -> tuple[np.ndarray, np.ndarray]:
    """In-scattered light (cd m⁻²) and factors of the air, RGBA, lowest row first: (N · rows, columns, 4) each."""
    camera = np.array([0.0, 0.0, max(conditions.altitude, LOWEST_CAMERA)])
    light = np.zeros((ROWS, COLUMNS, SLICES, 3), np.float32)
    factors = np.ones_like(light)
    # Without any light there is still what the air takes.
    dark = replace(conditions, solar_elevation=default_model().solar_elevation_range[0])
    for model, below in [(one.model, one.conditions) for one in lights] or [(default_model(), dark)]:
        added, taken = _slices(model.colour_aerial_perspective(below), camera, frustum)
        if lights:
            light[:, :, 1:] += added
        factors[:, :, 1:] = taken
    return _stacked(light), _stacked(factors)


def _slices(air, camera: np.ndarray, frustum: Frustum) -> tuple[np.ndarray, np.ndarray]:
    depths = frustum.depths()
    right, up = frustum.spread()
    light, factors = air.linear_srgb_volume(camera, frustum.axis, right, up, (COLUMNS, ROWS), depths)
    light, factors = np.array(light), np.array(factors)
    rays = frustum.rays()
    ground = _ground_depths(camera[2], rays)
    hit = ground < frustum.far
    if hit.any():
        _continue(air, camera, rays[hit], ground[hit], depths, hit, light, factors)
    return light, factors


def _ground_depths(altitude: float, rays: np.ndarray) -> np.ndarray:
    """Depth at which rays meet the ground; infinite for those that do not."""
    radius = default_model().planet_radius
    lengths = np.linalg.norm(rays, axis=-1)
    down = -rays[..., 2] / lengths * (radius + altitude)
    inside = down**2 - altitude * (2.0 * radius + altitude)
    meets = (down > 0.0) & (inside >= 0.0)
    # The difference of the root and `down` would lose the digits.
    distance = altitude * (2.0 * radius + altitude) / (down + np.sqrt(np.maximum(inside, 0.0)) + 1e-300)
    return np.where(meets, distance / lengths, np.inf)


def _continue(air, camera, rays, ground, depths, hit, light, factors) -> None:
    """Fills slices beyond the ground as if the air above it went on: between them and those before it, things on the
    ground are interpolated, and terrain of the scene may be lower than the ground of the model."""
    near, last = LAST_PIECE * ground, 0.9999 * ground
    added_near, taken_near = _segments(air, camera, rays, near)
    added, taken = _segments(air, camera, rays, last)
    # Lengths of the last piece from the ground to each slice.
    pieces = ((depths - last[:, None]) / (last - near)[:, None])[..., None]
    beyond = pieces > 0.0
    kept = np.clip(taken / taken_near, 1e-6, 1.0)
    lost = -np.expm1(np.where(beyond, pieces, 0.0) * np.log(kept))
    # Each piece sends as much as the one before, through what that one leaves.
    share = np.divide(lost, 1.0 - kept, out=np.broadcast_to(pieces, lost.shape).copy(), where=kept < 1.0)
    light[hit] = np.where(beyond, added + (added - added_near) * kept * share, light[hit])
    factors[hit] = np.where(beyond, taken * (1.0 - lost), factors[hit])


def _segments(air, camera, rays, depths) -> tuple[np.ndarray, np.ndarray]:
    """Light and factors up to these depths: (N, 1, 3) each."""
    light, factors = air.rgb(camera, camera + rays * depths[:, None])
    return np.asarray(light, np.float64)[:, None], np.maximum(np.asarray(factors, np.float64)[:, None], 1e-30)


def _stacked(values: np.ndarray) -> np.ndarray:
    image = np.ones((SLICES * ROWS, COLUMNS, 4), np.float32)
    # Rows of the volume go down, those of the picture up.
    image[..., :3] = values[::-1].transpose(2, 0, 1, 3).reshape(SLICES * ROWS, COLUMNS, 3)
    return image
