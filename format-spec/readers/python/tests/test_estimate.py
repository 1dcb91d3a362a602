"""Checks fields relative to estimates against cases with a closed form.

    python -m unittest discover tests
"""

import unittest

import numpy as np
from small_file import RADIUS, TOP, Chunk, small_file, transmittance_chunk

import welkin_reader
from welkin_reader import _disc, _head
from welkin_reader._geometry import Observer, sun_vector
from welkin_reader._stops import Rays

EXTINCTION = np.array([1e-5, 2e-6])
ALBEDO = np.array([0.9, 0.6])
COLUMN = 2e4
LIGHT = np.array([0.03, 0.05])
DAY, NIGHT, HIGH = 0.5, -1.5, 2e4
SUNLIGHT, DIFFUSE = 0, 1 << _head.ESTIMATE_SHIFT
RAYLEIGH = _head.PHASE_RAYLEIGH
VIEWS = np.radians([90.0, 30.0, 1.0, 0.0, -1.0, -4.0, -5.0, -30.0, -90.0])
VIEWS = np.stack([np.cos(VIEWS), 0.0 * VIEWS, np.sin(VIEWS)], axis=1)


def padded(values, shape):
    """A table whose last axis is filled up with a number that nobody must read."""
    table = np.full(shape, 1e3)
    table[..., : np.shape(values)[-1]] = values
    return table


def estimate_chunk(**changes):
    """Air of the same density everywhere, the same column to the sun, and the same diffuse light."""
    levels = [0.0, 5e3, TOP]
    tables = {
        "counts": np.array([3, 2, 2, 2, 1, 2], "<u4"),
        "sun": np.array([-0.2, 0.1], "<f4"),
        "level": np.array(levels, "<f4"),
        "ring": np.array([1e4], "<f4"),
        "scatters": np.array([1, 1], "<u4"),
        "albedo": padded(ALBEDO, (2, 1, 8)).astype("<f4"),
        "density": padded([1.0], (2, 8)).astype("<f4"),
        "column": padded([np.log(COLUMN)], (3, 2, 8)).astype("<f4"),
        "light": padded(np.log(LIGHT), (3, 2, 8)).astype("<f4"),
    }
    return b"".join({**tables, **changes}[name].tobytes() for name in tables)


def ones(rows, columns=16):
    """Rows of a padded table of rank 1."""
    table = np.zeros((rows, columns), "<f2")
    table[:, 0] = 1.0
    return table.tobytes()


def directional_chunk(scale):
    weights = np.zeros(16, "<f4")
    weights[0] = scale
    return weights.tobytes() + ones(3 * 4)


def basis_chunk(channels):
    channel = np.zeros((16, 16), "<f2")
    channel[0, : len(channels)] = channels
    return ones(2) + channel.tobytes()


def sky_file(fields, estimate=None, features=_head.HAS_ESTIMATES, polarisation=(0.0,) * 4):
    """All fields are 2 times their estimate; polarisation: Q, U/sin φ, and both of the ground."""
    radiance, polarised = directional_chunk(2.0), directional_chunk(1.0)
    chunks = [
        Chunk(_head.RADIANCE_BASIS, basis_chunk([1.0] * 2 * len(fields)), rank=1),
        Chunk(_head.POLARISATION_BASIS, basis_chunk(np.repeat(polarisation, 2)), rank=1),
        Chunk(_head.ESTIMATE, estimate_chunk() if estimate is None else estimate),
        Chunk(_head.TRANSMITTANCE, transmittance_chunk()),
    ]
    for altitude in (0, 1):
        chunks.append(Chunk(_head.RADIANCE, radiance, 0, altitude, 1))
        chunks.append(Chunk(_head.POLARISATION, polarised, 0, altitude, 1))
    return small_file([chunk for chunk in chunks if chunk.payload], EXTINCTION, features, fields)


def open_sky(fields, altitude=0.0, solar_elevation=DAY, **options):
    model = welkin_reader.from_bytes(sky_file(fields, **options))
    scene = {"solar_elevation": solar_elevation, "solar_azimuth": 0.3, "albedo": 0.2}
    return model.sky(altitude=altitude, visibility=5e4, **scene)


def lengths(altitude):
    """Lengths of the views (N, 1), to the ground or to the top."""
    middle, r = (RADIUS + altitude) * VIEWS[:, 2], RADIUS + altitude
    ground = middle**2 - r**2 + RADIUS**2
    hits = (middle < 0.0) & (ground >= 0.0)
    near = -middle - np.sqrt(np.maximum(ground, 0.0))
    far = -middle + np.sqrt(middle**2 - r**2 + (RADIUS + TOP) ** 2)
    return np.where(hits, near, far)[:, None]


def diffuse_estimate(altitude):
    return ALBEDO * LIGHT * -np.expm1(-EXTINCTION * lengths(altitude))


def sunlit_estimate(altitude):
    sunlight = np.exp(-EXTINCTION * COLUMN) / (4.0 * np.pi)
    lit = ALBEDO * sunlight * -np.expm1(-EXTINCTION * lengths(altitude))
    return lit + 0.001 * diffuse_estimate(altitude)


class Estimates(unittest.TestCase):
    def test_diffuse(self):
        """Light that is the same everywhere is dimmed and scattered in a closed form."""
        for altitude in (0.0, HIGH):
            got = open_sky([DIFFUSE], altitude).relative_radiance(VIEWS)
            np.testing.assert_allclose(got, 2.0 * diffuse_estimate(altitude), rtol=1e-6, atol=1e-12)
        ground = open_sky([DIFFUSE], 0.0).relative_radiance([0.5, 0.0, -0.5])
        np.testing.assert_array_equal(ground, 0.0)

    def test_sunlight(self):
        for altitude in (0.0, HIGH):
            got = open_sky([SUNLIGHT], altitude, np.pi / 2).relative_radiance(VIEWS)
            np.testing.assert_allclose(got, 2.0 * sunlit_estimate(altitude), rtol=1e-6, atol=1e-12)

    def test_night(self):
        """In the shadow of the Earth a thousandth of diffuse light is left."""
        for altitude in (0.0, HIGH):
            got = open_sky([SUNLIGHT], altitude, NIGHT).relative_radiance(VIEWS)
            np.testing.assert_allclose(got, 2e-3 * diffuse_estimate(altitude), rtol=1e-6, atol=1e-12)

    def test_fields(self):
        """Each field has its own estimate, phase function and share of the ground."""
        fields = [SUNLIGHT | RAYLEIGH, DIFFUSE, DIFFUSE | _head.GROUND_BIT]
        sky = open_sky(fields)
        cosine = VIEWS @ sun_vector(DAY, 0.3)
        lit = sunlit_estimate(0.0) * 0.75 * (1.0 + cosine**2)[:, None]
        expected = 2.0 * (lit + diffuse_estimate(0.0) * (1.0 + 0.2))
        above = VIEWS[:, 2] >= 0.0
        np.testing.assert_allclose(sky.relative_radiance(VIEWS)[above], expected[above], rtol=1e-6, atol=1e-12)

    def test_polarisation(self):
        sky = open_sky([SUNLIGHT | RAYLEIGH, DIFFUSE], polarisation=(0.1, 0.2, -0.05, 0.15))
        above = VIEWS[:3]
        elevation, phi = np.arcsin(above[:, 2:]), -0.3
        p1 = np.cos(elevation) * np.sin(DAY) - np.sin(elevation) * np.cos(DAY) * np.cos(phi)
        p2 = np.cos(DAY) * np.sin(phi)
        dipole = 2.0 * 0.75 * sunlit_estimate(0.0)[:3]
        diffuse = diffuse_estimate(0.0)[:3]
        _, q, u = np.moveaxis(sky.stokes(above), 1, 0)
        expected = dipole * (p2**2 - p1**2) + diffuse * (0.1 + 0.2 * -0.05)
        np.testing.assert_allclose(q, expected, rtol=1e-3)
        expected = -2.0 * dipole * p1 * p2 + diffuse * np.sin(phi) * (0.2 + 0.2 * 0.15)
        np.testing.assert_allclose(u, expected, rtol=1e-3)

    def test_many_at_once(self):
        """Many directions give what one after the other does, though rays have unlike stops."""
        for altitude in (0.0, HIGH):
            sky = open_sky([SUNLIGHT, DIFFUSE], altitude, -0.05)
            alone = [sky.relative_radiance(view) for view in VIEWS]
            np.testing.assert_allclose(sky.relative_radiance(VIEWS), alone, rtol=1e-12)
            self.assertEqual(sky.relative_radiance(np.empty((0, 3))).shape, (0, 2))

    def test_limits(self):
        """As few as possible: one estimate, no rings, two levels."""
        chunk = estimate_chunk(
            counts=np.array([2, 2, 2, 2, 0, 1], "<u4"),
            level=np.array([0.0, TOP], "<f4"),
            ring=np.empty(0, "<f4"),
            scatters=np.array([1], "<u4"),
            albedo=padded(ALBEDO, (1, 1, 8)).astype("<f4"),
            column=padded([0.0], (2, 2, 8)).astype("<f4"),
            light=padded(np.log(LIGHT), (2, 2, 8)).astype("<f4"),
        )
        got = open_sky([0], estimate=chunk).relative_radiance(VIEWS)
        np.testing.assert_allclose(got, 2.0 * diffuse_estimate(0.0), rtol=1e-6, atol=1e-12)

    def test_absorbers(self):
        """What does not scatter in an estimate of sunlight leaves diffuse light alone."""
        chunk = estimate_chunk(scatters=np.array([0, 1], "<u4"))
        got = open_sky([SUNLIGHT], estimate=chunk).relative_radiance(VIEWS)
        np.testing.assert_allclose(got, 2e-3 * diffuse_estimate(0.0), rtol=1e-6, atol=1e-12)

    def test_feature(self):
        """The bit stands if and only if the chunk is there."""
        for estimate, features in ((None, 0), (b"", _head.HAS_ESTIMATES)):
            with self.assertRaises(welkin_reader.InvalidValueError):
                welkin_reader.from_bytes(sky_file([0], estimate, features))
        with self.assertRaises(welkin_reader.FeatureError):
            welkin_reader.from_bytes(sky_file([0], features=2 | 4))

    def test_field_codes(self):
        for code in (1 << 17, 1 << 23, 4 << _head.ESTIMATE_SHIFT, 255 << _head.ESTIMATE_SHIFT):
            with self.assertRaises(welkin_reader.InvalidValueError):
                welkin_reader.from_bytes(sky_file([code]))
        # Only the chunk tells that there is no third one.
        with self.assertRaises(welkin_reader.InvalidValueError):
            open_sky([2 << _head.ESTIMATE_SHIFT])
        with self.assertRaises(welkin_reader.InvalidValueError):
            welkin_reader.from_bytes(small_file([], EXTINCTION, fields=[1 << _head.ESTIMATE_SHIFT]))

    def test_refused(self):
        """What breaks section 6.10 is refused where the sky is asked, and only there."""
        broken = {
            "counts": np.array([3, 2, 2, 2, 1, 2**32 - 1], "<u4"),
            "sun": np.array([0.01, 0.1], "<f4"),
            "level": np.array([0.0, TOP, TOP], "<f4"),
            "ring": np.array([1.001 * TOP], "<f4"),
            "scatters": np.array([1, 3], "<u4"),
            "albedo": padded([1.01, 0.5], (2, 1, 8)).astype("<f4"),
            "density": padded([-1e-9], (2, 8)).astype("<f4"),
            "column": padded([81.0], (3, 2, 8)).astype("<f4"),
            "light": padded([np.nan, 0.0], (3, 2, 8)).astype("<f4"),
        }
        chunks = {name: estimate_chunk(**{name: table}) for name, table in broken.items()}
        chunks["padding"] = estimate_chunk(density=np.array([[1.0] * 7 + [np.inf]] * 2, "<f4"))
        chunks["short"], chunks["long"] = estimate_chunk()[:-4], estimate_chunk() + bytes(4)
        for name, chunk in chunks.items():
            with self.subTest(name):
                model = welkin_reader.from_bytes(sky_file([DIFFUSE], chunk))
                place = {"altitude": 0.0, "visibility": 5e4}
                self.assertEqual(model.transmittance(VIEWS, 1e3, **place).shape, (len(VIEWS), 2))
                with self.assertRaises(welkin_reader.InvalidValueError):
                    model.sky(solar_elevation=DAY, albedo=0.2, **place)


class Disc(unittest.TestCase):
    def test_mean(self):
        """Over a panel without a rise the share is the mean of V, up and down."""
        for a, b in ((-2.0, 3.0), (0.3, -0.8), (5.0, 0.5), (0.2, 0.2), (-3.0, -1.5), (1.5, 9.0)):
            x = a + (b - a) * (np.arange(100000) + 0.5) / 100000
            expected = _disc.visible_share(x).mean()
            share = _disc.panel_share(np.array([a]), np.array([b]), np.array([0.0]))
            np.testing.assert_allclose(share, expected, atol=5e-4)

    def test_shadow(self):
        """Of a long panel the share of the air counts that lies beyond the shadow's edge."""
        for rise in (3.0, -3.0):
            a, b = (-300.0, 700.0) if rise > 0.0 else (700.0, -300.0)
            beyond = (np.exp(-0.9) - np.exp(-3.0)) / (1.0 - np.exp(-3.0))
            share = _disc.panel_share(np.array([a]), np.array([b]), np.array([rise]))
            np.testing.assert_allclose(share, beyond, atol=5e-3)

    def test_height(self):
        """The height is that of the centroid, of which a full disc has its centre."""
        np.testing.assert_allclose(_disc.visible_height(np.array([0.0, 1.0, 7.0])), [4.0 / (3.0 * np.pi), 1.0, 7.0])
        np.testing.assert_array_equal(_disc.visible_height(np.array([-0.9995, -50.0])), 0.0)


class View:
    """What `Rays` asks of a view: elevations (N,) in the azimuth of the sun."""

    def __init__(self, observer, elevation, sun):
        units = np.stack([np.cos(elevation), 0.0 * elevation, np.sin(elevation)], axis=1)
        self.elevation = elevation
        self.is_up = elevation >= -observer.dip
        self.ray_length = observer.ray_length(elevation, self.is_up)
        self.angle = welkin_reader.sky.Angle(units, sun)


class Stops(unittest.TestCase):
    def test_stops(self):
        """A ray that dips crosses a level twice, and behind the planet a ring."""
        observer, sun = Observer(RADIUS, TOP, HIGH), sun_vector(-0.1, 0.0)
        rays = Rays(observer, sun, View(observer, np.array([-0.05, 0.1]), sun))
        level, ring = 1.5e4, 1e4
        stops = rays.stops(np.array([level, TOP]), np.array([ring]))
        dips, rises = (np.unique(row) for row in stops)
        lowest = -(RADIUS + HIGH) * np.sin(-0.05)
        crossings = rays.altitude(dips[None])[0]
        self.assertIn(0.0, dips)
        self.assertTrue(np.any(np.abs(dips - lowest) < 1e-3))
        self.assertEqual(np.sum(np.abs(crossings - level) < 1e-3), 2)
        self.assertEqual((dips[-1], rises[-1]), tuple(rays.end[:, 0]))
        start = np.array([0.0, 0.0, RADIUS + HIGH])
        for row, elevation in ((dips, -0.05), (rises, 0.1)):
            points = start + row[:, None] * [np.cos(elevation), 0.0, np.sin(elevation)]
            towards = points @ sun
            across = np.sqrt(np.sum(points**2, axis=1) - towards**2) - RADIUS
            on_ring = np.abs(across - ring) < 1e-3
            self.assertTrue(np.all(towards[on_ring] < 0.0))
            self.assertEqual(on_ring.sum(), 1)


if __name__ == "__main__":
    unittest.main()
