"""Integrals of the profiles along straight lines, and transmittance (section 7.6)."""

import numpy as np


def path_integrals(profiles, planet_radius, altitude, sin_elevation, distance):
    """Integral of each constituent's profile along rays, m: (N, nk).

    The rays start at `altitude` and rise with `sin_elevation`, all arrays (N,) or numbers;
    `distance` may be infinite.
    """
    radius = planet_radius
    start = (radius + altitude) * sin_elevation
    end = start + distance
    lowest = (altitude * (2.0 * radius + altitude) - start**2) / (2.0 * radius)
    edge = _warp(profiles.edge, radius)
    crossings = [np.sqrt(np.maximum(0.0, 2.0 * radius * (w - lowest))) for w in edge]
    # Below the ground the profile is that at the ground.
    buried = np.maximum(0.0, np.minimum(end, crossings[0]) - np.maximum(start, -crossings[0]))
    total = buried[:, None] * profiles.density[0]
    for i in range(len(edge) - 1):
        layer = edge[i], edge[i + 1], profiles.density[2 * i : 2 * i + 3]
        near, far = crossings[i], crossings[i + 1]
        for low, high in ((near, far), (-far, -near)):
            piece = np.maximum(low, start), np.minimum(high, end)
            total += _piece(piece, layer, lowest, radius)
    return total


def _warp(altitude, radius):
    return altitude + altitude**2 / (2.0 * radius)


def _piece(piece, layer, lowest, radius):
    """Contribution (N, nk) of pieces of the lines within one layer; 0 for reversed pieces."""
    bottom, top, density = layer
    low, high = piece
    length = np.maximum(0.0, high - low)
    middle = np.where(length > 0.0, 0.5 * (low + high), 0.0)
    scale = 2.0 * radius * (top - bottom)
    mean = (lowest - bottom) / (top - bottom) + (middle**2 + length**2 / 12.0) / scale
    variance = (middle**2 * length**2 / 3.0 + length**4 / 180.0) / scale**2
    linear = 2.0 * (density[1] - density[0])
    square = density[0] - 2.0 * density[1] + density[2]
    value = density[0] + linear * mean[:, None] + square * (mean**2 + variance)[:, None]
    return np.where(length > 0.0, length, 0.0)[:, None] * value


def altitude_on_line(planet_radius, altitude, sin_elevation, distance):
    """Altitudes (N,) in m at distances along rays that start at `altitude`."""
    twice = altitude * (2.0 * planet_radius + altitude)
    twice = twice + distance * (2.0 * (planet_radius + altitude) * sin_elevation + distance)
    return twice / (np.sqrt(np.maximum(0.0, planet_radius**2 + twice)) + planet_radius)


def profile_at(profiles, planet_radius, altitude):
    """Profiles (N, nk) at altitudes (N,) in m; 0 above the top."""
    w = _warp(altitude, planet_radius)
    edge = _warp(profiles.edge, planet_radius)
    i = np.clip(np.searchsorted(edge, w, side="right") - 1, 0, len(edge) - 2)
    t = np.clip((w - edge[i]) / (edge[i + 1] - edge[i]), 0.0, 1.0)[:, None]
    d0, d1, d2 = (profiles.density[2 * i + k] for k in range(3))
    value = (1.0 - t) ** 2 * d0 + 2.0 * t * (1.0 - t) * d1 + t**2 * d2
    return np.where((altitude > profiles.edge[-1])[:, None], 0.0, value)
