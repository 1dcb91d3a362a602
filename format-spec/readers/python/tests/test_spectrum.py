"""Checks what lies between the nodes of files with a spectrum against cases with a closed form.

    python -m unittest discover tests
"""

import struct
import unittest

import numpy as np
from small_file import aerial_file

import welkin_reader

NODES = np.array([400.0, 700.0])
EXTINCTION = np.array([1e-4, 3e-5])
CELLS = np.array([400.0, 500.0, 650.0, 690.0])
SMOOTH = np.array([2e-5, 1e-5, 5e-6, 4e-6])
# Terms of the four cells: 1, 2, 2 and 1.
FIRST_TERMS = np.array([0, 1, 3, 5, 6])
SHARES = np.array([1.0, 0.25, 0.75, 0.5, 0.5, 1.0])
LINES = np.array([0.0, 0.0, 1e-3, 1e-5, 1e-4, 0.0])
# Three taps of the two nodes: one of them is there twice in the second term.
TAP_NODES = np.array([[0, 1, 1], [0, 1, 0], [1, 1, 1], [0, 1, 0], [0, 1, 0], [1, 0, 0]])
TAP_WEIGHTS = np.array(
    [[1, 0, 0], [0.5, -0.25, 0.5], [1, 0, 0.5], [-0.25, 1.25, 0], [2, -1, 0], [2, 0, 0]]
)
NODE_WEIGHTS = np.array([[1, 0], [1, -0.25], [0, 1.5], [-0.25, 1.25], [2, -1], [0, 2]])
PLACE = {"altitude": 100.0, "visibility": 5e4}
SCENE = {"solar_elevation": 0.5, "albedo": 0.1, "solar_azimuth": 0.3, **PLACE}
VIEWS = np.array([[1.0, 0.0, 0.0], [0.6, 0.0, 0.8], [0.0, -0.3, -0.1]])
DISTANCE = 2e4
ASKED = np.array([400.0, 430.0, 500.0, 580.0, 649.0, 680.0, 690.0])


def spectrum_chunk(**changes):
    tables = {
        "counts": np.array([4, 3, 6, 1], "<u4"),
        "cells": CELLS.astype("<f8"),
        "first_terms": FIRST_TERMS.astype("<u4"),
        "shares": SHARES.astype("<f4"),
        "lines": LINES.astype("<f4"),
        "tap_nodes": TAP_NODES.astype("<u4"),
        "tap_weights": TAP_WEIGHTS.astype("<f4"),
        "smooth": SMOOTH.astype("<f4"),
        "example": np.array([-3.0, -4.0], "<f4"),
    }
    return b"".join({**tables, **changes}[name].tobytes() for name in tables)


def open_file(spectrum, features=None):
    return welkin_reader.from_bytes(aerial_file(1, EXTINCTION, 1e-5, spectrum, features))


def between(cells):
    """Values (N, 4) of the cells, linear at the wavelengths asked."""
    return np.stack([np.interp(ASKED, CELLS, row) for row in cells])


def mixed(terms):
    """Sums over the terms of each cell: (N, 6) → (N, 4)."""
    return np.add.reduceat(terms, FIRST_TERMS[:-1], axis=1)


class Spectrum(unittest.TestCase):
    def setUp(self):
        self.model = open_file(spectrum_chunk())

    def test_range(self):
        self.assertEqual(self.model.wavelength_range, (400.0, 690.0))
        self.assertEqual(open_file(None).wavelength_range, (400.0, 700.0))
        for wavelength in (399.9999999, 690.0000001, np.nan):
            with self.assertRaises(welkin_reader.RangeError):
                self.model.transmittance_at(VIEWS, DISTANCE, wavelength, **PLACE)
            with self.assertRaises(welkin_reader.RangeError):
                self.model.in_scattering_at(VIEWS, DISTANCE, wavelength, **SCENE)
            with self.assertRaises(welkin_reader.RangeError):
                self.model.solar_irradiance(wavelength)

    def test_transmittance(self):
        """Terms are mixed in each cell, and their means between cells."""
        column = -np.log(self.model.transmittance(VIEWS, DISTANCE, **PLACE)[:, :1]) / EXTINCTION[0]
        lines = between(mixed(SHARES * np.exp(-column * LINES)))
        expected = np.exp(-column * np.interp(ASKED, CELLS, SMOOTH)) * lines
        got = self.model.transmittance_at(VIEWS, DISTANCE, ASKED, **PLACE)
        self.assertGreater(expected.max() - expected.min(), 0.3)
        np.testing.assert_allclose(got, expected, rtol=1e-6)

    def test_light(self):
        """Nodes make terms, terms cells, and cells what is between them; Q/L and U/L too."""
        light, q, u = np.moveaxis(self.model.in_scattering_stokes(VIEWS, DISTANCE, **SCENE), 1, 0)
        terms = SHARES * np.exp(np.log(light) @ NODE_WEIGHTS.T)
        expected = np.exp(between(np.log(mixed(terms))))
        got = self.model.in_scattering_stokes_at(VIEWS, DISTANCE, ASKED, **SCENE)
        np.testing.assert_allclose(got[:, 0], expected, rtol=1e-6)
        shares = [mixed(terms * (part / light @ NODE_WEIGHTS.T)) for part in (q, u)]
        shares = [between(share / mixed(terms)) for share in shares]
        degree = np.maximum(1.0, np.hypot(*shares))
        self.assertGreater(np.max(np.abs(shares)), 0.1)
        for part, share in zip((got[:, 1], got[:, 2]), shares):
            np.testing.assert_allclose(part, share / degree * expected, rtol=1e-5, atol=1e-12)

    def test_floor(self):
        """A node counts with 2⁻²⁷ of the brightest at least."""
        nodes = np.array([[1.0, 0.0], [1.0, 1e-30]])
        got = self.model._wavelengths.rule.radiance(nodes, np.array([690.0]))
        np.testing.assert_allclose(got, 2.0**-54, rtol=1e-12)

    def test_dark_nodes(self):
        """From a point above the air, away from it, L is 0 everywhere, though a weight is below 0."""
        scene = {**SCENE, "altitude": 2e5}
        light = self.model.in_scattering_at([0.0, 0.0, 1.0], 1e3, ASKED, **scene)
        np.testing.assert_array_equal(light, 0.0)

    def test_many_at_once(self):
        """Many wavelengths give what one after the other does."""
        for ask, scene in (
            (self.model.transmittance_at, PLACE),
            (self.model.in_scattering_at, SCENE),
            (self.model.in_scattering_stokes_at, SCENE),
        ):
            together = ask(VIEWS, DISTANCE, ASKED, **scene)
            alone = [ask(VIEWS, DISTANCE, wavelength, **scene) for wavelength in ASKED]
            np.testing.assert_allclose(together, np.concatenate(alone, axis=-1), rtol=1e-12)

    def test_no_light_from_shares(self):
        """Shares whose sum is a little above 1 do not make a transmittance above 1."""
        shares = SHARES.astype("<f4")
        shares[1:3] = 0.25, 0.750005
        model = open_file(spectrum_chunk(shares=shares))
        self.assertEqual(model.transmittance_at([0.0, 0.0, 1.0], 0.0, 500.0, **PLACE)[0], 1.0)

    def test_without_spectrum(self):
        model = open_file(None)
        with self.assertRaises(welkin_reader.MissingError):
            model.transmittance_at(VIEWS, DISTANCE, 400.0, **PLACE)
        light = model.in_scattering(VIEWS, DISTANCE, **SCENE)
        expected = np.exp(np.log(light) @ [0.5, 0.5])
        got = model.in_scattering_at(VIEWS, DISTANCE, 550.0, **SCENE)[:, 0]
        np.testing.assert_allclose(got, expected, rtol=1e-12)

    def test_feature(self):
        """The bit stands if and only if the chunk is there."""
        for spectrum, features, refusal in (
            (spectrum_chunk(), 0, welkin_reader.InvalidValueError),
            (None, 1, welkin_reader.InvalidValueError),
            (spectrum_chunk(), 4 | 1, welkin_reader.FeatureError),
        ):
            with self.assertRaises(refusal):
                open_file(spectrum, features)

    def test_refused(self):
        """What breaks section 6.9 is refused where it is asked, and only there."""
        late, few, steep = CELLS.copy(), SHARES.astype("<f4"), TAP_WEIGHTS.astype("<f4")
        late[-1], few[2], steep[0, 0] = 700.001, 0.7499, 1000.1
        broken = {
            "cells": spectrum_chunk(cells=late),
            "order": spectrum_chunk(cells=CELLS[::-1].copy()),
            "node": spectrum_chunk(tap_nodes=np.full((6, 3), 2, "<u4")),
            "weight": spectrum_chunk(tap_weights=steep),
            "first": spectrum_chunk(first_terms=np.array([0, 2, 2, 5, 6], "<u4")),
            "shares": spectrum_chunk(shares=few),
            "smooth": spectrum_chunk(smooth=np.full(4, -1e-9, "<f4")),
            "lines": spectrum_chunk(lines=np.full(6, np.nan, "<f4")),
            "example": spectrum_chunk(example=np.array([0.0, 101.0], "<f4")),
            "counts": spectrum_chunk(counts=np.array([4, 3, 6, 2], "<u4")),
            "short": spectrum_chunk()[:-1],
            "long": spectrum_chunk() + struct.pack("<I", 0),
        }
        for name, chunk in broken.items():
            with self.subTest(name):
                model = open_file(chunk)
                self.assertEqual(model.transmittance(VIEWS, DISTANCE, **PLACE).shape, (3, 2))
                with self.assertRaises(welkin_reader.InvalidValueError):
                    model.transmittance_at(VIEWS, DISTANCE, 500.0, **PLACE)
                with self.assertRaises(welkin_reader.InvalidValueError):
                    model.in_scattering_at(VIEWS, DISTANCE, 500.0, **SCENE)


if __name__ == "__main__":
    unittest.main()
