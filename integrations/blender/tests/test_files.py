"""What lives longer than a change of a slider: files, steps of undo, frames."""

import subprocess
import sys
import unittest
from math import radians

import numpy as np

from blender_case import PACKAGE, WORK, BlenderCase, bpy, load, pixels_of


class Files(BlenderCase):
    def test_saved_files_reopen(self):
        self.add(sun_elevation=0.1, resolution="256", sun_azimuth=2.0, visibility=30.0, exposure=-1.0)
        self.environment(256)
        energy, before = self.sky.sun_lamp.data.energy, self.render(256, 128)
        path = str(WORK / "saved.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        bpy.ops.wm.open_mainfile(filepath=path)
        self.scene = bpy.context.scene
        self.assertEqual(self.sky.sun_lamp.data.energy, energy)
        np.testing.assert_array_equal(self.render(256, 128), before)
        # And goes on living.
        self.sky.sun_elevation = 0.4
        self.assertGreater(np.abs(self.render(256, 128) - before).max(), 1.0)

    def test_files_open_without_the_extension(self):
        self.add(sun_elevation=0.2, resolution="256", disc="MAP")
        before = pixels_of(self.sky.image)
        self.assertGreater(before.max(), 65504.0)
        path = str(WORK / "plain.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.preferences.addon_disable(module=PACKAGE)
        try:
            bpy.ops.wm.open_mainfile(filepath=path)
            np.testing.assert_array_equal(pixels_of(bpy.data.images["Welkin Sky"]), before)
            self.assertIsNotNone(bpy.context.scene.world.node_tree.nodes["Welkin Sky"].image)
        finally:
            bpy.ops.preferences.addon_enable(module=PACKAGE)

    def test_a_file_that_was_not_packed_is_drawn_anew(self):
        """As files that Blender saves by itself."""
        self.add(sun_elevation=0.2, resolution="256")
        before = pixels_of(self.sky.image)
        handlers, saved = bpy.app.handlers.save_pre, list(bpy.app.handlers.save_pre)
        handlers.clear()
        path = str(WORK / "unpacked.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        handlers.extend(saved)
        bpy.ops.wm.open_mainfile(filepath=path)
        self.scene = bpy.context.scene
        np.testing.assert_array_equal(pixels_of(self.sky.image), before)

    def test_undo_and_redo(self):
        bpy.ops.ed.undo_push(message="empty")
        self.add(sun_elevation=0.2, resolution="256")
        bpy.ops.ed.undo_push(message="added")
        first, energy = pixels_of(self.sky.image), self.sky.sun_lamp.data.energy
        self.sky.sun_elevation = 0.9
        bpy.ops.ed.undo_push(message="sun higher")
        second = pixels_of(self.sky.image)
        self.assertGreater(np.abs(first - second).max(), 100.0)
        # Frames and renders must not push steps of their own.
        self.scene.frame_set(5)
        bpy.ops.ed.undo()
        self.scene = bpy.context.scene
        self.assertAlmostEqual(self.sky.sun_elevation, 0.2, places=6)
        np.testing.assert_array_equal(pixels_of(self.sky.image), first)
        self.assertEqual(self.sky.sun_lamp.data.energy, energy)
        bpy.ops.ed.redo()
        self.scene = bpy.context.scene
        self.assertAlmostEqual(self.sky.sun_elevation, 0.9, places=6)
        np.testing.assert_array_equal(pixels_of(self.sky.image), second)
        bpy.ops.ed.undo()
        bpy.ops.ed.undo()
        self.scene = bpy.context.scene
        self.assertIsNone(self.sky.image)
        self.assertEqual(len(self.scene.objects), 0)

    def animate(self):
        self.add(resolution="256")
        for frame, elevation, exposure in ((1, -4.0, 4.0), (3, 12.0, -2.0)):
            self.sky.sun_elevation, self.sky.exposure = radians(elevation), exposure
            self.sky.keyframe_insert("sun_elevation", frame=frame)
            self.sky.keyframe_insert("exposure", frame=frame)

    def test_frames_on_the_screen(self):
        self.animate()
        seen = []
        for frame in (1, 2, 3):
            self.scene.frame_set(frame)
            seen.append((pixels_of(self.sky.image)[..., :3].max(), self.sky.sun_lamp.data.energy))
        self.assertEqual(seen[0][1], 0.0)
        self.assertTrue(seen[0][0] < seen[1][0] < seen[2][0])
        self.assertGreater(seen[2][1], 0.0)

    def test_rendered_animation(self):
        """Every frame of an animation that is rendered is what the frame alone is."""
        self.animate()
        self.plane()
        self.prepare(16, 16, 64)
        for persistent in (False, True):
            with self.subTest(persistent=persistent):
                self.scene.render.use_persistent_data = persistent
                self.check_frames(lambda: bpy.ops.render.render(animation=True), f"kept {persistent}")

    def test_animation_in_the_background(self):
        """The same by another process, as `blender -b file -a` does."""
        self.animate()
        self.plane()
        self.prepare(16, 16, 64)
        path = WORK / "animated.blend"
        self.check_frames(lambda: self.background(path), "in the background", path)

    def check_frames(self, render, name, path=None):
        folder = WORK / name.replace(" ", "-")
        self.scene.frame_start, self.scene.frame_end = 1, 3
        self.scene.render.filepath = f"{folder}/"
        if path:
            bpy.ops.wm.save_as_mainfile(filepath=str(path))
        render()
        self.scene = bpy.context.scene
        self.scene.render.use_persistent_data = False
        for frame in (1, 2, 3):
            self.scene.frame_set(frame)
            self.scene.render.filepath = str(WORK / "alone")
            bpy.ops.render.render(write_still=True)
            animated, alone = load(folder / f"{frame:04}.exr"), load(WORK / "alone.exr")
            self.assertGreater(alone.mean(), 0.0)
            np.testing.assert_allclose(animated, alone, rtol=1e-5)

    def background(self, path):
        script = (
            "import bpy; "
            f"bpy.ops.preferences.addon_enable(module={PACKAGE!r}); "
            f"bpy.ops.wm.open_mainfile(filepath={str(path)!r}); "
            "bpy.ops.render.render(animation=True)"
        )
        subprocess.run([sys.executable, "-c", script], check=True, capture_output=True)


if __name__ == "__main__":
    unittest.main()
