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


def node_weights(nodes, x):
    """Weights (n,) of the nodes at x by the rule *between chunks*. Nodes increase; x is within."""
    weights = np.zeros(len(nodes))
    at = int(np.searchsorted(nodes, x))
    if at < len(nodes) and nodes[at] == x or len(nodes) == 1:
        weights[min(at, len(nodes) - 1)] = 1.0
        return weights
    if len(nodes) == 2:
        return linear_weights(nodes, x)
    i = min(max(at - 1, 0), len(nodes) - 2)
    step = nodes[i + 1] - nodes[i]
    t = (x - nodes[i]) / step
    weights[i] += (2.0 * t - 3.0) * t * t + 1.0
    weights[i + 1] += (3.0 - 2.0 * t) * t * t
    _add_slope(weights, nodes, i, step * t * (1.0 - t) ** 2)
    _add_slope(weights, nodes, i + 1, step * t * t * (t - 1.0))
    return weights


def _add_slope(weights, nodes, j, factor):
    """Adds `factor` times the slope at node j of the parabola through it and its neighbours."""
    first = min(max(j - 1, 0), len(nodes) - 3)
    triple = range(first, first + 3)
    for p in triple:
        o1, o2 = (nodes[o] for o in triple if o != p)
        slope = ((nodes[j] - o1) + (nodes[j] - o2)) / ((nodes[p] - o1) * (nodes[p] - o2))
        weights[p] += factor * slope


def linear_weights(nodes, x):
    """Weights (n,) of the two nodes around x; of the end node beyond the ends."""
    weights = np.zeros(len(nodes))
    at = int(np.searchsorted(nodes, x))
    if at == 0 or at == len(nodes):
        weights[min(at, len(nodes) - 1)] = 1.0
        return weights
    share = (x - nodes[at - 1]) / (nodes[at] - nodes[at - 1])
    weights[at - 1], weights[at] = 1.0 - share, share
    return weights
