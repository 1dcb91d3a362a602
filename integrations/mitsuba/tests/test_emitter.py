"""The emitter in each variant that this machine can run: densities, energy, frames, parameters."""

import unittest

import mitsuba as mi
import numpy as np
from variants import InVariants, emitter, unit_directions


def seen(light, directions, wavelength=550.0):
    """What the emitter says of directions; arrays in variants of LLVM only."""
    import drjit as dr

    si = dr.zeros(mi.SurfaceInteraction3f, len(directions))
    si.wi = -mi.Vector3f(directions.T.astype(np.float32))
    if mi.is_spectral:
        si.wavelengths = type(si.wavelengths)(wavelength)
    return light.eval(si)


def colours(light, directions):
    value = np.array(seen(light, directions))
    return value if value.shape[0] == len(directions) else value.T


class Density(InVariants):
    def test_chi_square(self):
        for _ in self.each("llvm"):
            import drjit as dr
            from mitsuba.chi2 import ChiSquareTest, SphericalDomain

            full = {"moon_phase": 5.0, "moon_elevation": 40.0, "moon_azimuth": -100.0}
            for elevation, altitude, moon in (
                    (60.0, 0.0, {}), (15.0, 2000.0, {}), (1.0, 0.0, {}), (-5.0, 9000.0, {}), (-11.0, 0.0, full),
                    (-40.0, 0.0, full)):
                light = emitter(solar_elevation=elevation, solar_azimuth=40.0, altitude=altitude, sun_scale=0.0, **moon)

                def sample(u):
                    ds, _ = light.sample_direction(dr.zeros(mi.Interaction3f), mi.Point2f(u))
                    return ds.d

                def density(d):
                    ds = dr.zeros(mi.DirectionSample3f)
                    ds.d = d
                    return light.pdf_direction(dr.zeros(mi.Interaction3f), ds)

                test = ChiSquareTest(
                    domain=SphericalDomain(), sample_func=sample, pdf_func=density, sample_dim=2,
                    sample_count=1_000_000, res=101, ires=8)
                self.assertTrue(test.run(0.001, 4), f"sun at {elevation}: p = {test.p_value}")

    def test_the_disc_is_drawn_with_its_density(self):
        for _ in self.each("llvm"):
            import drjit as dr

            light = emitter(solar_elevation=20.0, sky_scale=1e-9)
            count = 1 << 16
            random = mi.PCG32(count)
            u = mi.Point2f(random.next_float32(), random.next_float32())
            it = dr.zeros(mi.Interaction3f, count)
            ds, _ = light.sample_direction(it, u)
            pdf = np.array(light.pdf_direction(it, ds))
            np.testing.assert_allclose(np.array(ds.pdf), pdf, rtol=2e-2)
            # Mean of 1/pdf over the samples of the disc is its solid angle over its share of them.
            d = np.array(ds.d).T
            centre = d[pdf > np.median(pdf) * 0.5].mean(0)
            on_disc = d @ (centre / np.linalg.norm(centre)) > np.cos(0.0047)
            solid_angle = (1.0 / pdf[on_disc]).sum() / count
            self.assertAlmostEqual(solid_angle / (np.pi * 0.004654793**2), 1.0, delta=0.02)


class Energy(InVariants):
    def test_drawn_and_uniform_directions_agree(self):
        for _ in self.each("llvm"):
            import drjit as dr

            for elevation in (60.0, 5.0, -4.0):
                light = emitter(solar_elevation=elevation, solar_azimuth=40.0, sun_scale=0.0)
                count = 1 << 20
                random = mi.PCG32(count)
                two = lambda: mi.Point2f(random.next_float32(), random.next_float32())
                it = dr.zeros(mi.Interaction3f, count)
                if mi.is_spectral:
                    it.wavelengths = type(it.wavelengths)(550.0)
                ds, weight = light.sample_direction(it, two())
                d = mi.warp.square_to_uniform_sphere(two())
                si = dr.zeros(mi.SurfaceInteraction3f, count)
                si.wi = -d
                if mi.is_spectral:
                    si.wavelengths = type(si.wavelengths)(550.0)
                value = light.eval(si)
                if mi.is_polarized:
                    weight, value = weight[0, 0], value[0, 0]
                drawn = np.array(weight * dr.maximum(ds.d.z, 0.0)).mean(-1)
                uniform = np.array(value * dr.maximum(d.z, 0.0)).mean(-1) * 4.0 * np.pi
                np.testing.assert_allclose(drawn, uniform, rtol=1e-2)

    def test_values_are_those_of_welkin(self):
        import welkin_sky

        for variant in self.each("llvm_ad_rgb"):
            for elevation, altitude in ((40.0, 0.0), (2.0, 3000.0), (-4.0, 0.0)):
                light = emitter(solar_elevation=elevation, altitude=altitude, sun_scale=0.0)
                directions = unit_directions(4000, 0.01)
                got = colours(light, directions)
                sky = welkin_sky.default_model().colour_sky(
                    solar_elevation=np.radians(elevation), altitude=altitude)
                xyz = sky.xyz(directions.astype(np.float32)) / (683.002 * 106.7502593994140625)
                rgb = xyz @ np.array(welkin_sky.colour_space_matrix("srgb")).T
                error = np.abs(got - rgb).max(1) / xyz[:, 1]
                self.assertLess(np.quantile(error, 0.95), 2.5e-3, variant)
                self.assertLess(np.quantile(error, 0.999), 2e-2, variant)

    def test_moonlight_is_added(self):
        import welkin_sky

        moon = welkin_sky.Moon(elevation=np.radians(40.0), azimuth=np.radians(-100.0), phase_angle=np.radians(20.0))
        for _ in self.each("llvm_ad_rgb"):
            for elevation in (-9.0, -30.0):
                light = emitter(
                    solar_elevation=elevation, sun_scale=0.0, moon_phase=20.0, moon_elevation=40.0, moon_azimuth=-100.0)
                directions = unit_directions(4000, 0.01)
                got = colours(light, directions)
                sky = welkin_sky.default_model().sky_with_moon(moon, solar_elevation=np.radians(elevation))
                xyz = sky.xyz(directions.astype(np.float32)) / (683.002 * 106.7502593994140625)
                rgb = xyz @ np.array(welkin_sky.colour_space_matrix("srgb")).T
                error = np.abs(got - rgb).max(1) / xyz[:, 1]
                self.assertLess(np.quantile(error, 0.95), 4e-3)
            with self.assertRaisesRegex(Exception, "phase"):
                emitter(moon_phase=200.0)

    def test_spectra_have_the_colour_of_rgb(self):
        means = {}
        for variant in self.each("llvm_ad"):
            if mi.is_monochromatic:
                continue
            light = {"type": "welkin", "solar_elevation": 25.0, "sun_scale": 0.0}
            scene = mi.load_dict({
                "type": "scene", "integrator": {"type": "direct"}, "sky": light,
                "sensor": {
                    "type": "perspective", "fov": 80,
                    "to_world": mi.ScalarTransform4f().look_at([0, 0, 0], [0, 1, 0.8], [0, 0, 1]),
                    "film": {"type": "hdrfilm", "width": 32, "height": 32},
                },
            })
            means[variant] = np.array(mi.render(scene, spp=256)).mean((0, 1))
        reference = next(iter(means.values()))
        for variant, mean in means.items():
            np.testing.assert_allclose(mean, reference, rtol=1e-2, err_msg=variant)


class Polarisation(InVariants):
    def test_light_is_polarised_across_the_plane_of_view_and_sun(self):
        for _ in self.each("polarized"):
            for to_world in (mi.ScalarTransform4f(), mi.ScalarTransform4f().rotate([1, 0, 0], -90)):
                light = emitter(solar_elevation=20.0, solar_azimuth=30.0, sun_scale=0.0, to_world=to_world)
                turn = np.array(to_world.matrix)[:3, :3]
                directions = unit_directions(2000, 0.05) @ turn.T
                stokes = seen(light, directions)
                i, q, u = (np.array(stokes[k, 0])[0] for k in range(3))
                forward = -directions
                x = np.array(mi.mueller.stokes_basis(mi.Vector3f(forward.T.astype(np.float32)))).T
                y = np.cross(forward, x)
                angle = 0.5 * np.arctan2(u, q)[:, None]
                field = np.cos(angle) * x + np.sin(angle) * y
                e, a = np.radians([20.0, 30.0])
                sun = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)]) @ turn.T
                normal = np.cross(directions, sun)
                normal /= np.linalg.norm(normal, axis=1)[:, None]
                strong = np.hypot(q, u) > 0.25 * i
                self.assertGreater(strong.sum(), 500)
                self.assertGreater(np.abs((field * normal).sum(1))[strong].min(), np.cos(np.radians(5.0)))


class Parameters(InVariants):
    def test_the_sun_moves_without_a_new_scene(self):
        for _ in self.each("llvm_ad_rgb"):
            scene = mi.load_dict({"type": "scene", "sky": {"type": "welkin", "solar_elevation": 40.0}})
            parameters = mi.traverse(scene)
            directions = unit_directions(100, 0.05)
            light = scene.emitters()[0]
            parameters["sky.solar_elevation"] = 3.0
            parameters["sky.solar_azimuth"] = 70.0
            parameters.update()
            fresh = emitter(solar_elevation=3.0, solar_azimuth=70.0)
            np.testing.assert_array_equal(colours(light, directions), colours(fresh, directions))

    def test_what_held_before_goes_on_after_a_bad_update(self):
        for _ in self.each("llvm_ad_rgb"):
            scene = mi.load_dict({"type": "scene", "sky": {"type": "welkin", "solar_elevation": 40.0}})
            parameters, light, directions = mi.traverse(scene), scene.emitters()[0], unit_directions(100, 0.05)
            before = colours(light, directions)
            parameters["sky.visibility"] = 3.0
            with self.assertRaisesRegex(Exception, "visibility"):
                parameters.update()
            np.testing.assert_array_equal(colours(light, directions), before)
            parameters["sky.visibility"] = 30e3
            parameters.update()
            np.testing.assert_array_equal(
                colours(light, directions), colours(emitter(solar_elevation=40.0, visibility=30e3), directions))

    def test_light_is_traced_from_the_sky(self):
        """The particle tracer agrees with the path tracer once the emitter knows where the scene is."""
        for _ in self.each("llvm_ad_rgb"):
            images = []
            for kind in ("path", "ptracer"):
                scene = mi.load_dict({
                    "type": "scene", "integrator": {"type": kind, "max_depth": 2},
                    "sky": {"type": "welkin", "solar_elevation": 50.0},
                    "ground": {"type": "rectangle", "to_world": mi.ScalarTransform4f().scale([4, 4, 1])},
                    "sensor": {
                        "type": "perspective", "fov": 30,
                        "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0.01, 0], [0, 1, 0]),
                        "film": {"type": "hdrfilm", "width": 8, "height": 8, "rfilter": {"type": "box"}},
                    },
                })
                if kind == "ptracer":
                    light = scene.emitters()[0]
                    with self.assertRaisesRegex(ValueError, "set_scene"):
                        light.sample_ray(0.0, 0.5, mi.Point2f(0.5), mi.Point2f(0.5))
                    light.set_scene(scene)
                images.append(np.array(mi.render(scene, spp=4096)).mean((0, 1)))
            np.testing.assert_allclose(images[1], images[0], rtol=2e-2)

    def test_bad_conditions_are_refused(self):
        for _ in self.each("rgb"):
            with self.assertRaisesRegex(Exception, "visibility"):
                emitter(visibility=3.0)
            with self.assertRaisesRegex(Exception, "solar_elevation"):
                emitter(solar_elevation=-40.0)
            for name, bad in (("sky_scale", float("nan")), ("sun_scale", -1.0), ("albedo", "dark"),
                              ("to_world", mi.ScalarTransform4f().scale([1, 1, 2]))):
                with self.assertRaisesRegex(Exception, name):
                    emitter(**{name: bad})


class Scenes(InVariants):
    def test_random_scenes_are_finite(self):
        random = np.random.default_rng(3)
        for variant in self.each("_"):
            size = 8 if "scalar" in variant else 32
            for _ in range(4 if "scalar" in variant else 12):
                light = {
                    "type": "welkin", "solar_elevation": random.uniform(-11.0, 90.0),
                    "solar_azimuth": random.uniform(-180.0, 180.0), "visibility": random.uniform(20e3, 131e3),
                    "albedo": random.uniform(), "altitude": random.choice([0.0, random.uniform(0.0, 15e3)]),
                }
                scene = mi.load_dict({
                    "type": "scene", "integrator": {"type": "path", "max_depth": 4}, "sky": light,
                    "ball": {"type": "sphere", "bsdf": {"type": "roughconductor"}},
                    "ground": {
                        "type": "rectangle", "to_world": mi.ScalarTransform4f().translate([0, 0, -1]).scale([9, 9, 1])},
                    "sensor": {
                        "type": "perspective", "fov": 100,
                        "to_world": mi.ScalarTransform4f().look_at([0, -4, 1], [0, 0, 0.5], [0, 0, 1]),
                        "film": {"type": "hdrfilm", "width": size, "height": size},
                    },
                })
                image = np.array(mi.render(scene, spp=8))
                self.assertTrue(np.isfinite(image).all(), light)
                self.assertGreater(image.max(), 0.0)


if __name__ == "__main__":
    unittest.main()
