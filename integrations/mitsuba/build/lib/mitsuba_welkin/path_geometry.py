"""Straight paths over a round planet, for numpy and Dr.Jit (`m`): altitudes and distances in metres, `mu` the cosine from
the zenith at the start. Written so that single precision does."""

import drjit as dr
import numpy as np


def choose(m, condition, yes, no):
    return np.where(condition, yes, no) if m is np else dr.select(condition, yes, no)


def horizon(m, altitude, floor, planet):
    """The cosine from the zenith at which a path touches the floor."""
    height = m.maximum(altitude - floor, 0.0)
    return -m.sqrt(height * (2.0 * planet + altitude + floor)) / (planet + altitude)


def reach(m, altitude, mu, floor, planet, far):
    """How far a path goes: to the floor or `far`."""
    along = -(planet + altitude) * mu
    product = m.maximum(altitude - floor, 0.0) * (2.0 * planet + altitude + floor)
    down = mu < horizon(m, altitude, floor, planet)
    root = m.sqrt(m.maximum(along * along - product, 0.0))
    to_floor = product / m.maximum(along + root, 1.0)
    return m.maximum(m.minimum(choose(m, down, to_floor, far), far), 1.0)


def cosine(m, v, edge):
    """The cosine at −1 to 1, which is dense about the horizon `edge` at 0."""
    return choose(m, v >= 0.0, edge + (1.0 - edge) * v * v, edge - (1.0 + edge) * v * v)


def row(m, mu, edge):
    """The inverse of `cosine`."""
    above = m.sqrt(m.maximum(mu - edge, 0.0) / (1.0 - edge))
    below = m.sqrt(m.maximum(edge - mu, 0.0) / (1.0 + edge))
    return choose(m, mu >= edge, above, -below)


def lobe(angle_cosine):
    """About how in-scattering depends on the angle from the sun: tables hold what is left."""
    g = 0.75
    square = 1.0 + g * g - 2.0 * g * angle_cosine
    return 1.0 + angle_cosine * angle_cosine + 0.3 * (1.0 - g * g) / (square * square**0.5)
