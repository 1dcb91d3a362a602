"""What Stokes vectors say: arrays (…, 3, W) of I, Q, U, as polarised skies give them."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import LengthError


def degree_of_polarisation(stokes: ArrayLike) -> NDArray[np.floating[Any]]:
    """Degree of linear polarisation, 0 to 1, and 0 without light: (…, 3, W) → (…, W)."""
    i, q, u = _parts(stokes)
    lit = i > 0
    return np.where(lit, np.hypot(q, u) / np.where(lit, i, 1), 0)


def angle_of_polarisation(stokes: ArrayLike) -> NDArray[np.floating[Any]]:
    """Angle of polarisation from the axis of the frame to its right, −π/2 to π/2 rad: (…, 3, W) → (…, W)."""
    _, q, u = _parts(stokes)
    return np.asarray(0.5 * np.arctan2(u, q))


def through_polariser(stokes: ArrayLike, angle: float) -> NDArray[np.floating[Any]]:
    """Radiance behind an ideal polariser at an angle (rad) from the axis of the frame to its right."""
    i, q, u = _parts(stokes)
    return np.asarray(0.5 * (i + q * np.cos(2 * angle) + u * np.sin(2 * angle)))


def _parts(stokes: ArrayLike) -> NDArray[np.floating[Any]]:
    stokes = np.asarray(stokes)
    if stokes.ndim < 2 or stokes.shape[-2] != 3:
        raise LengthError(f"stokes must have the shape (…, 3, W), got {stokes.shape}")
    return np.moveaxis(stokes, -2, 0)
