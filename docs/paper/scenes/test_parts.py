"""Parts of the scenes against what they should be: `python -m unittest` in this folder."""

import math
import unittest

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_spectral")

import erosion  # noqa: E402
import planet  # noqa: E402
import plugins  # noqa: E402
import towers  # noqa: E402
import welkin_sky  # noqa: E402
from places import weights  # noqa: E402

plugins.register()


class Parts(unittest.TestCase):
    def test_every_cell_drains_into_all_below_it(self):
        heights = np.random.default_rng(3).random((20, 30))
        receiver, _ = erosion.receivers(heights, 2.0)
        area = np.full(600, 4.0)
        for cell in np.argsort(-heights.ravel()):
            if receiver[cell] != cell:
                area[receiver[cell]] += area[cell]
        found = erosion.drained_area(list(erosion._doublings(receiver)), 2.0)
        np.testing.assert_allclose(found, area)

    def test_a_step_solves_the_implicit_equation(self):
        heights = np.random.default_rng(5).random((16, 16)) * 100.0
        after = erosion.step(heights, 50.0, np.full((16, 16), 0.5), 1e-3, 10.0).ravel()
        receiver, length = erosion.receivers(heights, 50.0)
        area = erosion.drained_area(list(erosion._doublings(receiver)), 50.0)
        cut = 1e-3 * 10.0 * np.sqrt(area) / length * (after - after[receiver])
        np.testing.assert_allclose(after + cut, heights.ravel() + 5.0, rtol=1e-9)
        self.assertGreater(cut.max(), 0.5)

    def test_heights_on_the_planet_come_back(self):
        x, y = np.array([0.0, 3e3, -2e5]), np.array([0.0, -4e3, 3e5])
        heights = np.array([2.0, 4000.0, 15e3])
        points = planet.on_planet(x, y, heights)
        np.testing.assert_allclose(planet.height_of(points), heights, atol=1e-4)
        self.assertAlmostEqual(planet.RADIUS, welkin_sky.default_model().planet_radius)

    def test_shares_of_nodes_make_what_is_linear(self):
        nodes, values = (0.0, 4.0, 15.0), np.array([-1.0, 0.0, 1.0, 9.5, 20.0])
        shares = weights(nodes, values)
        np.testing.assert_allclose(shares.sum(0), 1.0)
        np.testing.assert_allclose(np.array(nodes) @ shares, [0.0, 0.0, 1.0, 9.5, 15.0])

    def test_towers_are_as_high_as_they_should_be(self):
        parts = towers.triangles()
        heights = planet.height_of(np.concatenate([parts["light"], parts["dark"]]))
        # Corners of a roof 10 km wide stand 4 m higher: the sphere falls away from the middle.
        self.assertAlmostEqual(heights.max(), 15e3, delta=4.0)
        ground = planet.height_of(parts["ground"].mean(1))
        # Nowhere under the sphere, on which the path tracer's ground lies.
        self.assertGreater(ground.min(), 0.0)
        self.assertLess(ground.max(), 4.0)

    def test_obj_and_meshes_are_the_same_triangles(self):
        text = towers.obj()["towers.obj"]
        faces = sum(len(corners) for corners in towers.triangles().values())
        self.assertEqual(text.count("\nf "), faces)
        self.assertEqual(sum(mesh.face_count() for mesh in towers.meshes().values()), faces)

    def test_the_sun_is_as_welkin_has_it_at_every_place(self):
        sun = mi.load_dict({"type": "placed_sun", "solar_elevation": 2.0, "solar_azimuth": 165.0, "visibility": 6e4})
        model = welkin_sky.default_model()
        for x, y, height in ((0.0, 0.0, 0.0), (0.0, 0.0, 8e3), (5e4, -2e4, 2e3), (2e5, 3e4, 9e3), (-3e4, 1e5, 500.0)):
            point = planet.on_planet(x, y, height)
            e, a = math.radians(2.0), math.radians(165.0)
            direction = [math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)]
            elevation = math.asin(float(planet.up_at(point) @ direction))
            conditions = welkin_sky.Conditions(solar_elevation=elevation, visibility=6e4, albedo=0.2, altitude=height)
            disc = model.solar_disc(conditions)
            expected = disc.irradiance(np.asarray(disc.direction, np.float32))[list(model.wavelengths).index(550.0)]
            found = sun.irradiance(mi.Point3f(*map(float, point)), [mi.Float(550.0)] * 4, True)
            self.assertAlmostEqual(float(found[0][0]) / float(expected), 1.0, delta=0.03, msg=f"{x}, {y}, {height}")

    def test_a_placed_sky_lights_as_a_sky_there_does(self):
        conditions = {"solar_elevation": 10.0, "solar_azimuth": 90.0, "sun_scale": 0.0}
        placed = mi.load_dict({"type": "placed_welkin", "altitude": 3e3, **conditions})
        there = mi.load_dict({"type": "welkin", "altitude": 3e3, **conditions})
        si = mi.SurfaceInteraction3f()
        si.wi = -mi.Vector3f(0.6, 0.0, 0.8)
        si.wavelengths = type(si.wavelengths)(450.0, 500.0, 550.0, 600.0)
        np.testing.assert_allclose(np.array(placed.eval(si)), np.array(there.eval(si)), rtol=1e-5)
        # Beside the sun, ahead: the same elevation there, the vertical turned.
        far = mi.load_dict({"type": "placed_welkin", "altitude": 3e3, "ahead": 2e5, **conditions})
        tilt = 2e5 / planet.RADIUS
        turned = mi.SurfaceInteraction3f()
        c, s = math.cos(tilt), math.sin(tilt)
        turned.wi = -mi.Vector3f(0.6 * c + 0.8 * s, 0.0, 0.8 * c - 0.6 * s)
        turned.wavelengths = si.wavelengths
        np.testing.assert_allclose(np.array(far.eval(turned)), np.array(there.eval(si)), rtol=0.02)


if __name__ == "__main__":
    unittest.main()
