"""Checks the integral of scattered light against cases with a closed form.

    python -m unittest discover tests
"""

import struct
import unittest
import zlib

import numpy as np

import welkin_sky
from welkin_sky import _head

RADIUS, TOP = 6.378e6, 1e5
EDGES = np.array([0.0, 1e3, 3e3, 8e3, 16e3, 32e3, TOP])
SOURCE_LEVEL = 0.01


def profile():
    """Bernstein coefficients (2·nl+1, 1) of about exp(−h / 8 km)."""
    middles = 0.5 * (EDGES[1:] + EDGES[:-1])
    altitudes = np.insert(EDGES, np.arange(1, len(EDGES)), middles)
    return np.exp(-altitudes / 8e3)[:, None]


def transmittance_chunk():
    counts = struct.pack("<II", len(EDGES) - 1, 0)
    return counts + EDGES.astype("<f8").tobytes() + profile().astype("<f4").tobytes()


def source_basis_chunk():
    """The same source everywhere: a tensor and a harmonic that give 1 in all directions."""
    head = struct.pack("<8I", 2, 2, 0, 0, 1, 1, 1, 1)
    axes = np.array([0.0, TOP, -1.0, 1.0], "<f8").tobytes()
    moments = [0.5, 0.5, 0.5, 0.0, np.sqrt(4.0 * np.pi)]
    factors = [1.0, 1.0, 1.0, 1.0, *moments, 1.0, 1.0, 0.0, 0.0]
    return head + axes + np.array(factors, "<f4").tobytes()


def source_chunk(phase, scattering):
    head = struct.pack("<6IfI", 1, 2, 1, 1, 1, 1, 2.0, 0)
    parameter = [0.0, 0.0]
    level = [np.log(SOURCE_LEVEL)] * 4 + [0.0] * 4
    numbers = np.array([*parameter, scattering, scattering, *level], "<f4").tobytes()
    return head + struct.pack("<I", phase) + numbers + np.array([0.5], "<f2").tobytes()


def aerial_file(phase, extinction, scattering):
    """A file with kinds 4, 5 and 8; one constituent, one visibility, two wavelengths."""
    chunks = [
        (_head.TRANSMITTANCE, _head.NONE, transmittance_chunk()),
        (_head.SOURCE, 0, source_chunk(phase, scattering)),
        (_head.SOURCE_BASIS, _head.NONE, source_basis_chunk()),
    ]
    arrays = np.array([400, 700, 0, 2e4, 5e4, extinction, extinction, 0, 0, 0, 0], "<f8")
    # Before the extinction stand the wavelengths, two altitudes and the visibility.
    body = arrays.tobytes() + np.array([1.0] * 6 + [400.0, 300.0], "<f8").tobytes()
    body += np.array([1.0, 1.0], "<f4").tobytes() + struct.pack("<I", 0) + b"{}\0\0"
    head_length = 128 + len(body) + 64 * len(chunks)
    directory, data = b"", b""
    for kind, visibility, payload in chunks:
        data += bytes(-(head_length + len(data)) % 64)
        size = len(payload)
        entry = (kind, 0xFFFF, visibility, head_length + len(data), size, size, 0)
        directory += struct.pack("<IHHQQQIIIIffQ", *entry, zlib.crc32(payload), 0, 0, 0.0, 0.0, 0)
        data += payload
    counts = (2, 2, 1, 1, 1, 1, 1, 1, 1, 2)
    floats = (RADIUS, TOP, 3.0, 2.5, -np.pi / 2, np.pi / 2, 0.0, 0.06)
    length = head_length + len(data)
    front = struct.pack("<8sHHIQQ", _head.MAGIC, 1, 0, 0, length, head_length)
    rest = struct.pack("<I10HI8d", len(chunks), *counts, 2, *floats) + body + directory
    crc = zlib.crc32(front + bytes(4) + rest)
    return front + struct.pack("<I", crc) + rest + data


def views():
    elevation = np.radians([90.0, 30.0, 2.0, 0.0, -2.0, -30.0, -90.0])
    return np.stack([np.cos(elevation), 0.0 * elevation, np.sin(elevation)], axis=1)


class AerialPerspective(unittest.TestCase):
    def test_constant_source(self):
        """Where nothing absorbs, a constant source in the dark gives source · (1 − T)."""
        for phase in (1, 2):
            model = welkin_sky.from_bytes(aerial_file(phase, 1e-4, 1e-4))
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
        model = welkin_sky.from_bytes(aerial_file(2, 1e-4, 1e-4))
        place = {"altitude": 4e7, "visibility": 5e4}
        night = {"solar_elevation": -1.5, "albedo": 0.0, **place}
        light = model.in_scattering([[0.0, 0.0, -1.0], [1.0, 0.0, 0.0]], 4e7, **night)
        through = model.transmittance([0.0, 0.0, -1.0], 4e7, **place)
        np.testing.assert_allclose(light[0], SOURCE_LEVEL * (1.0 - through), rtol=0.02)
        np.testing.assert_array_equal(light[1], 0.0)

    def test_sunlight(self):
        """A short segment scatters its depth · phase function · sunlight / 4π."""
        model = welkin_sky.from_bytes(aerial_file(2, 1e-4, 1e-9))
        place = {"altitude": 0.0, "visibility": 5e4}
        light = model.in_scattering([1.0, 0, 0], 1.0, solar_elevation=0.5, albedo=0.0, **place)
        sun = [np.cos(0.5), 0.0, np.sin(0.5)]
        sunlight = model.transmittance(sun, np.inf, **place)
        expected = 1e-9 * (sunlight / (4.0 * np.pi) + SOURCE_LEVEL)
        np.testing.assert_allclose(light, expected, rtol=1e-3)

    def test_polarisation(self):
        """A short segment of molecules: Q and U of sunlight; the source is the same from everywhere."""
        model = welkin_sky.from_bytes(aerial_file(1, 1e-4, 1e-9))
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
        model = welkin_sky.from_bytes(aerial_file(2, 1e-4, 1e-4))
        scene = {"solar_elevation": 0.5, "albedo": 0.0, "altitude": 0.0, "visibility": 5e4}
        with self.assertRaises(welkin_sky.DirectionError):
            model.in_scattering([0.0, 0.0, 0.0], 1.0, **scene)
        for distance in (-1.0, 2e9):
            with self.assertRaises(welkin_sky.PointError):
                model.in_scattering([0.0, 0.0, 1.0], distance, **scene)
        with self.assertRaises(welkin_sky.MissingError):
            model.sky(**scene)


if __name__ == "__main__":
    unittest.main()
