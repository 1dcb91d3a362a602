"""Reference frames of Stokes vectors.

The standard one: Q is vertical less horizontal, U up-right less down-right, as the observer sees them. The sun-aligned
one: Q is light across the plane of sun and line of sight less light in it.
"""

import numpy as np


def standard_axes(lines):
    """Upward and rightward unit vectors of the observer's vertical frame."""
    right = np.cross(lines, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right, axis=-1, keepdims=True)
    return np.cross(right, lines), right


def sun_direction(elevation):
    return np.array([np.cos(elevation), 0.0, np.sin(elevation)])


def aligned_axis(lines, sun_elevation):
    """Unit vectors across the plane of sun and line of sight."""
    across = np.cross(lines, sun_direction(sun_elevation))
    return across / np.linalg.norm(across, axis=-1, keepdims=True)


def aligned(q, u, lines, sun_elevation):
    """Q and U in the sun-aligned frame, from the standard one."""
    upward, right = standard_axes(lines)
    across = aligned_axis(lines, sun_elevation)
    angle = np.arctan2((across * right).sum(-1), (across * upward).sum(-1))
    cos, sin = np.cos(2 * angle), np.sin(2 * angle)
    return q * cos + u * sin, u * cos - q * sin
