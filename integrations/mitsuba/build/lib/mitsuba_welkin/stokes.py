"""From welkin's Stokes vectors to Mitsuba's spectra."""

import drjit as dr
import mitsuba as mi


def to_spectrum(parts, d, to_world, azimuth, active):
    """The spectrum of light that comes from direction `d` (local frame): with polarisation, its first column is the
    Stokes vector. `parts`: I, or I, Q, U in the vertical frame; `azimuth`: (cos, sin) of what counts as up at the zenith."""
    zero = mi.UnpolarizedSpectrum(0.0)
    if not mi.is_polarized:
        return dr.select(active, parts[0], zero) if dr.is_jit_v(mi.Float) else (parts[0] if active else zero)
    light, q, u = parts
    forward = -dr.normalize(to_world @ d)
    axis = dr.normalize(to_world @ vertical_axis(d, azimuth))
    turn = mi.mueller.rotate_stokes_basis(forward, axis, mi.mueller.stokes_basis(forward))
    # Mitsuba counts angles about the direction in which light travels, welkin as it is seen: U has the other sign.
    q, u = turn[1, 1] * q - turn[1, 2] * u, turn[2, 1] * q - turn[2, 2] * u
    spectrum = mi.Spectrum(0.0)
    for row, part in enumerate((light, q, u)):
        spectrum[row, 0] = dr.select(active, part, zero)
    return spectrum


def vertical_axis(d, azimuth):
    """welkin's first axis: up in the vertical plane through `d`."""
    flat = dr.sqrt(dr.fma(d.x, d.x, d.y * d.y))
    shrink = 1.0 / dr.maximum(flat, 1e-20)
    c, s = azimuth
    cos_a = dr.select(flat > 0.0, d.x * shrink, c)
    sin_a = dr.select(flat > 0.0, d.y * shrink, s)
    return mi.Vector3f(-d.z * cos_a, -d.z * sin_a, flat)
