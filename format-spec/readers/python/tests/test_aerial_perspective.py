"""Checks the integral of scattered light against cases with a closed form.

    python -m unittest discover tests
"""

import unittest

import numpy as np
from small_file import SOURCE_LEVEL, aerial_file

import welkin_reader


def views():
    elevation = np.radians([90.0, 30.0, 2.0, 0.0, -2.0, -30.0, -90.0])
    return np.stack([np.cos(elevation), 0.0 * elevation, np.sin(elevation)], axis=1)


class AerialPerspective(unittest.TestCase):
    def test_constant_source(self):
        """Where nothing absorbs, a constant source in the dark gives source · (1 − T)."""
        for phase in (1, 2):
            model = welkin_reader.from_bytes(aerial_file(phase, 1e-4, 1e-4))
            for altitude in (0.0, 1e3, 2e4):
                place = {"altitude": altitude, "visibility": 5e4}
                for distance in (100.0, 1e4, 3e5):
                    with self.subTest(phase=phase, altitude=altitude, distance=distance):
                        night = {"solar_elevation": -1.5, "albedo": 0.0, **place}
                        light = model.in_scattering(views(), distance, **night)
                        through = model.transmittance(views(), distance, **place)
                        expected = SOURCE_LEVEL * (1.0 - through)
                        np.testing.assert_allclose(light, expected, rtol=0.02)

    def test_from_above(self):
        """An observer above the air sees all of it, and from aside nothing."""
        model = welkin_reader.from_bytes(aerial_file(2, 1e-4, 1e-4))
        place = {"altitude": 4e7, "visibility": 5e4}
        night = {"solar_elevation": -1.5, "albedo": 0.0, **place}
        light = model.in_scattering([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]], 4e7, **night)
        through = model.transmittance([0.0, 0.0, -1.0], 4e7, **place)
        np.testing.assert_allclose(light[0], SOURCE_LEVEL * (1.0 - through), rtol=0.02)
        np.testing.assert_array_equal(light[1], 0.0)

    def test_sunlight(self):
        """A short segment scatters its depth · phase function · sunlight / 4π."""
        model = welkin_reader.from_bytes(aerial_file(2, 1e-4, 1e-9))
        place = {"altitude": 0.0, "visibility": 5e4}
        light = model.in_scattering([1.0, 0, 0], 1.0, solar_elevation=0.5, albedo=0.0, **place)
        sun = [np.cos(0.5), 0.0, np.sin(0.5)]
        sunlight = model.transmittance(sun, np.inf, **place)
        expected = 1e-9 * (sunlight / (4.0 * np.pi) + SOURCE_LEVEL)
        np.testing.assert_allclose(light, expected, rtol=1e-3)

    def test_polarisation(self):
        """A short segment of molecules: Q and U of sunlight; the source is the same from everywhere."""
        model = welkin_reader.from_bytes(aerial_file(1, 1e-4, 1e-9))
        place = {"altitude": 0.0, "visibility": 5e4}
        scene = {"solar_elevation": 0.5, "albedo": 0.0, "solar_azimuth": 0.3, **place}
        sun = [np.cos(0.5) * np.cos(0.3), np.cos(0.5) * np.sin(0.3), np.sin(0.5)]
        sunlight = model.transmittance(sun, np.inf, **place)
        # Along the level +x the axes are up and −y: at the zenith up is away from the sun, right is right of it.
        level, zenith = [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]
        right = {"level": (sun[2], -sun[1]), "zenith": (-np.cos(0.5), 0.0)}
        for name, view in (("level", level), ("zenith", zenith)):
            p1, p2 = right[name]
            light, q, u = model.in_scattering_stokes(view, 1.0, **scene)
            dipole = 1e-9 * 0.75 * sunlight / (4.0 * np.pi)
            np.testing.assert_allclose(q, dipole * (p2**2 - p1**2), rtol=1e-3)
            np.testing.assert_allclose(u, -2.0 * dipole * p1 * p2, rtol=1e-3, atol=1e-18)
            np.testing.assert_array_equal(light, model.in_scattering(view, 1.0, **scene))

    def test_conditions(self):
        model = welkin_reader.from_bytes(aerial_file(2, 1e-4, 1e-4))
        scene = {"solar_elevation": 0.5, "albedo": 0.0, "altitude": 0.0, "visibility": 5e4}
        with self.assertRaises(welkin_reader.DirectionError):
            model.in_scattering([0.0, 0.0, 0.0], 1.0, **scene)
        for distance in (-1.0, 2e9):
            with self.assertRaises(welkin_reader.PointError):
                model.in_scattering([0.0, 0.0, 1.0], distance, **scene)
        with self.assertRaises(welkin_reader.MissingError):
            model.sky(**scene)


if __name__ == "__main__":
    unittest.main()
