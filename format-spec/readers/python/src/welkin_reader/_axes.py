"""Splines, and interpolation between nodes (section 7.1)."""

import numpy as np


def cubic_weights(t):
    """Weights of the four coefficients around t in 0..=1: (N,) → (N, 4)."""
    s = 1.0 - t
    w1 = (3.0 * t - 6.0) * t * t + 4.0
    w2 = ((-3.0 * t + 3.0) * t + 3.0) * t + 1.0
    return np.stack([s**3, w1, w2, t**3], axis=-1) / 6.0


def _locate(u, intervals):
    u = np.clip(u, 0.0, intervals)
    i = np.minimum(np.floor(u).astype(np.intp), intervals - 1)
    return i, cubic_weights(u - i)


def _combine(weights, indices, coefficients):
    """Sum over k of weights[:, k] · coefficients[indices[:, k]]."""
    value = weights[:, :1] * coefficients[indices[:, 0]]
    for k in range(1, 4):
        value += weights[:, k : k + 1] * coefficients[indices[:, k]]
    return value


def free_spline(u, coefficients):
    """Free ends: u (N,), coefficients (n + 3, M) → (N, M)."""
    i, weights = _locate(u, len(coefficients) - 3)
    return _combine(weights, i[:, None] + np.arange(4), coefficients)


def mirrored_spline(u, coefficients):
    """Mirrored ends: u (N,), coefficients (n + 1, M) → (N, M)."""
    n = len(coefficients) - 1
    i, weights = _locate(u, n)
    m = np.abs(i[:, None] + np.arange(-1, 3))
    return _combine(weights, np.where(m > n, 2 * n - m, m), coefficients)


def faded_rows(coefficients, fade):
    """Coefficients (n + 1, M) of an azimuth axis, faded towards their mean over the azimuth."""
    if fade == 1.0:
        return coefficients
    rows = coefficients.astype(np.float64)
    ends = 0.5 * (rows[0] + rows[-1])
    mean = (ends + np.sum(rows[1:-1], axis=0)) / (len(rows) - 1)
    return mean + fade * (rows - mean)


def node_weights(nodes, x):
    """Weights of the nodes by the rule *between chunks*: nodes (n,) increase, x (P,) → (P, n).

    They are exactly 0 and 1 where x is a node.
    """
    if len(nodes) <= 2:
        return linear_weights(nodes, x)
    i, t = interval(nodes, x)
    rows, step = np.arange(len(i)), nodes[i + 1] - nodes[i]
    weights = np.zeros((len(i), len(nodes)))
    weights[rows, i] += (2.0 * t - 3.0) * t * t + 1.0
    weights[rows, i + 1] += (3.0 - 2.0 * t) * t * t
    _add_slope(weights, nodes, i, step * t * (1.0 - t) ** 2)
    _add_slope(weights, nodes, i + 1, step * t * t * (t - 1.0))
    return weights


def interval(nodes, x):
    """Index (P,) of the node before each x (P,), and the place 0..=1 up to the next one."""
    x = np.asarray(x, dtype=np.float64)
    i = np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, len(nodes) - 2)
    return i, np.clip((x - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0, 1.0)


def _add_slope(weights, nodes, j, factor):
    """Adds `factor` times the slope at nodes j of the parabola through their neighbours."""
    first = np.clip(j - 1, 0, len(nodes) - 3)
    rows, here = np.arange(len(j)), nodes[j]
    for p in range(3):
        at, o1, o2 = (nodes[first + (p + k) % 3] for k in range(3))
        slope = ((here - o1) + (here - o2)) / ((at - o1) * (at - o2))
        weights[rows, first + p] += factor * slope


def linear_weights(nodes, x):
    """Weights of the two nodes around x, and of the end node beyond the ends: (P,) → (P, n)."""
    if len(nodes) == 1:
        return np.ones((len(x), 1))
    i, t = interval(nodes, x)
    weights = np.zeros((len(i), len(nodes)))
    rows = np.arange(len(i))
    weights[rows, i], weights[rows, i + 1] = 1.0 - t, t
    return weights
