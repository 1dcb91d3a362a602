"""Gradient noise of the plane and the ridged multifractal made of it."""

import numpy as np


_ANGLES = 2.0 * np.pi * np.arange(1024) / 1024
_COSINES, _SINES = np.cos(_ANGLES).astype(np.float32), np.sin(_ANGLES).astype(np.float32)


def _gradient(i, j, seed):
    """Unit vectors at lattice points: a hash of their indices."""
    h = (i * np.uint32(0x9E3779B1)) ^ (j * np.uint32(0x85EBCA77)) ^ np.uint32(seed * 0x27D4EB2F & 0xFFFFFFFF)
    h = (h ^ (h >> np.uint32(15))) * np.uint32(0x2C1B3C6D)
    h = (h ^ (h >> np.uint32(12))) >> np.uint32(22)
    return _COSINES[h], _SINES[h]


def gradient_noise(x, y, seed=0):
    """About −0.7 to 0.7, one feature for each unit of length, twice differentiable."""
    left, low = np.floor(x), np.floor(y)
    s, t = (x - left).astype(np.float32), (y - low).astype(np.float32)
    i, j = (v.astype(np.int32).astype(np.uint32) for v in (left, low))
    fade = lambda t: t * t * t * (t * (6.0 * t - 15.0) + 10.0)
    u, v = fade(s), fade(t)

    def corner(di, dj):
        gx, gy = _gradient(i + np.uint32(di), j + np.uint32(dj), seed)
        return gx * (s - np.float32(di)) + gy * (t - np.float32(dj))

    front = corner(0, 0) * (1.0 - u) + corner(1, 0) * u
    back = corner(0, 1) * (1.0 - u) + corner(1, 1) * u
    return front + v * (back - front)


def fractal(x, y, octaves, seed=0, gain=0.5):
    """Sum of octaves of gradient noise."""
    total, weight = 0.0, 1.0
    for octave in range(octaves):
        total = total + weight * gradient_noise(x * 2.0**octave, y * 2.0**octave, seed + octave)
        weight *= gain
    return total


def ridged(x, y, octaves, seed=0, gain=0.5):
    """Ridged multifractal, 0 to about 1: sharp crests, each octave strong where the one before was."""
    total, weight, share, norm = 0.0, 1.0, 1.0, 0.0
    for octave in range(octaves):
        crest = 1.0 - np.abs(2.0 * gradient_noise(x * 2.03**octave, y * 2.03**octave, seed + 31 * octave))
        crest = np.clip(crest, 0.0, 1.0) ** 2
        total = total + share * weight * crest
        weight = np.clip(2.0 * crest * weight, 0.0, 1.0)
        norm += share
        share *= gain
    return total / norm
