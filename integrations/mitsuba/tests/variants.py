"""The variants under test: MITSUBA_VARIANTS=scalar_rgb,… chooses them; those of LLVM need its library (see README.md)."""

import os
import unittest

import mitsuba as mi
import numpy as np

VARIANTS = os.environ.get(
    "MITSUBA_VARIANTS", "scalar_rgb,llvm_ad_rgb,llvm_ad_spectral,llvm_ad_spectral_polarized").split(",")


class InVariants(unittest.TestCase):
    def each(self, kind):
        """Sets each variant whose name has `kind` in it."""
        for variant in VARIANTS:
            if kind in variant:
                mi.set_variant(variant)
                import mitsuba_welkin

                mitsuba_welkin.register()
                yield variant


def emitter(**parameters):
    return mi.load_dict({"type": "welkin", **parameters})


def unit_directions(count, lowest=-1.0, seed=1):
    random = np.random.default_rng(seed)
    z = random.uniform(lowest, 1.0, count)
    azimuth = random.uniform(0.0, 2.0 * np.pi, count)
    flat = np.sqrt(1.0 - z * z)
    return np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), z], 1)


def direction(elevation, azimuth):
    e, a = np.radians([elevation, azimuth])
    return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
