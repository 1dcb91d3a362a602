"""Aerial perspective that Blender's compositor makes, next to the library."""

import importlib
import unittest
from math import radians

import numpy as np

from blender_case import EFFICACY, PACKAGE, WORK, BlenderCase, bpy, pixels_of

ALTITUDE = 1500.0


@unittest.skipIf(bpy.app.version < (5, 0), "the compositor lacks the nodes")
class Air(BlenderCase):
    def setUp(self):
        super().setUp()
        self.library = importlib.import_module(PACKAGE + ".core.luminary").default_model()

    def scene_of_walls(self, depths, radiance=2.0):
        """Glowing walls before a camera, each in a strip of the picture of its own; the sky above them."""
        camera = self.camera(location=(0, 0, ALTITUDE))
        camera.data.clip_end = 60e3
        material = bpy.data.materials.new("Glow")
        if bpy.app.version < (5, 0):
            material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        glow, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeOutputMaterial")
        glow.inputs["Strength"].default_value = radiance
        tree.links.new(glow.outputs["Emission"], output.inputs["Surface"])
        side = np.linspace(0.36, -0.36, len(depths) + 1)
        for depth, left, right in zip(depths, side[:-1], side[1:]):
            corners = [(depth, depth * y, ALTITUDE + depth * z) for y, z in
                       ((left, -0.2), (right, -0.2), (right, 0.1), (left, 0.1))]
            mesh = bpy.data.meshes.new("Wall")
            mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
            mesh.materials.append(material)
            self.scene.collection.objects.link(bpy.data.objects.new("Wall", mesh))
        return camera

    def centre_of(self, picture, strip, strips, row):
        """Of a strip, and the direction there (depth 1)."""
        rows, columns, _ = picture.shape
        column = int(columns * (strip + 0.5) / strips)
        y = -((column + 0.5) / columns * 2.0 - 1.0) * 0.36
        z = ((row + 0.5) / rows * 2.0 - 1.0) * 0.36 * rows / columns
        return picture[row, column], np.array([1.0, y, z])

    def start(self, depths, **properties):
        self.scene_of_walls(depths)
        self.add(altitude=ALTITUDE, sun_elevation=0.3, sun_azimuth=0.8, visibility=30.0, exposure=-3.0, **properties)

    def test_walls_at_distances(self):
        depths = [300.0, 2e3, 8e3, 20e3, 50e3]
        self.start(depths)
        bpy.ops.welkin.add_air()
        picture = self.render(160, 80)
        sun = self.library.colour_aerial_perspective(
            solar_elevation=0.3, solar_azimuth=0.8, visibility=30e3, altitude=ALTITUDE
        )
        for strip, depth in enumerate(depths):
            with self.subTest(depth=depth):
                seen, ray = self.centre_of(picture, strip, len(depths), 40)
                camera = np.array([0.0, 0.0, ALTITUDE])
                light, factors = sun.rgb(camera, camera + depth * ray)
                wanted = 2.0 * factors + light * 2.0**-3.0 / EFFICACY
                np.testing.assert_allclose(seen, wanted, atol=0.012 * wanted.max())

    def test_the_sky_stays(self):
        self.start([1e3, 30e3])
        plain = self.render(160, 80)
        bpy.ops.welkin.add_air()
        aired = self.render(160, 80)
        np.testing.assert_allclose(aired[-10:], plain[-10:], rtol=1e-4)
        self.assertGreater(np.abs(aired[40] - plain[40]).max(), 0.05)
        bpy.ops.welkin.remove_air()
        np.testing.assert_allclose(self.render(160, 80), plain, rtol=1e-4)
        self.assertFalse([image for image in bpy.data.images if "Air" in image.name])
        self.assertFalse([tree for tree in bpy.data.node_groups if "Air" in tree.name])

    def test_in_a_compositor_that_has_nodes(self):
        """What follows the render layers gets their picture with air, and is left as it was afterwards."""
        self.start([5e3, 30e3])
        tree = bpy.data.node_groups.new("Mine", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        layers, exposure = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeExposure")
        output = tree.nodes.new("NodeGroupOutput")
        exposure.inputs["Exposure"].default_value = 1.0
        tree.links.new(layers.outputs["Image"], exposure.inputs["Image"])
        tree.links.new(exposure.outputs["Image"], output.inputs["Image"])
        self.scene.compositing_node_group = tree
        before = self.render(80, 40)
        bpy.ops.welkin.add_air()
        aired = self.render(80, 40)
        self.assertEqual(len(tree.nodes), 4)
        self.assertEqual(exposure.inputs["Image"].links[0].from_node.name, "Welkin Air")
        self.assertGreater(np.abs(aired - before).max(), 0.05)
        bpy.ops.welkin.remove_air()
        self.assertEqual(exposure.inputs["Image"].links[0].from_node, layers)
        np.testing.assert_allclose(self.render(80, 40), before, rtol=1e-4)

    def test_air_follows_the_camera_of_each_frame(self):
        self.start([8e3, 30e3])
        bpy.ops.welkin.add_air()
        camera = self.scene.camera
        for frame, turn in ((1, -100.0), (2, -80.0)):
            camera.rotation_euler.z = radians(turn)
            camera.keyframe_insert("rotation_euler", frame=frame)
        self.prepare(80, 40, 1)
        self.scene.frame_start, self.scene.frame_end = 1, 2
        self.scene.render.filepath = f"{WORK}/air-"
        bpy.ops.render.render(animation=True)
        load = importlib.import_module("blender_case").load
        for frame in (1, 2):
            self.scene.frame_set(frame)
            alone = self.render(80, 40, name="alone")
            np.testing.assert_allclose(load(WORK / f"air-{frame:04}.exr"), alone, rtol=1e-4)
        light = pixels_of(self.sky.air_light)
        self.scene.frame_set(1)
        self.assertGreater(np.abs(pixels_of(self.sky.air_light) - light).max(), 0.0)

    def test_units_of_the_scene(self):
        """A scene in kilometres sees the same air."""
        self.start([8e3])
        bpy.ops.welkin.add_air()
        metres = self.render(80, 40)
        for thing in self.scene.objects:
            if thing.type == "MESH":
                thing.scale = (1e-3,) * 3
        self.scene.camera.location.z *= 1e-3
        self.scene.camera.data.clip_start, self.scene.camera.data.clip_end = 1e-3, 60.0
        self.scene.unit_settings.scale_length = 1000.0
        np.testing.assert_allclose(self.render(80, 40), metres, rtol=2e-3)

    def test_cameras_it_cannot_do(self):
        self.start([5e3])
        bpy.ops.welkin.add_air()
        self.scene.camera.data.type = "ORTHO"
        self.scene.frame_set(2)
        self.assertIn("not a perspective", " ".join(self.status().notes(self.scene)))
        self.scene.camera = None
        self.scene.frame_set(3)
        self.assertIn("no camera", " ".join(self.status().notes(self.scene)))


if __name__ == "__main__":
    unittest.main()
