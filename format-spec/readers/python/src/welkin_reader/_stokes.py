"""Stokes components in bounds, and between wavelengths (section 7.5)."""

import numpy as np


def bounded_stokes(radiance, q, u):
    """L, Q, U (N, 3, K) with Q and U scaled where they exceed L."""
    polarised = np.hypot(q, u)
    too_much = polarised > radiance
    factor = np.where(too_much, radiance / np.where(too_much, polarised, 1.0), 1.0)
    return np.stack([radiance, q * factor, u * factor], axis=1)


def interpolate_stokes(wavelengths, stokes, wavelength):
    """L, Q, U (N, 3, nw) of the nodes at wavelengths (K,): (N, 3, K)."""
    light, q, u = np.moveaxis(wavelengths.rule.stokes(stokes, wavelength), 1, 0)
    return bounded_stokes(light, q * light, u * light)
