"""The integrator `welkin_path`: light and transmittance of the air, their frames, and the path tracer around them."""

import unittest

import mitsuba as mi
import numpy as np
from variants import InVariants, direction, unit_directions

CAMERA = [0.0, 0.0, 1500.0]


def scene(integrator=None, sky=None, things=None, target=(0.0, 1.0, 0.0), size=(32, 32), fov=60.0, camera=CAMERA):
    up = mi.ScalarTransform4f()
    aim = [float(c + t) for c, t in zip(camera, target)]
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "welkin_path", "max_depth": 3, **(integrator or {})},
        "sky": {"type": "welkin", "solar_elevation": 20.0, "solar_azimuth": 30.0, "sun_scale": 0.0, **(sky or {})},
        "sensor": {
            "type": "perspective", "fov": fov, "far_clip": 1e7, "to_world": up.look_at(camera, aim, [0, 0, 1]),
            "film": {"type": "hdrfilm", "width": size[0], "height": size[1], "pixel_format": "rgb"},
        },
        **(things or {}),
    })


def black(**shape):
    return {"bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}, **shape}


def prepared(**parameters):
    """The integrator with its tables for a scene that is 40 km wide and 3 km high."""
    up = mi.ScalarTransform4f()
    box = black(type="cube", to_world=up.translate([0, 0, 1500]).scale([20e3, 20e3, 1500]))
    made = scene(things={"box": box}, **parameters)
    integrator = made.integrator()
    integrator.prepare(made)
    return integrator


def paths(count, from_camera):
    """Starts and ends above the ground."""
    random = np.random.default_rng(5)
    start = np.tile(CAMERA, (count, 1))
    if not from_camera:
        start = np.stack([*random.uniform(-1e3, 1e3, (2, count)), random.uniform(1.0, 3000.0, count)], 1)
    d = unit_directions(count, seed=6)
    down = np.where(d[:, 2] < 0.0, start[:, 2] / np.maximum(-d[:, 2], 1e-9), 30e3)
    return start, d, np.minimum(30e3 * random.uniform(0.0, 1.0, count) ** 2 + 5.0, 0.98 * down)


def along(integrator, start, d, length, wavelength, from_camera):
    vector = lambda v: mi.Vector3f(v.T.astype(np.float32))
    wavelengths = type(mi.Ray3f().wavelengths)(wavelength) if mi.is_spectral else []
    light, factor = integrator.air.along(
        mi.Point3f(vector(start)), vector(d), mi.Float(length.astype(np.float32)), wavelengths, from_camera, True)
    return light, np.array(factor)


class Values(InVariants):
    def check(self, got, true, p50, p95):
        error = np.abs(got / true - 1.0)
        self.assertLess(np.median(error), p50)
        self.assertLess(np.quantile(error, 0.95), p95)

    def test_colours_are_those_of_welkin(self):
        import welkin_sky

        for _ in self.each("llvm_ad_rgb"):
            for elevation in (40.0, 3.0, -3.0):
                integrator = prepared(sky={"solar_elevation": elevation})
                air = welkin_sky.default_model().colour_aerial_perspective(
                    solar_elevation=np.radians(elevation), solar_azimuth=np.radians(30.0))
                for from_camera, p50, p95 in ((True, 1.5e-3, 1.5e-2), (False, 1.2e-2, 5.5e-2)):
                    start, d, length = paths(5000, from_camera)
                    light, factor = along(integrator, start, d, length, 0.0, from_camera)
                    end = start + d * length[:, None]
                    xyz, _ = air.xyz(start, end)
                    _, true = air.rgb(start, end)
                    rgb_to_y = np.linalg.inv(np.array(welkin_sky.colour_space_matrix("srgb")))[1]
                    y = rgb_to_y @ np.array(light) * (683.002 * 106.7502593994140625)
                    self.check(y, xyz[:, 1], p50, p95)
                    self.assertLess(np.quantile(np.abs(factor.T - true).max(1), 0.95), 1e-3 if from_camera else 5e-3)

    def test_spectra_are_those_of_welkin(self):
        import welkin_sky

        for _ in self.each("llvm_ad_spectral"):
            integrator = prepared()
            model = welkin_sky.default_model()
            start, d, length = paths(3000, True)
            end = start + d * length[:, None]
            air = model.aerial_perspective(solar_elevation=np.radians(20.0), solar_azimuth=np.radians(30.0))
            for wavelength in (420.0, 550.0, 650.0):
                light, factor = along(integrator, start, d, length, wavelength, True)
                first = np.array(light[0, 0] if mi.is_polarized else light)[0]
                response = welkin_sky.Response.table(
                    [wavelength - 10.0, wavelength, wavelength + 10.0], [0, 1, 0]).normalised()
                bands = model.bands([response])
                true, transmittance = model.band_aerial_perspective(bands, air.conditions).in_scattering(start, end)
                self.check(first, true[:, 0], 3e-3, 2e-2)
                self.assertLess(np.quantile(np.abs(factor[0] - transmittance[:, 0]), 0.95), 1e-2)

    def test_nothing_is_between_things_that_touch(self):
        for _ in self.each("llvm"):
            integrator = prepared()
            start, d, length = paths(1000, False)
            light, factor = along(integrator, start, d, 0.0 * length, 550.0, False)
            self.assertEqual(np.abs(np.array(light)).max(), 0.0)
            self.assertEqual(np.abs(factor - 1.0).max(), 0.0)


class Polarisation(InVariants):
    def test_light_is_polarised_across_the_plane_of_view_and_sun(self):
        for _ in self.each("polarized"):
            for to_world in (mi.ScalarTransform4f(), mi.ScalarTransform4f().rotate([0, 0, 1], 70)):
                integrator = prepared(sky={"to_world": to_world})
                turn = np.array(to_world.matrix)[:3, :3]
                start, d, length = paths(3000, True)
                light, _ = along(integrator, start, d, length, 550.0, True)
                i, q, u = (np.array(light[k, 0])[0] for k in range(3))
                forward = -d
                x = np.array(mi.mueller.stokes_basis(mi.Vector3f(forward.T.astype(np.float32)))).T
                y = np.cross(forward, x)
                angle = 0.5 * np.arctan2(u, q)[:, None]
                field = np.cos(angle) * x + np.sin(angle) * y
                normal = np.cross(d, turn @ direction(20.0, 30.0))
                normal /= np.linalg.norm(normal, axis=1)[:, None]
                strong = np.hypot(q, u) > 0.25 * i
                self.assertGreater(strong.sum(), 500)
                self.assertGreater(np.quantile(np.abs((field * normal).sum(1))[strong], 0.01), np.cos(np.radians(7.0)))

    def test_a_polariser_of_mitsuba_passes_most_across_that_plane(self):
        """Mitsuba's own element between camera and sky, and between camera and air: where its light is most."""
        for _ in self.each("polarized"):
            up, sun = mi.ScalarTransform4f(), direction(20.0, 30.0)
            # Looking down at black ground, or up: in both cases all light is from the air.
            for view in ([-0.6, 0.9, 0.8], [-0.6, 0.9, -0.4]):
                view = np.array(view) / np.linalg.norm(view)
                place = up.look_at([float(c) for c in CAMERA + view], [float(c) for c in CAMERA], [0, 0, 1])
                passed = []
                for theta in (0.0, 45.0, 90.0, 135.0):
                    made = scene(
                        target=view, fov=2.0, size=(4, 4),
                        things={
                            "filter": {
                                "type": "rectangle", "to_world": place.rotate([0, 0, 1], theta),
                                "bsdf": {"type": "polarizer"}},
                            "ground": black(type="disk", to_world=up.scale([9e3, 9e3, 1])),
                        })
                    passed.append(np.array(mi.render(made, spp=256)).mean())
                # Malus: passed = I/2 (1 + p cos 2(theta - angle)).
                angle = 0.5 * np.arctan2(passed[1] - passed[3], passed[0] - passed[2])
                x, y = (np.array(place.matrix)[:3, k] for k in (0, 1))
                field = np.cos(angle) * x + np.sin(angle) * y
                normal = np.cross(view, sun)
                self.assertGreater(np.abs(field @ normal) / np.linalg.norm(normal), np.cos(np.radians(5.0)))
                self.assertGreater(max(passed) / min(passed), 1.3)


class PathTracer(InVariants):
    def test_a_white_thing_in_a_white_room_vanishes(self):
        """Without air a path tracer of one that reflects all and a wall that shines is a furnace."""
        for _ in self.each("llvm"):
            made = scene(
                integrator={"altitude": 95e3, "max_depth": 200, "rr_depth": 500, "hide_emitters": True},
                sky={"sky_scale": 0.0},
                camera=[0.0, -3.0, 0.0],
                things={
                    "ball": {"type": "sphere", "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 1.0}}},
                    "room": {
                        "type": "sphere", "radius": 8.0, "flip_normals": True,
                        "light": {"type": "area", "radiance": {"type": "rgb", "value": 1.0}}},
                })
            image = np.array(mi.render(made, spp=512))
            np.testing.assert_allclose(image.mean((0, 1)), 1.0, rtol=5e-3)
            np.testing.assert_allclose(image[12:20, 12:20].mean((0, 1)), 1.0, rtol=5e-3)

    def test_without_air_it_is_the_path_tracer_of_mitsuba(self):
        for _ in self.each("llvm"):
            up = mi.ScalarTransform4f()
            things = {
                "ball": {"type": "sphere", "bsdf": {"type": "roughplastic"}},
                "glass": {"type": "sphere", "center": [2.2, 0, 0], "bsdf": {"type": "dielectric"}},
                "ground": {"type": "rectangle", "to_world": up.translate([0, 0, -1]).scale([9, 9, 1])},
                "lamp": {
                    "type": "sphere", "center": [-2, 0, 2], "radius": 0.4,
                    "light": {"type": "area", "radiance": {"type": "rgb", "value": [0.2, 0.1, 0.05]}}},
            }
            images = []
            for kind in ("welkin_path", "path"):
                made = scene(
                    integrator={"type": kind, "max_depth": 6, **({"altitude": 95e3} if kind == "welkin_path" else {})},
                    sky={"altitude": 95e3, "sun_scale": 1.0}, things=things, camera=[0.0, -6.0, 2.0], target=[0.1, 1.0, -0.3])
                images.append(np.array(mi.render(made, spp=512)).reshape(4, 8, 4, 8, 3).mean((1, 3)))
            scale = images[1].mean()
            self.assertLess(np.quantile(np.abs(images[0] - images[1]), 0.9) / scale, 2e-2)
            np.testing.assert_allclose(images[0].mean(), scale, rtol=1e-2)

    def test_a_lamp_fades_by_the_transmittance(self):
        import welkin_sky

        for _ in self.each("llvm_ad_rgb"):
            made = scene(
                sky={"sky_scale": 0.0}, fov=1.0, size=(8, 8), integrator={"hide_emitters": True},
                things={
                    "wall": {
                        "type": "rectangle",
                        "to_world": mi.ScalarTransform4f().look_at([0, 20e3, 1500], [0, 0, 1500], [0, 0, 1]).scale([9e3, 9e3, 1]),
                        "light": {"type": "area", "radiance": {"type": "rgb", "value": 1.0}}},
                    "ground": black(type="disk", to_world=mi.ScalarTransform4f().scale([3e4, 3e4, 1])),
                })
            seen = np.array(mi.render(made, spp=64)).mean((0, 1))
            air = welkin_sky.default_model().colour_aerial_perspective(solar_elevation=np.radians(20.0))
            _, true = air.rgb(CAMERA, [0.0, 20e3, 1500.0])
            np.testing.assert_allclose(seen, true, rtol=1e-2)

    def test_things_far_away_fade_into_the_sky(self):
        """The air before a black wall that is far away is nearly the sky beside it."""
        for _ in self.each("llvm"):
            up = mi.ScalarTransform4f()
            wall = black(type="rectangle", to_world=up.look_at([0, 400e3, 0], [0, 0, 0], [0, 0, 1]).scale([100e3, 100e3, 1]))
            sky, walled = (
                np.array(mi.render(scene(
                    sky={"visibility": 25e3}, things=things, camera=[0, 0, 2.0], target=[0, 1, 0.012], fov=0.5), spp=32))
                for things in ({"ground": black(type="disk")}, {"wall": wall, "ground": black(type="disk")}))
            np.testing.assert_allclose(walled.mean((0, 1)), sky.mean((0, 1)), rtol=6e-3)


class Scenes(InVariants):
    def test_random_scenes_are_finite(self):
        random = np.random.default_rng(7)
        for _ in self.each("llvm"):
            for _ in range(8):
                up = mi.ScalarTransform4f()
                metres = float(random.choice([0.01, 1.0, 1e3]))
                height = float(random.choice([1.5, 300.0, 9e3, 80e3])) / metres
                made = scene(
                    integrator={"altitude": float(random.uniform(-50.0, 2e3)), "metres_per_unit": metres},
                    sky={
                        "solar_elevation": random.uniform(-11.0, 90.0), "visibility": random.uniform(20e3, 131e3),
                        "sun_scale": 1.0, "moon_phase": float(random.choice([180.0, 30.0])), "altitude": 0.0,
                    },
                    camera=[0.0, 0.0, height], target=[0.0, 1.0, random.uniform(-1.0, 0.5)],
                    things={
                        "ground": {"type": "rectangle", "to_world": up.scale([60.0 * height, 60.0 * height, 1])},
                        "ball": {"type": "sphere", "center": [0, 2 * height, height], "radius": 0.5 * height},
                        "mirror": {
                            "type": "sphere", "center": [height, 2 * height, height], "radius": 0.4 * height,
                            "bsdf": {"type": "conductor"}},
                    })
                image = np.array(mi.render(made, spp=8))
                self.assertTrue(np.isfinite(image).all())
                self.assertGreater(image.max(), 0.0)

    def test_roofs_and_towers_cast_shadows(self):
        """Things that are farther away than the scene's units would tell."""
        for _ in self.each("llvm"):
            up = mi.ScalarTransform4f()
            for kind in ("path", "welkin_path"):
                ground = {"ground": {"type": "disk", "to_world": up.scale([5, 5, 1])}}
                roof = {"roof": black(type="disk", to_world=up.translate([0, 0, 200]).scale([90e3, 90e3, 1]))}
                lit, shadowed = (
                    np.array(mi.render(scene(
                        integrator={"type": kind}, sky={"solar_elevation": 60.0, "sun_scale": 1.0},
                        camera=[0.0, 0.0, 9.0], target=[0.01, 0.0, -1.0], fov=20.0, size=(8, 8), things=things), spp=256)).mean()
                    for things in (ground, ground | roof))
                self.assertLess(shadowed, 0.02 * lit)

    def test_every_camera_sees_its_own_air(self):
        for _ in self.each("llvm_ad_rgb"):
            up = mi.ScalarTransform4f()
            sensor = lambda height: {
                "type": "perspective", "fov": 40, "far_clip": 1e7,
                "to_world": up.look_at([0, 0, height], [0, 1, height - 0.1], [0, 0, 1]),
                "film": {"type": "hdrfilm", "width": 16, "height": 16, "pixel_format": "rgba"}}
            ground = black(type="disk", to_world=up.scale([1e5, 1e5, 1]))
            pane = {
                "type": "rectangle", "to_world": up.look_at([0, 3, 9e3], [0, 0, 9e3], [0, 0, 1]).scale([9, 9, 1]),
                "bsdf": {"type": "mask", "opacity": 0.0, "nested": {"type": "diffuse"}}}
            made = lambda **things: mi.load_dict({
                "type": "scene", "integrator": {"type": "welkin_path"}, "sky": {"type": "welkin"}, "ground": ground, **things})
            alone = np.array(mi.render(made(only=sensor(9e3)), spp=64))
            both = made(first=sensor(2.0), second=sensor(9e3))
            mi.render(both, sensor=0, spp=1)
            second = np.array(mi.render(both, sensor=1, spp=64))
            np.testing.assert_allclose(second, alone, rtol=2e-3, atol=1e-6)
            behind_pane = np.array(mi.render(made(only=sensor(9e3), pane=pane), spp=256))
            np.testing.assert_allclose(behind_pane.mean((0, 1)), alone.mean((0, 1)), rtol=2e-2)
            self.assertTrue((alone[:, :, 3] > 0.99).all())

    def test_things_that_move_change_the_tables(self):
        for _ in self.each("llvm_ad_rgb"):
            up = mi.ScalarTransform4f()
            wall = lambda y: {"wall": black(type="rectangle", to_world=up.translate([0, y, 1500]).scale([30e3, 30e3, 1]).rotate([1, 0, 0], 90))}
            made = scene(things=wall(100.0))
            mi.render(made, spp=1)
            parameters = mi.traverse(made)
            parameters["wall.to_world"] = mi.Transform4f().translate([0, 29e3, 0]) @ parameters["wall.to_world"]
            parameters.update()
            moved = np.array(mi.render(made, spp=16)).mean((0, 1))
            fresh = np.array(mi.render(scene(things=wall(29.1e3)), spp=16)).mean((0, 1))
            np.testing.assert_allclose(moved, fresh, rtol=1e-2)

    def test_a_sky_alone_is_seen(self):
        for _ in self.each("llvm_ad_rgb"):
            seen, plain = (
                np.array(mi.render(scene(integrator={"type": kind}, sky={"altitude": 1500.0}), spp=16))
                for kind in ("welkin_path", "path"))
            np.testing.assert_allclose(seen, plain, rtol=1e-3)

    def test_tables_follow_the_sun(self):
        for _ in self.each("llvm_ad_rgb"):
            ball = {"ball": {"type": "sphere", "center": [0, 5e3, 1500], "radius": 2e3}}
            made = scene(things=ball)
            mi.render(made, spp=4)
            parameters = mi.traverse(made)
            parameters["sky.solar_elevation"] = 3.0
            parameters.update()
            moved = np.array(mi.render(made, spp=4, seed=1))
            fresh = np.array(mi.render(scene(things=ball, sky={"solar_elevation": 3.0}), spp=4, seed=1))
            np.testing.assert_allclose(moved, fresh, rtol=1e-4)

    def test_what_is_missing_is_said(self):
        for _ in self.each("llvm_ad_rgb"):
            made = mi.load_dict({"type": "scene", "integrator": {"type": "welkin_path"}, "sensor": {"type": "perspective"}})
            with self.assertRaisesRegex(ValueError, "emitter of type welkin"):
                made.integrator().prepare(made)
            with self.assertRaisesRegex(ValueError, "metres_per_unit"):
                bad = scene(integrator={"metres_per_unit": 0.0})
                bad.integrator().prepare(bad)
        for _ in self.each("scalar"):
            with self.assertRaisesRegex(Exception, "variant"):
                mi.load_dict({"type": "welkin_path"})


if __name__ == "__main__":
    unittest.main()
