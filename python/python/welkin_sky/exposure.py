"""From luminances to pictures."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InvalidValueError


_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_RANGE = 4.0
"""How many times as bright as they would be without it the tone curve shows dark things."""


def expose(rgb: ArrayLike, white: float | None = None) -> NDArray[np.float64]:
    """Linear sRGB, cd m⁻², as sRGB for a display: (…, 3) → (…, 3), 0 to 1.

    white: luminance that is to be white, cd m⁻²; without, the 99.5th percentile. The tone curve is Reinhard's, of
    luminance alone; colours that a display has not are paler instead of another hue.
    """
    rgb = np.asarray(rgb, dtype=np.float64)
    luminance = rgb @ _LUMINANCE
    if white is None:
        lit = luminance[np.isfinite(luminance) & (luminance > 0)]
        white = float(np.percentile(lit, 99.5)) if lit.size else 1.0
    if not white > 0:
        raise InvalidValueError(f"white must be a luminance above 0 cd m⁻², got {white}")
    share = _RANGE * np.maximum(luminance, 0.0) / white
    factor = _RANGE / white * (1.0 + share / _RANGE**2) / (1.0 + share)
    return _encode(_within_gamut(rgb * factor[..., None]))


def _within_gamut(rgb: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mixes with grey of the same luminance until all components are in 0 to 1."""
    grey = np.clip(rgb @ _LUMINANCE, 0.0, 1.0)[..., None]
    off = rgb - grey
    room = np.where(off > 0, 1.0 - grey, grey)
    share = np.min(room / np.maximum(np.abs(off), room + 1e-30), axis=-1, keepdims=True)
    return np.asarray(np.clip(grey + share * off, 0.0, 1.0))


def _encode(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    """The transfer function of sRGB."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
