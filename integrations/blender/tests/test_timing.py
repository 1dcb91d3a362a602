"""How long a change of a slider takes, by stages. Of processor time, which other programs on the machine do not count
into: on one core it is what passes, on two, of which the sky takes both, less."""

import importlib
import time
import unittest
from dataclasses import replace

from blender_case import PACKAGE, BlenderCase, bpy

REPEATS = 9
MOST = 60.0


def module(name):
    return importlib.import_module(f"{PACKAGE}.{name}")


class Timing(BlenderCase):
    def measure(self, what):
        """Least processor and wall time, ms."""
        least = [float("inf"), float("inf")]
        for repeat in range(REPEATS):
            clocks = time.process_time, time.perf_counter
            started = [clock() for clock in clocks]
            what(repeat)
            passed = [1e3 * (clock() - start) for clock, start in zip(clocks, started)]
            least = [min(pair) for pair in zip(least, passed)]
        return least

    def say(self, name, times):
        print(f"{name:34} {times[0]:6.1f} ms of processors, {times[1]:6.1f} ms passed")

    def test_a_slider(self):
        self.add(resolution="1024")

        def slide(repeat):
            self.sky.sun_elevation = 0.3 + 1e-3 * repeat

        for name, altitude, disc in (
            ("on the ground", 0.0, "LAMP"),
            ("at 3000 m", 3000.0, "LAMP"),
            ("at 3000 m, disc in the map", 3000.0, "MAP"),
        ):
            self.sky.altitude, self.sky.disc = altitude, disc
            times = self.measure(slide)
            self.say(name, times)
            self.assertLess(times[0], MOST)

    def test_a_frame(self):
        self.add(resolution="1024")
        for frame, elevation in ((1, 0.05), (100, 1.0)):
            self.sky.sun_elevation = elevation
            self.sky.keyframe_insert("sun_elevation", frame=frame)
        times = self.measure(lambda repeat: self.scene.frame_set(1 + 5 * repeat))
        self.say("a frame", times)
        self.assertLess(times[0], MOST)

    def test_stages(self):
        self.add(resolution="1024", altitude=3000.0)
        luminary, sky_map, settings = module("core.luminary"), module("core.sky_map"), module("core.settings")
        grid, ground, images = module("core.grid").map_grid(512), module("core.ground"), module("images")
        conditions = [module("read").read_settings(self.scene, 0.0).conditions]

        def prepare(repeat):
            conditions.append(replace(conditions[0], solar_elevation=0.3 + 1e-3 * repeat))
            luminary.luminaries(conditions[-1], None)[0].sky()

        self.say("sky prepared and baked", self.measure(prepare))
        sun = luminary.luminaries(conditions[-1], None)[0]
        self.say("its colours, 1024 x 512", self.measure(lambda _: sun.sky().rgb(grid.directions)))
        pixels = sky_map.sky_map(settings.Settings(sun.conditions), [sun])
        self.say("the ground", self.measure(lambda _: ground.add_ground(pixels, grid, sun)))
        self.say("irradiance of the sun", self.measure(lambda _: luminary._irradiances.__wrapped__(sun)))
        self.say("pixels to Blender", self.measure(lambda _: images.write(self.sky.image, pixels)))

        def pack(_):
            images.write(self.sky.image, pixels)
            self.sky.image.pack()

        self.say("the same and packed, as for saving", self.measure(pack))

    @unittest.skipIf(bpy.app.version < (5, 0), "the compositor lacks the nodes")
    def test_air(self):
        self.camera(location=(0, 0, 1000)).data.clip_end = 50e3
        self.add(resolution="1024", altitude=1000.0)
        bpy.ops.welkin.add_air()

        def turn(repeat):
            self.scene.camera.rotation_euler.z += 0.01
            self.scene.frame_set(1 + repeat)

        self.say("a frame whose camera turns, air", self.measure(turn))


if __name__ == "__main__":
    unittest.main()
