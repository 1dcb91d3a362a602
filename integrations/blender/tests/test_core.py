"""The part without Blender, next to what the command says."""

import json
import os
import subprocess
import sys
import unittest
from math import degrees, radians
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from welkin.core import air, almanac, exposure, illuminance, units
from welkin.core.errors import InputError, explain
from welkin.core.grid import map_grid
from welkin.core.luminary import default_model, luminaries
from welkin.core.settings import Settings
from welkin.core.sky_map import sky_map
from welkin_sky import Conditions, Moon, RangeError


def light(*options):
    call = [os.environ["WELKIN"], "light", "--json", *options]
    return json.loads(subprocess.run(call, check=True, capture_output=True, text=True).stdout)


def of(elevation, **more):
    conditions = Conditions(solar_elevation=radians(elevation), **more)
    return luminaries(conditions, None)[0]


class Almanac(unittest.TestCase):
    def test_next_to_the_command(self):
        """The command has the algorithm of Reda and Andreas, good to 0.0003°."""
        worst = 0.0
        for date, hour, offset, latitude, longitude in (
            ("2026-06-21", 12.5, 2.0, 48.1, 11.6),
            ("2026-03-20", 7.0, 1.0, 48.1, 11.6),
            ("1950-11-02", 16.25, -7.0, 39.7, -105.2),
            ("2003-10-17", 12.5, -7.0, 39.742476, -105.1786),
            ("2060-01-05", 9.75, 10.0, -33.9, 151.2),
            ("2090-08-13", 15.0, 0.0, 5.0, -0.5),
            ("2026-12-21", 12.0, 9.0, 35.7, 139.7),
        ):
            year, month, day = map(int, date.split("-"))
            seconds = almanac.instant(year, month, day, hour, offset)
            elevation, azimuth = almanac.sun(seconds, radians(latitude), radians(longitude))
            sign = "-" if offset < 0 else "+"
            wanted = light(
                f"--date={date}", f"--time={int(hour):02}:{round(hour % 1 * 60):02}{sign}{int(abs(offset)):02}:00",
                f"--latitude={latitude}", f"--longitude={longitude}",
            )["conditions"]
            place = radians(wanted["solar_elevation_deg"]), radians(wanted["solar_azimuth_deg"])
            apart = angle(elevation, azimuth, *place)
            worst = max(worst, degrees(apart))
        print(f"position of the sun: at most {worst:.4f} degrees from the command's")
        self.assertLess(worst, 0.02)

    def test_hours_go_over_midnight(self):
        self.assertEqual(almanac.instant(2026, 1, 1, 25.0, 0.0), almanac.instant(2026, 1, 2, 1.0, 0.0))
        self.assertEqual(almanac.instant(2026, 1, 1, 0.0, 2.0), almanac.instant(2025, 12, 31, 22.0, 0.0))

    def test_no_such_day(self):
        for day in ((2025, 2, 29), (2026, 4, 31), (1899, 1, 1)):
            with self.subTest(day=day), self.assertRaises(InputError):
                almanac.instant(*day, 12.0, 0.0)


def angle(elevation, azimuth, other_elevation, other_azimuth):
    def vector(e, a):
        return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])

    return np.linalg.norm(vector(elevation, azimuth) - vector(other_elevation, other_azimuth))


class Light(unittest.TestCase):
    def test_sun_and_sky_next_to_the_command(self):
        worst = {"direct_normal": 0.0, "direct_horizontal": 0.0, "diffuse_horizontal": 0.0}
        for elevation, altitude in ((60, 0), (30, 0), (10, 3000), (2, 0), (0.1, 0), (-0.2, 0), (-0.5, 2000), (-4, 0)):
            wanted = light(f"--sun-elevation={elevation}", f"--altitude={altitude}")
            sun = of(elevation, altitude=altitude)
            for name, got in (
                ("direct_normal", sun.irradiance()),
                ("direct_horizontal", sun.level_irradiance()),
                ("diffuse_horizontal", illuminance.diffuse(sun)),
            ):
                linear = np.array(wanted[name]["linear_srgb"])
                scale = max(abs(linear).max(), 1e-3)
                worst[name] = max(worst[name], abs(got - linear).max() / scale)
        print("irradiance: at most " + ", ".join(f"{name} {value:.1e}" for name, value in worst.items()))
        self.assertLess(worst["direct_normal"], 5e-4)
        self.assertLess(worst["direct_horizontal"], 5e-4)
        self.assertLess(worst["diffuse_horizontal"], 2e-3)

    def test_disc_in_the_map_gives_the_irradiance(self):
        for elevation in (-0.1, 0.2, 5.0, 45.0, 89.9):
            for rows in (128, 512):
                with self.subTest(elevation=elevation, rows=rows):
                    sun, grid = of(elevation), map_grid(rows)
                    settings = Settings(sun.conditions, rows=rows)
                    without = sky_map(settings, [sun])
                    having = sky_map(Settings(sun.conditions, disc_in_map=True, rows=rows), [sun])
                    disc = (having.astype(np.float64) - without)[..., :3]
                    weights = grid.solid_angles[:, None] * (grid.directions @ sun.direction)
                    given = (disc * weights[..., None]).sum(axis=(0, 1))
                    wanted = np.maximum(sun.irradiance(), 0.0)
                    np.testing.assert_allclose(given, wanted, rtol=2e-4, atol=1e-3)
                    self.assertGreaterEqual(having.min(), 0.0)
                    self.assertGreater(np.abs(disc).max(), 0.0)

    def test_moon_and_sun(self):
        """The library takes the discs of both to be as large."""
        moon = Moon(0.6, 1.0, 0.1)
        both = luminaries(Conditions(solar_elevation=-0.05), moon)
        self.assertEqual([one.kind for one in both], ["sun", "moon"])
        self.assertAlmostEqual(degrees(2.0 * both[1].angular_radius), 0.5334, places=4)

    def test_what_is_too_low_gives_nothing(self):
        dark = Conditions(solar_elevation=radians(-30.0))
        self.assertEqual(luminaries(dark, Moon(elevation=radians(-20.0))), [])
        self.assertEqual(sky_map(Settings(dark), [])[..., :3].max(), 0.0)

    def test_bad_conditions_at_night_are_bad(self):
        with self.assertRaises(RangeError) as caught:
            luminaries(Conditions(solar_elevation=radians(-30.0), visibility=5e3), None)
        self.assertEqual(explain(caught.exception), "Visibility 5 km: the model has 20 to 131.8 km")


class Units(unittest.TestCase):
    def test_watts_of_683_lumens(self):
        self.assertEqual(units.blender_factor(0.0), 1.0 / 683.0)
        strength, colour = units.strength_and_colour((683.0, 341.5, -5.0), 1.0)
        self.assertAlmostEqual(strength, 2.0)
        np.testing.assert_allclose(colour, (1.0, 0.5, 0.0))
        self.assertEqual(units.strength_and_colour((0.0, 0.0, 0.0), 0.0)[0], 0.0)

    def test_grey_card(self):
        wanted = light("--sun-elevation=30")["global_horizontal"]["luminous"]
        stops = exposure.for_grey_card(Settings(Conditions(solar_elevation=radians(30.0))))
        self.assertAlmostEqual(units.blender_factor(stops) * wanted / np.pi, 1.0, places=3)
        with self.assertRaises(InputError):
            exposure.for_grey_card(Settings(Conditions(solar_elevation=-1.0)))


class Air(unittest.TestCase):
    """Looks slices up as the compositor does."""

    def test_next_to_the_library(self):
        far = 80e3
        for altitude, pitch, elevation in ((1200.0, 0.0, 10.0), (3000.0, -0.3, 30.0), (2.0, 0.0, 2.0)):
            with self.subTest(altitude=altitude):
                sun = of(elevation, altitude=altitude, visibility=40e3)
                axis = (np.cos(pitch), 0.0, np.sin(pitch))
                frustum = air.Frustum(axis, (0.0, -0.5, 0.0), (-0.28 * axis[2], 0.0, 0.28 * axis[0]), far)
                self.check(sun, frustum, altitude)

    def check(self, sun, frustum, altitude):
        light_, factors = air.volume(sun.conditions, [sun], frustum)
        random = np.random.default_rng(1)
        x, y = random.uniform(0, 1, (2, 4000))
        depth = frustum.far * random.uniform(0, 1, 4000) ** 2
        rays = np.array(frustum.axis) + (2 * x - 1)[:, None] * frustum.right + (2 * y - 1)[:, None] * frustum.up
        camera = np.array([0.0, 0.0, altitude])
        points = camera + depth[:, None] * rays
        radius = default_model().planet_radius
        above = np.linalg.norm(points + [0.0, 0.0, radius], axis=1) > radius + 1.0
        self.assertGreater(above.sum(), 500)
        perspective = sun.model.colour_aerial_perspective(sun.conditions)
        added, taken = perspective.rgb(camera, points[above])
        seen_light = looked_up(light_, x[above], y[above], depth[above] / frustum.far)
        seen_factors = looked_up(factors, x[above], y[above], depth[above] / frustum.far)
        error = np.abs(seen_light - added).max(-1) / added.max()
        factor_error = np.abs(seen_factors - taken).max(-1)
        print(f"air at {altitude:.0f} m: light p95 {np.percentile(error, 95):.4f}, max {error.max():.4f} of the "
              f"brightest; factors p95 {np.percentile(factor_error, 95):.4f}, max {factor_error.max():.4f}")
        # Volumes and segments of the library differ by up to 0.8 % of the light there is; the rest is interpolation.
        self.assertLess(np.percentile(error, 95), 0.015)
        self.assertLess(error.max(), 0.04)
        self.assertLess(np.percentile(factor_error, 95), 0.005)
        self.assertLess(factor_error.max(), 0.03)

    def test_things_on_the_ground_are_not_black(self):
        """Just behind the ground the library has nothing; slices there are those of air that goes on."""
        sun = of(20.0, altitude=2.0)
        frustum = air.Frustum((1.0, 0.0, 0.0), (0.0, -0.5, 0.0), (0.0, 0.0, 0.28), 100e3)
        _, factors = air.volume(sun.conditions, [sun], frustum)
        near = looked_up(factors, np.full(9, 0.5), np.linspace(0.0, 0.4, 9), np.full(9, 10.0 / 100e3))
        self.assertGreater(near.min(), 0.99)

    def test_the_camera_sees_nothing_in_front_of_itself(self):
        sun = of(20.0)
        frustum = air.Frustum((1.0, 0.0, 0.0), (0.0, -0.5, 0.0), (0.0, 0.0, 0.28), 1e3)
        light_, factors = air.volume(sun.conditions, [sun], frustum)
        self.assertEqual(light_[: air.ROWS, :, :3].max(), 0.0)
        self.assertEqual(factors[: air.ROWS, :, :3].min(), 1.0)

    def test_moonlit_air(self):
        """Sun and moon add."""
        conditions, moon = Conditions(solar_elevation=radians(-5.0), altitude=800.0), Moon(0.5, 2.0, 0.2)
        frustum = air.Frustum((1.0, 0.0, 0.05), (0.0, -0.5, 0.0), (0.0, 0.0, 0.1), 50e3)
        both, moonless, sunless = (
            air.volume(conditions, luminaries(of_sun, of_moon), frustum)[0][..., :3]
            for of_sun, of_moon in (
                (conditions, moon),
                (conditions, None),
                (Conditions(solar_elevation=-1.0, altitude=800.0), moon),
            )
        )
        self.assertGreater(sunless.max(), 0.0)
        np.testing.assert_allclose(both, moonless + sunless, rtol=1e-5)

    def test_night_has_air(self):
        dark = Conditions(solar_elevation=-1.0)
        frustum = air.Frustum((1.0, 0.0, 0.1), (0.0, -0.5, 0.0), (0.0, 0.0, 0.1), 50e3)
        light_, factors = air.volume(dark, [], frustum)
        self.assertEqual(light_[..., :3].max(), 0.0)
        self.assertLess(factors[-1, 0, 1], 0.5)


def looked_up(image, x, y, share_of_far):
    place = np.sqrt(share_of_far) * (air.SLICES - 1)
    first = np.minimum(np.floor(place), air.SLICES - 2)
    column = x * (air.COLUMNS - 1)
    share = (place - first)[:, None]
    low = bilinear(image, column, first * air.ROWS + y * (air.ROWS - 1))
    high = bilinear(image, column, (first + 1) * air.ROWS + y * (air.ROWS - 1))
    return low + share * (high - low)


def bilinear(image, column, row):
    c, r = np.minimum(column.astype(int), image.shape[1] - 2), np.minimum(row.astype(int), image.shape[0] - 2)
    u, v = (column - c)[:, None], (row - r)[:, None]
    below = image[r, c, :3] * (1 - u) + image[r, c + 1, :3] * u
    above = image[r + 1, c, :3] * (1 - u) + image[r + 1, c + 1, :3] * u
    return below * (1 - v) + above * v


if __name__ == "__main__":
    unittest.main()
