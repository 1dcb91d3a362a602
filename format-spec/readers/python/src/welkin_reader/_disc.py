"""What is seen of the sun's disc above the horizon (section 7.2).

`x` is the height of its centre above the geometric horizon, in radii of the disc.
"""

import numpy as np

_NARROW = 0.01
"""Difference in x below which a panel is taken at its middle."""


def visible_share(x):
    """V: the share of the disc above the horizon."""
    x = np.clip(x, -1.0, 1.0)
    return 0.5 + (x * np.sqrt(1.0 - x * x) + np.arcsin(x)) / np.pi


def visible_height(x):
    """c: the height of what is seen, in radii of the disc."""
    inside = np.clip(x, -0.999, 1.0)
    lift = (1.0 - inside * inside) ** 1.5 / visible_share(inside)
    partial = inside + 2.0 / (3.0 * np.pi) * lift
    return np.where(x >= 1.0, x, np.where(x <= -0.999, 0.0, partial))


def panel_share(a, b, rise):
    """U: the visible share of panels from x = a to x = b that rise by `rise` scale heights."""
    narrow = np.abs(b - a) < _NARROW
    width = np.where(narrow, 1.0, b - a)
    low, high = np.clip(a, -1.0, 1.0), np.clip(b, -1.0, 1.0)
    before, until = (_air_passed((x - a) / width, rise) for x in (low, high))
    share = before * (a >= 1.0) + (until - before) * _mean_share(low, high) + (1.0 - until) * (b >= 1.0)
    return np.where(narrow, visible_share(0.5 * (a + b)), np.clip(share, 0.0, 1.0))


def _mean_share(a, b):
    """m: the mean of V between two x within ±1."""
    narrow = np.abs(b - a) < _NARROW
    mean = (_integral(b) - _integral(a)) / np.where(narrow, 1.0, b - a)
    return np.where(narrow, visible_share(0.5 * (a + b)), mean)


def _integral(x):
    """W: the integral of V."""
    cosine = np.sqrt(1.0 - x * x)
    return 0.5 * x + (cosine - cosine**3 / 3.0 + x * np.arcsin(x)) / np.pi


def _air_passed(t, rise):
    """G: the share of the air of panels that lies before their part t."""
    t = np.clip(t, 0.0, 1.0)
    rate = np.maximum(np.abs(rise), 0.001)
    share = np.expm1(-rate * np.where(rise > 0.0, t, 1.0 - t)) / np.expm1(-rate)
    return np.where(rise > 0.0, share, 1.0 - share)
