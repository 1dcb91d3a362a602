"""What users and other scenes do to the image, the world and the lamps: it is said, and Restore mends it."""

import contextlib
import io
import subprocess
import sys
import unittest
from math import radians

import numpy as np

from blender_case import PACKAGE, WORK, BlenderCase, bpy, load, pixels_of
from test_panel import Layout, Stand


class Repair(BlenderCase):
    def restore(self):
        self.assertEqual(bpy.ops.welkin.add(), {"FINISHED"})

    def notes(self) -> str:
        self.sky.visibility = 60.0 if self.sky.visibility != 60.0 else 61.0
        return " ".join(self.status().notes(self.scene))

    def check_mended(self):
        self.restore()
        self.assertEqual(self.notes(), "")
        self.assertIsNone(self.status().error(self.scene))

    def check_lamp(self, elevation, azimuth):
        """Where the lamp of the evaluated scene shines from."""
        bpy.context.view_layer.update()
        lamp = self.sky.sun_lamp.evaluated_get(bpy.context.evaluated_depsgraph_get())
        towards = np.array(lamp.matrix_world.to_3x3().col[2])
        level = np.cos(elevation)
        wanted = (level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation))
        np.testing.assert_allclose(towards / np.linalg.norm(towards), wanted, atol=1e-5)

    def test_ways_to_turn_the_lamp(self):
        self.add(sun_elevation=0.5, sun_azimuth=1.0, resolution="256")
        lamp = self.sky.sun_lamp
        for mode in ("QUATERNION", "AXIS_ANGLE", "ZYX"):
            lamp.rotation_mode = mode
            lamp.rotation_euler = (0.1, 0.2, 0.3)
            self.check_lamp(0.5, 1.0)
        lamp.rotation_mode = "QUATERNION"
        self.sky.sun_elevation = 0.7
        self.check_lamp(0.7, 1.0)
        lamp.delta_rotation_euler = (0.4, 0.0, 0.2)
        self.check_lamp(0.7, 1.0)

    def parent(self):
        parent = bpy.data.objects.new("Parent", None)
        self.scene.collection.objects.link(parent)
        parent.rotation_euler, parent.scale = (0.5, 0.3, 1.2), (1.0, 2.0, 0.5)
        bpy.context.view_layer.update()
        self.sky.sun_lamp.parent = parent
        return parent

    def test_a_parent(self):
        self.add(sun_elevation=0.5, sun_azimuth=1.0, resolution="256")
        parent = self.parent()
        self.check_lamp(0.5, 1.0)
        parent.rotation_euler.z = 2.0
        self.check_lamp(0.5, 1.0)
        self.sky.sun_azimuth = -2.0
        self.check_lamp(0.5, -2.0)

    def test_a_parent_that_turns_while_frames_are_rendered(self):
        self.add(sun_elevation=0.5, sun_azimuth=1.0, resolution="256")
        parent = self.parent()
        for frame in (1, 3):
            parent.rotation_euler.x = 0.4 * frame
            parent.keyframe_insert("rotation_euler", frame=frame)
        self.plane()
        self.scene.world.node_tree.links.clear()
        self.prepare(16, 16, 8)
        self.scene.frame_start, self.scene.frame_end = 1, 3
        self.scene.render.filepath = f"{WORK}/turning-"
        bpy.ops.render.render(animation=True)
        means = [load(WORK / f"turning-{frame:04}.exr").mean() for frame in (1, 2, 3)]
        self.assertGreater(means[0], 0.0)
        np.testing.assert_allclose(means, means[0], rtol=1e-4)

    def test_what_else_turns_the_lamp(self):
        self.add(sun_elevation=0.5, sun_azimuth=1.0, resolution="256")
        lamp = self.sky.sun_lamp
        lamp.constraints.new("TRACK_TO").target = self.camera(location=(3, 4, 5))
        self.assertIn("turned by a constraint", self.notes())
        self.check_mended()
        self.check_lamp(0.5, 1.0)
        lamp.rotation_euler.x = 2.0
        lamp.keyframe_insert("rotation_euler", frame=1)
        self.assertIn("turned by its animation", self.notes())
        self.check_mended()
        self.scene.frame_set(2)
        self.check_lamp(0.5, 1.0)

    def test_a_lamp_of_another_type(self):
        self.add(sun_elevation=0.5, resolution="256")
        self.sky.sun_lamp.data.type = "POINT"
        self.assertIn("The lamp of the sun is no sun lamp", self.notes())
        self.check_mended()
        self.assertEqual(self.sky.sun_lamp.data.type, "SUN")
        self.assertGreater(self.sky.sun_lamp.data.energy, 0.0)
        self.assertEqual(len(bpy.data.lights), 1)

    def test_a_mesh_in_place_of_the_lamp(self):
        self.add(resolution="256")
        mesh = bpy.data.objects.new("Mine", bpy.data.meshes.new("Mine"))
        self.scene.collection.objects.link(mesh)
        self.sky.sun_lamp = mesh
        self.assertIn("The lamp of the sun is no sun lamp", self.notes())
        self.check_mended()
        self.assertEqual(self.sky.sun_lamp.type, "LIGHT")
        self.sky.sun_lamp = mesh
        bpy.ops.welkin.remove()
        self.assertIn("Mine", self.scene.objects)

    def test_an_image_of_a_file(self):
        self.add(resolution="256")
        self.sky.image.source = "FILE"
        self.sky.sun_elevation = 0.6
        self.assertIn("is one of a file: press Restore", self.status().error(self.scene))
        self.check_mended()
        self.assertGreater(pixels_of(self.sky.image)[..., :3].max(), 100.0)
        self.assertEqual(self.scene.world.node_tree.nodes["Welkin Sky"].image, self.sky.image)

    def test_a_packed_image_goes_on(self):
        self.add(resolution="256")
        self.sky.image.pack()
        self.assertEqual(self.notes(), "")
        self.assertIsNone(self.status().error(self.scene))

    def test_a_deleted_image(self):
        self.add(resolution="256", exposure=1.5)
        bpy.data.images.remove(self.sky.image)
        layout = self.main_panel()
        self.assertIn("The image of the sky is gone: press Restore", layout)
        self.sky.sun_elevation = 0.4
        self.assertEqual(self.status().error(self.scene), "The image of the sky is gone: press Restore")
        self.check_mended()
        self.assertEqual(self.sky.exposure, 1.5)
        bpy.data.images.remove(self.sky.image)
        bpy.ops.welkin.remove()
        self.assertFalse(bpy.data.lights or bpy.data.worlds)

    def main_panel(self):
        layout = Layout()
        bpy.types.WELKIN_PT_sky.draw(Stand(bpy.types.WELKIN_PT_sky, layout), bpy.context)
        return layout.log

    def test_links_of_the_world(self):
        self.add(resolution="256")
        tree = self.scene.world.node_tree
        environment, background = tree.nodes["Welkin Sky"], tree.nodes["Welkin Background"]
        other = tree.nodes.new("ShaderNodeRGB")
        tree.links.new(other.outputs[0], background.inputs["Color"])
        self.assertIn("links of the world are cut", self.notes())
        self.check_mended()
        self.assertEqual(background.inputs["Color"].links[0].from_node, environment)
        # A node between is the user's wish.
        between = tree.nodes.new("ShaderNodeHueSaturation")
        tree.links.new(environment.outputs["Color"], between.inputs["Color"])
        tree.links.new(between.outputs["Color"], background.inputs["Color"])
        self.check_mended()
        self.assertEqual(background.inputs["Color"].links[0].from_node, between)
        tree.nodes.remove(next(node for node in tree.nodes if node.type == "OUTPUT_WORLD"))
        self.assertIn("links of the world are cut", self.notes())
        self.check_mended()
        self.assertGreater(self.environment(32).mean(), 0.0)

    def test_colour_space_and_image_of_the_world(self):
        self.add(resolution="256")
        before = pixels_of(self.sky.image)
        self.sky.image.colorspace_settings.name = "Non-Color"
        self.scene.world.node_tree.nodes["Welkin Sky"].image = None
        self.assertIn("colour space of the image is Non-Color", self.notes())
        self.assertIn("another image", self.notes())
        self.sky.visibility = 59.4
        self.check_mended()
        self.sky.visibility = 59.4
        np.testing.assert_array_equal(pixels_of(self.sky.image), before)

    def test_the_first_former_world_is_kept(self):
        first = self.scene.world = bpy.data.worlds.new("First")
        self.add(resolution="256")
        bpy.data.worlds.remove(self.sky.world)
        self.restore()
        self.assertEqual(self.sky.former_world, first)
        second = self.scene.world = bpy.data.worlds.new("Second")
        self.restore()
        self.assertEqual(self.sky.former_world, first)
        # Nothing else uses it, and it is saved all the same.
        self.assertTrue(second.use_fake_user)
        self.scene.world = bpy.data.worlds.new("Third")
        bpy.ops.welkin.remove()
        self.assertEqual(self.scene.world.name, "Third")
        bpy.ops.wm.save_as_mainfile(filepath=str(WORK / "worlds.blend"))
        bpy.ops.wm.open_mainfile(filepath=str(WORK / "worlds.blend"))
        self.assertEqual([one.name for one in bpy.data.worlds], ["First", "Second", "Third"])

    def test_copied_settings(self):
        """They do not change the first scene, and Restore gives the copy a sky of its own."""
        for kind in ("EMPTY", "LINK_COPY", "FULL_COPY"):
            with self.subTest(kind=kind):
                self.setUp()
                self.add(resolution="256", sun_elevation=0.5)
                first, image, lamp = self.scene, self.sky.image, self.sky.sun_lamp
                before, turn = pixels_of(image), tuple(lamp.rotation_euler)
                bpy.ops.scene.new(type=kind)
                copy = bpy.context.scene
                copy.welkin.sun_elevation = 1.2
                self.assertIn("is that of the scene Scene", self.status().error(copy))
                np.testing.assert_array_equal(pixels_of(image), before)
                self.assertEqual(tuple(lamp.rotation_euler), turn)
                self.restore()
                self.assertIsNone(self.status().error(copy))
                self.assertEqual(self.status().notes(copy), [])
                self.assertNotEqual(copy.welkin.image, image)
                self.assertEqual([one for one in copy.objects if one.type == "LIGHT"], [copy.welkin.sun_lamp])
                self.assertEqual(list(first.objects), [lamp])
                self.assertEqual(first.world, first.welkin.world)
                np.testing.assert_array_equal(pixels_of(image), before)
                self.assertEqual(tuple(lamp.rotation_euler), turn)

    @unittest.skipIf(bpy.app.version < (5, 0), "the air needs the compositor of 5.0")
    def test_air_of_a_copy(self):
        """The copy lets go of the first scene's volume, and can have one of its own."""
        self.add(resolution="256")
        self.camera()
        bpy.ops.welkin.add_air()
        first, light = self.scene, self.sky.air_light
        bpy.ops.scene.new(type="LINK_COPY")
        copy = bpy.context.scene
        self.restore()
        self.assertIsNone(copy.compositing_node_group.nodes.get("Welkin Air"))
        self.assertIsNotNone(first.compositing_node_group.nodes.get("Welkin Air"))
        bpy.ops.welkin.add_air()
        inside = copy.compositing_node_group.nodes["Welkin Air"].node_tree.nodes
        images = {node.image for node in inside if node.bl_idname == "CompositorNodeImage"}
        self.assertEqual(images, {copy.welkin.air_light, copy.welkin.air_factors})
        self.assertNotIn(light, images)
        self.assertEqual(first.welkin.air_light, light)

    def test_linked_scenes(self):
        self.add(resolution="256")
        path = str(WORK / "library.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        with bpy.data.libraries.load(path, link=True) as (there, here):
            here.scenes = there.scenes
        linked = here.scenes[0]
        with bpy.context.temp_override(scene=linked):
            for operator in ("add", "remove", "expose", "add_air", "remove_air"):
                self.assertFalse(getattr(bpy.ops.welkin, operator).poll(), operator)
        self.assertIsNotNone(linked.welkin.image)
        self.assertTrue(bpy.ops.welkin.add.poll())

    def test_numbers_that_are_none(self):
        self.add(resolution="256", moon=True)
        for name, bad, message in (
            ("exposure", float("nan"), "Exposure nan: the panel has -40 to 40 stops"),
            ("sun_azimuth", 1e30, "the panel has -36000 to 36000°"),
            ("sun_azimuth", float("nan"), "Azimuth nan°: the panel has"),
            ("sun_elevation", float("nan"), "levation nan"),
            ("moon_azimuth", float("nan"), "Azimuth of the moon nan°"),
            ("moon_elevation", float("nan"), "Elevation of the moon nan°"),
            ("moon_phase", float("nan"), "Phase angle of the moon nan°"),
            ("visibility", float("nan"), "Visibility nan km"),
            ("albedo", float("nan"), "lbedo nan"),
        ):
            with self.subTest(name=name, bad=bad):
                good = getattr(self.sky, name)
                before, energy = pixels_of(self.sky.image), self.sky.sun_lamp.data.energy
                setattr(self.sky, name, bad)
                self.assertIn(message, self.status().error(self.scene) or "none")
                np.testing.assert_array_equal(pixels_of(self.sky.image), before)
                self.assertEqual(self.sky.sun_lamp.data.energy, energy)
                setattr(self.sky, name, good)
                self.assertIsNone(self.status().error(self.scene))

    def test_many_turns(self):
        self.add(resolution="256", sun_azimuth=radians(30.0))
        before = pixels_of(self.sky.image)[..., :3]
        self.sky.sun_azimuth = radians(35990.0 - 320.0)
        self.assertIsNone(self.status().error(self.scene))
        after = pixels_of(self.sky.image)[..., :3]
        self.assertAlmostEqual(after.mean() / before.mean(), 1.0, delta=1e-3)


class Console(BlenderCase):
    def haze(self):
        self.add(resolution="256")
        for frame, visibility in ((1, 59.0), (5, 5.0)):
            self.sky.visibility = visibility
            self.sky.keyframe_insert("visibility", frame=frame)

    def check_lines(self, text):
        lines = [line for line in text.splitlines() if line.startswith("welkin:")]
        self.assertEqual(len(lines), len(set(lines)), lines)
        for frame in (4, 5):
            found = [line for line in lines if f"Scene, frame {frame}: Visibility" in line]
            self.assertEqual(len(found), 1, lines)
            self.assertIn("the model has 20 to 131.8 km; the sky is still the one before", found[0])
        self.assertFalse([line for line in lines if "frame 2:" in line])

    def test_animations_in_the_background(self):
        self.haze()
        self.plane()
        self.prepare(4, 4, 1)
        self.scene.frame_start, self.scene.frame_end = 1, 5
        self.scene.render.filepath = f"{WORK}/haze-"
        path = str(WORK / "haze.blend")
        self.scene.frame_set(1)
        bpy.ops.wm.save_as_mainfile(filepath=path)
        script = (
            f"import bpy; bpy.ops.preferences.addon_enable(module={PACKAGE!r}); "
            f"bpy.ops.wm.open_mainfile(filepath={path!r}); bpy.ops.render.render(animation=True)"
        )
        done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
        self.check_lines(done.stderr)

    def test_equal_messages_are_said_once(self):
        self.add(resolution="256")
        with contextlib.redirect_stderr(io.StringIO()) as output:
            self.sky.visibility = 5.0
            for frame in (2, 3, 4):
                self.scene.frame_set(frame)
            self.assertEqual(output.getvalue().count("welkin:"), 1)
            self.sky.visibility = 50.0
            self.sky.visibility = 5.0
        self.assertEqual(output.getvalue().count("welkin:"), 2)

    def test_a_lamp_that_is_gone(self):
        self.add(resolution="256")
        with contextlib.redirect_stderr(io.StringIO()) as output:
            bpy.data.objects.remove(self.sky.sun_lamp)
            self.scene.frame_set(7)
            self.scene.frame_set(8)
        self.assertEqual(
            output.getvalue().splitlines(),
            ["welkin: Scene, frame 7: The scene is without the lamp of the sun: press Restore"],
        )


if __name__ == "__main__":
    unittest.main()
