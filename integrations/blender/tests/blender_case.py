"""Blender as a Python module with the extension installed from its zip, as a user installs it."""

import importlib
import json
import os
import subprocess
import sys
import unittest
from math import degrees, radians
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from headless import PACKAGE, WORK, bpy, extension  # noqa: E402, F401
import numpy as np  # noqa: E402

EFFICACY = 683.0


def command() -> str:
    """The welkin command, which the environment names."""
    return os.environ["WELKIN"]


def welkin_json(*options: str) -> dict:
    done = subprocess.run([command(), "light", "--json", *options], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def welkin_map(columns: int, *options: str) -> np.ndarray:
    """`welkin render --projection lat-long`: (rows, columns, 3), lowest row first."""
    target = WORK / "map"
    call = [command(), "render", "--projection", "lat-long", "--size", str(columns // 2), "--out", str(target)]
    subprocess.run([*call, *options], check=True, capture_output=True)
    return load(target.with_suffix(".exr"))


def conditions(scene) -> list[str]:
    """The options that say what the properties of a scene say."""
    sky = scene.welkin
    return [
        f"--sun-elevation={degrees(sky.sun_elevation):.6f}",
        f"--sun-azimuth={degrees(sky.sun_azimuth):.6f}",
        f"--visibility={sky.visibility:.6g}",
        f"--altitude={sky.altitude:.6g}",
        f"--albedo={sky.albedo:.6g}",
    ]


def load(path: Path) -> np.ndarray:
    image = bpy.data.images.load(str(path), check_existing=False)
    try:
        return pixels_of(image)[..., :3]
    finally:
        bpy.data.images.remove(image)


def pixels_of(image) -> np.ndarray:
    columns, rows = image.size
    pixels = np.empty(rows * columns * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(rows, columns, 4)


class BlenderCase(unittest.TestCase):
    """Each test begins with an empty file."""

    def setUp(self):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        self.scene = bpy.context.scene
        self.scene.render.engine = "CYCLES"
        self.scene.cycles.device = "CPU"
        self.scene.cycles.use_denoising = False
        self.scene.cycles.use_adaptive_sampling = False

    @property
    def sky(self):
        return self.scene.welkin

    def add(self, **properties):
        self.assertEqual(bpy.ops.welkin.add(expose=False), {"FINISHED"})
        for name, value in properties.items():
            setattr(self.sky, name, value)

    def status(self):
        return importlib.import_module(PACKAGE + ".status")

    def camera(self, kind="PERSP", location=(0, 0, 0), rotation=(90, 0, -90)):
        """Looks along +X if not told otherwise."""
        data = bpy.data.cameras.new("Camera")
        data.type = kind
        camera = bpy.data.objects.new("Camera", data)
        camera.location = location
        camera.rotation_euler = [radians(angle) for angle in rotation]
        self.scene.collection.objects.link(camera)
        self.scene.camera = camera
        return camera

    def render(self, columns, rows, samples=1, name="render") -> np.ndarray:
        """Linear pixels (rows, columns, 3), lowest row first."""
        self.prepare(columns, rows, samples)
        self.scene.render.filepath = str(WORK / name)
        bpy.ops.render.render(write_still=True)
        return load(WORK / f"{name}.exr")

    def prepare(self, columns, rows, samples):
        render = self.scene.render
        render.resolution_x, render.resolution_y, render.resolution_percentage = columns, rows, 100
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        self.scene.cycles.samples = samples
        # Rays through the centres of pixels.
        self.scene.cycles.pixel_filter_type = "BOX"
        self.scene.cycles.filter_width = 0.01

    def environment(self, columns) -> np.ndarray:
        """All directions as Cycles sees them, in cd m⁻²."""
        camera = self.camera("PANO")
        camera.data.panorama_type = "EQUIRECTANGULAR"
        picture = self.render(columns, columns // 2)
        return picture * EFFICACY / 2.0**self.sky.exposure

    def plane(self, albedo=0.5):
        """A level Lambertian plane, seen from above by a camera: its radiance tells the irradiance."""
        mesh = bpy.data.meshes.new("Plane")
        mesh.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
        material = bpy.data.materials.new("Grey")
        if bpy.app.version < (5, 0):
            material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = (albedo, albedo, albedo, 1.0)
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
        mesh.materials.append(material)
        self.scene.collection.objects.link(bpy.data.objects.new("Plane", mesh))
        self.camera(location=(0, 0, 2), rotation=(0, 0, 0))

    def irradiance(self, samples=256, albedo=0.5) -> np.ndarray:
        """Of a level plane, linear sRGB, lx."""
        self.plane(albedo)
        picture = self.render(16, 16, samples)
        return picture.mean(axis=(0, 1)) * np.pi / albedo * EFFICACY / 2.0**self.sky.exposure
