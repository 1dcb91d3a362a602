"""The curved ground under a camera: +z up at the camera, the origin at the ground below it."""

import numpy as np

RADIUS = 6_378_000.0


def on_planet(x, y, height):
    """Points over places that are x and y along the ground (m) from the origin, at heights above the sphere."""
    distance = np.hypot(x, y)
    angle = distance / RADIUS
    # sin(angle) / distance, and 1 - cos without its rounding error.
    scale = np.sinc(angle / np.pi) / RADIUS
    drop = 2.0 * RADIUS * np.sin(0.5 * angle) ** 2
    out = (RADIUS + height) * scale
    return np.stack([x * out, y * out, height * np.cos(angle) - drop], -1)


def height_of(points):
    """Height of points above the sphere, m."""
    points = np.asarray(points, np.float64)
    flat = points[..., 0] ** 2 + points[..., 1] ** 2
    up = points[..., 2] + RADIUS
    # sqrt(flat + up²) − R without cancelling.
    return (flat + points[..., 2] * (points[..., 2] + 2.0 * RADIUS)) / (np.sqrt(flat + up * up) + RADIUS)


def up_at(points):
    """Unit vectors away from the middle of the planet."""
    up = np.asarray(points, np.float64) + [0.0, 0.0, RADIUS]
    return up / np.linalg.norm(up, axis=-1, keepdims=True)
