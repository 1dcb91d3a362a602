"""Properties and operators as a user changes them: nothing wrong is lost, and nothing is left behind."""

import contextlib
import io
import sys
import unittest
from math import radians
from pathlib import Path

import numpy as np

from blender_case import PACKAGE, WORK, BlenderCase, bpy, pixels_of


class Panel(BlenderCase):
    def test_adding_makes_what_is_needed(self):
        world = bpy.data.worlds.new("Mine")
        self.scene.world = world
        self.assertEqual(bpy.ops.welkin.add(), {"FINISHED"})
        self.assertEqual([o.type for o in self.scene.objects], ["LIGHT"])
        self.assertNotEqual(self.scene.world, world)
        self.assertEqual(tuple(self.sky.image.size), (1024, 512))
        self.assertEqual(self.sky.image.colorspace_settings.name, "Linear Rec.709")
        # Added with an exposure that makes a grey card grey.
        self.assertTrue(-7.0 < self.sky.exposure < -2.0)
        bpy.ops.welkin.add()
        self.assertEqual(len(self.scene.objects), 1)
        self.assertEqual(len(bpy.data.worlds), 2)

    def test_removing_brings_the_world_back(self):
        world = self.scene.world = bpy.data.worlds.new("Mine")
        bpy.ops.welkin.add()
        self.sky.moon = True
        self.sky.visibility = 33.0
        bpy.ops.welkin.remove()
        self.assertEqual(self.scene.world, world)
        self.assertEqual(len(self.scene.objects), 0)
        self.assertFalse(bpy.data.images or bpy.data.lights)
        self.assertEqual([one.name for one in bpy.data.worlds], ["Mine"])
        self.assertAlmostEqual(self.sky.visibility, 33.0, places=4)

    def test_bad_input_is_said_and_loses_nothing(self):
        self.add()
        before = pixels_of(self.sky.image)
        for name, bad, good, message in (
            ("visibility", 5.0, 60.0, "Visibility 5 km: the model has 20 to 131.8 km"),
            ("altitude", 2e5, 10.0, "Altitude 200000 m: the model has 0 to 99000 m"),
        ):
            with self.subTest(name=name), self.silence() as output:
                setattr(self.sky, name, bad)
                self.assertEqual(self.status().error(self.scene), message)
                np.testing.assert_array_equal(pixels_of(self.sky.image), before)
                self.scene.frame_set(self.scene.frame_current + 1)
                setattr(self.sky, name, good)
                self.assertIsNone(self.status().error(self.scene))
                # Once in the background, where nobody sees the panel.
                self.assertEqual(output.getvalue().count(message), 1)
                self.assertEqual(len(output.getvalue().splitlines()), 1)
                before = pixels_of(self.sky.image)

    def test_a_day_that_is_not(self):
        self.add(sun_from="DATE", month=2, day=28, hour=12.0)
        self.assertIsNone(self.status().error(self.scene))
        self.sky.day = 30
        self.assertEqual(self.status().error(self.scene), "There is no day 2026-02-30")
        self.sky.day, self.sky.year = 1, 3000
        self.assertIn("1900 to 2100", self.status().error(self.scene))

    def test_ends_of_ranges_are_in_them(self):
        """Blender keeps numbers in single precision, which makes 131.8 km a little more."""
        self.add()
        for name, value in (
            ("visibility", 131.8),
            ("visibility", 20.0),
            ("altitude", 99e3),
            ("sun_elevation", radians(90.0)),
            ("sun_elevation", radians(-12.0)),
            ("albedo", 1.0),
        ):
            with self.subTest(name=name, value=value):
                self.sky.visibility, self.sky.altitude = 59.4, 0.0
                setattr(self.sky, name, value)
                self.assertIsNone(self.status().error(self.scene))
                self.assertEqual(self.status().notes(self.scene), [])

    def test_what_is_missing_is_said_and_restored(self):
        self.add()
        bpy.data.objects.remove(self.sky.sun_lamp)
        self.scene.world = None
        self.sky.sun_elevation = 0.5
        notes = " ".join(self.status().notes(self.scene))
        self.assertIn("another world", notes)
        self.assertIn("lamp of the sun", notes)
        bpy.ops.welkin.add()
        self.assertEqual(self.status().notes(self.scene), [])
        self.assertGreater(self.sky.sun_lamp.data.energy, 0.0)

    def test_a_copied_scene(self):
        """It shares image and lamps with the first, which keeps them when they are taken from the copy."""
        self.add(resolution="256", sun_elevation=0.5)
        first, image = self.scene, self.sky.image
        bpy.ops.scene.new(type="LINK_COPY")
        copy = bpy.context.scene
        self.assertNotEqual(copy, first)
        self.assertEqual(copy.welkin.image, image)
        bpy.ops.welkin.remove()
        self.assertEqual(first.welkin.image, image)
        self.assertIsNotNone(first.welkin.sun_lamp)
        self.assertEqual(first.world, first.welkin.world)
        bpy.ops.welkin.add()
        self.assertNotEqual(copy.welkin.image, image)
        self.assertNotEqual(copy.welkin.sun_lamp, first.welkin.sun_lamp)
        before = pixels_of(image)
        copy.welkin.sun_elevation = 0.9
        np.testing.assert_array_equal(pixels_of(image), before)

    @unittest.skipIf(bpy.app.version < (5, 0), "Blender has one working space")
    def test_working_spaces(self):
        """The lamp is as Blender itself converts it when the working space of the file changes."""
        for space in ("Linear Rec.2020", "ACEScg"):
            with self.subTest(space=space):
                self.setUp()
                self.add(sun_elevation=radians(5.0), resolution="256")
                light = self.sky.sun_lamp.data
                plain = light.energy * np.array(light.color)
                # Which it refuses as long as pixels are not saved.
                bpy.ops.wm.save_as_mainfile(filepath=str(WORK / "space.blend"))
                bpy.ops.wm.set_working_color_space(working_space=space, convert_colors=True)
                converted = light.energy * np.array(light.color)
                self.assertGreater(np.abs(converted - plain).max(), 1.0)
                self.sky.sun_elevation = radians(6.0)
                self.sky.sun_elevation = radians(5.0)
                np.testing.assert_allclose(light.energy * np.array(light.color), converted, rtol=1e-3)

    def test_grey_card(self):
        """A level plane of 0.18 is rendered as 0.18."""
        self.add(sun_elevation=0.6)
        bpy.ops.welkin.expose()
        lux = self.irradiance(512, albedo=0.18)
        luminance = lux @ [0.2126, 0.7152, 0.0722] / 683.0 * 2.0**self.sky.exposure * 0.18 / np.pi
        self.assertAlmostEqual(luminance, 0.18, delta=0.002)

    def test_exposure_leaves_the_pixels(self):
        self.add()
        before, energy = pixels_of(self.sky.image), self.sky.sun_lamp.data.energy
        strength = self.scene.world.node_tree.nodes["Welkin Background"].inputs["Strength"]
        self.assertAlmostEqual(strength.default_value, 1.0 / 683.0, places=9)
        self.sky.exposure = -3.0
        np.testing.assert_array_equal(pixels_of(self.sky.image), before)
        self.assertAlmostEqual(self.sky.sun_lamp.data.energy / energy, 0.125, places=6)
        self.assertAlmostEqual(strength.default_value, 0.125 / 683.0, places=9)

    def test_altitude_follows_the_camera(self):
        camera = self.camera(location=(0, 0, 1500.0))
        self.add(follow_camera=True, resolution="256")
        high = pixels_of(self.sky.image)
        camera.location.z = 0.0
        bpy.context.view_layer.update()
        low = pixels_of(self.sky.image)
        self.assertGreater(np.abs(high - low).max(), 100.0)
        self.sky.follow_camera, self.sky.altitude = False, 1500.0
        np.testing.assert_allclose(pixels_of(self.sky.image), high, rtol=1e-5)

    def test_presets(self):
        self.add(resolution="256")
        folder = Path(sys.modules[PACKAGE].__file__).parent / "data" / "presets" / "welkin"
        presets = sorted(folder.glob("*.py"))
        self.assertGreaterEqual(len(presets), 5)
        self.assertIn(str(folder), bpy.utils.preset_paths("welkin"))
        for preset in presets:
            with self.subTest(preset=preset.name):
                bpy.ops.script.execute_preset(filepath=str(preset), menu_idname="WELKIN_PT_presets")
                self.assertIsNone(self.status().error(self.scene))
                # The exposure is that of a grey card, to a third of a stop.
                kept = self.sky.exposure
                bpy.ops.welkin.expose()
                self.assertAlmostEqual(self.sky.exposure, kept, delta=0.33)

    def test_own_presets(self):
        self.add(visibility=44.0)
        bpy.ops.welkin.add_preset(name="Haze over the lake")
        self.sky.visibility = 100.0
        path = bpy.utils.preset_find("haze_over_the_lake", "welkin") or bpy.utils.preset_find(
            "Haze_over_the_lake", "welkin"
        )
        bpy.ops.script.execute_preset(filepath=path, menu_idname="WELKIN_PT_presets")
        self.assertAlmostEqual(self.sky.visibility, 44.0, places=4)

    def test_registering_twice(self):
        handlers = len(bpy.app.handlers.frame_change_post)
        for _ in range(2):
            bpy.ops.preferences.addon_disable(module=PACKAGE)
            self.assertFalse(hasattr(bpy.types.Scene, "welkin"))
            self.assertEqual(len(bpy.app.handlers.frame_change_post), handlers - 1)
            bpy.ops.preferences.addon_enable(module=PACKAGE)
        self.assertEqual(len(bpy.app.handlers.frame_change_post), handlers)
        self.add()

    def test_panels_are_drawn(self):
        """In every state: a panel that fails would only say so on a console."""
        panels = [getattr(bpy.types, name) for name in dir(bpy.types) if name.startswith("WELKIN_PT_")]
        self.assertGreaterEqual(len(panels), 6)
        for prepare in (lambda: None, self.add, self.with_moon, self.with_error):
            prepare()
            for panel in panels:
                layout = Layout()
                poll = getattr(panel, "poll", None)
                if hasattr(panel, "draw") and (poll is None or poll(bpy.context)) and "presets" not in panel.__name__:
                    panel.draw(Stand(panel, layout), bpy.context)
                    self.assertTrue(layout.log, panel.__name__)
        self.assertTrue(any("Visibility 5 km" in str(entry) for entry in self.main_panel()))

    def with_moon(self):
        self.sky.moon, self.sky.sun_from = True, "DATE"

    def with_error(self):
        self.sky.visibility = 5.0

    def main_panel(self):
        layout = Layout()
        bpy.types.WELKIN_PT_sky.draw(Stand(bpy.types.WELKIN_PT_sky, layout), bpy.context)
        return layout.log

    @contextlib.contextmanager
    def silence(self):
        output = io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
            yield output


class Layout:
    """Takes what a panel puts into its layout, and checks that properties and operators exist."""

    def __init__(self, log=None):
        self.__dict__["log"] = [] if log is None else log

    def __setattr__(self, name, value):
        pass

    def row(self, **_):
        return Layout(self.log)

    column = box = row

    def label(self, text="", **_):
        self.log.append(text)

    def prop(self, owner, name, **_):
        owner.bl_rna.properties[name]
        self.log.append(name)

    def operator(self, name, **_):
        group, one = name.split(".")
        getattr(getattr(bpy.ops, group), one).get_rna_type()
        self.log.append(name)


class Stand:
    """In place of the panel, of which a script cannot make one."""

    def __init__(self, panel, layout):
        self.panel, self.layout = panel, layout

    def fill(self, *arguments):
        self.panel.fill(self, *arguments)


if __name__ == "__main__":
    unittest.main()
