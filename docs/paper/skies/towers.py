"""What a camera over a planet with towers sees, how far away: the scene of figures 11 and 14."""

from dataclasses import dataclass

import numpy as np

RADIUS = 6_378_000.0


@dataclass(frozen=True)
class Tower:
    """A square tower on the ground; metres, ahead of and to the left of the camera."""

    ahead: float
    left: float
    width: float = 4000.0
    height: float = 15_000.0


TOWERS = [
    Tower(30e3, -8e3),
    Tower(45e3, 13e3),
    Tower(70e3, -24e3),
    Tower(90e3, 6e3),
    Tower(130e3, -14e3),
    Tower(170e3, 45e3),
]
GRID = 10_000.0
STRIPE = 1000.0


def seen(directions, altitude):
    """Distance (inf for space) and pattern (0..1) of what rays from `altitude` meet first. x is ahead, y to the left."""
    origin = np.array([0.0, 0.0, RADIUS + altitude])
    distance = _ground(origin, directions)
    with np.errstate(invalid="ignore"):
        points = origin + np.where(np.isinf(distance), 0, distance)[..., None] * directions
    pattern = np.where(np.isinf(distance), 1.0, _grid(points))
    for tower in TOWERS:
        length, height = _tower(tower, origin, directions)
        nearer = length < distance
        distance = np.where(nearer, length, distance)
        pattern = np.where(nearer, np.where(np.floor(height / STRIPE) % 2 < 1, 1.0, 0.55), pattern)
    return distance, pattern


def _ground(origin, directions):
    along = directions @ origin
    within = along**2 - (origin @ origin - RADIUS**2)
    return np.where((along < 0) & (within > 0), -along - np.sqrt(np.maximum(within, 0)), np.inf)


def _grid(points):
    """Dark lines, a twentieth of a cell wide."""
    places = [RADIUS * np.arctan2(points[..., i], points[..., 2]) / GRID for i in (0, 1)]
    return np.where(np.any([place % 1 < 0.05 for place in places], axis=0), 0.55, 1.0)


def _tower(tower, origin, directions):
    """Distance to a tower (inf beside it), and the height there."""
    turn = np.hypot(tower.ahead, tower.left) / RADIUS
    level = np.array([tower.ahead, tower.left, 0.0]) / np.hypot(tower.ahead, tower.left)
    up = np.sin(turn) * level + np.cos(turn) * np.array([0, 0, 1.0])
    ahead = np.array([1.0, 0, 0]) - up * up[0]
    ahead /= np.linalg.norm(ahead)
    frame = np.stack([ahead, np.cross(up, ahead), up])
    start, slope = frame @ (origin - RADIUS * up), directions @ frame.T
    half = tower.width / 2
    with np.errstate(divide="ignore"):
        ends = [(np.array(edge) - start) / slope for edge in ([-half, -half, -half], [half, half, tower.height])]
    enter, leave = np.minimum(*ends).max(-1), np.maximum(*ends).min(-1)
    hit = (enter < leave) & (enter > 0)
    return np.where(hit, enter, np.inf), np.where(hit, start[2] + enter * slope[..., 2], 0)
