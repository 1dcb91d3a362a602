"""Imports exported stages into Blender and renders them with Cycles: where the sun stands, where shadows fall, how
bright a plane is. Writes what it rendered into the folder of its argument, if there is one.

Blender 5.0 reads the angle of a distant light as a radius, so that the disc is twice as wide, and gives it four times
its irradiance; this script says so where it is, and puts both right before it renders.
"""

import math
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector

from exported import export, light, pixels, sky, sun

ALBEDO = 0.5
POSITION = (35.0, 40.0)
FOLDER = Path(sys.argv[1]) if len(sys.argv) > 1 else None


def load(folder: Path, renderer: str, *options: str) -> None:
    """An empty scene with what is exported."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # The importer makes no world, but fills one.
    bpy.context.scene.world = bpy.data.worlds.new("world")
    assert bpy.ops.wm.usd_import(filepath=str(export(folder, renderer, *options))) == {"FINISHED"}


def correct_sun() -> None:
    """Halves the angle and quarters the strength where the importer has doubled and quadrupled them."""
    lamp = next(object.data for object in bpy.data.objects if object.type == "LIGHT")
    angle, width = math.degrees(lamp.angle), light()["sun"]["angular_diameter_deg"]
    if abs(angle / width - 2.0) < 1e-3:
        print(f"blender {bpy.app.version_string}: the sun is imported {angle:.4f}° wide, and 4 times as bright")
        lamp.angle *= 0.5
        lamp.energy *= 0.25
    assert abs(math.degrees(lamp.angle) / width - 1.0) < 1e-3


def plane(size: float, height: float) -> None:
    """A level square of the known albedo."""
    bpy.ops.mesh.primitive_plane_add(size=size, location=(0, 0, height))
    material = bpy.data.materials.new("plane")
    if material.node_tree is None:
        material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (ALBEDO, ALBEDO, ALBEDO, 1)
    material.node_tree.links.new(diffuse.outputs[0], output.inputs[0])
    bpy.context.object.data.materials.append(material)


def camera(position: Vector, towards: Vector, **settings: object) -> None:
    """Up is +y for a camera that looks down."""
    data = bpy.data.cameras.new("camera")
    for name, value in settings.items():
        setattr(data, name, value)
    data.clip_end = 1e4
    object = bpy.data.objects.new("camera", data)
    object.location = position
    object.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(object)
    bpy.context.scene.camera = object


def render(path: Path, size: int, samples: int) -> np.ndarray:
    """Radiance as Cycles has it, rows from the top."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.cycles.sample_clamp_indirect = 0
    scene.cycles.max_bounces = 1
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    if FOLDER:
        (FOLDER / path.name).write_bytes(path.read_bytes())
    return pixels(path)


def check_brightness(folder: Path, renderer: str, up: str, *, has_sun: bool) -> None:
    """A level plane reflects what `welkin light` says that it gets."""
    load(folder, renderer, "--up", up, "--size", "512", *sky(*POSITION))
    described = light(*sky(*POSITION))
    correct_sun()
    if not has_sun:
        for object in [o for o in bpy.data.objects if o.type == "LIGHT"]:
            bpy.data.objects.remove(object)
    plane(100.0, 0.0)
    camera(Vector((0, 0, 10)), Vector((0, 0, -1)), type="ORTHO", ortho_scale=1.0)
    name = f"plane-{renderer}-{up}{'' if has_sun else '-sky'}.exr"
    got = render(folder / name, 16, 256).mean(axis=(0, 1)) * math.pi / ALBEDO
    key = "global_horizontal" if has_sun else "diffuse_horizontal"
    expected = np.array(described[key]["linear_srgb"])
    off = np.abs(got / expected - 1.0).max()
    print(f"{name}: {got.round(0)} lx, {expected.round(0)} expected, {100 * off:.2f} % off")
    assert off < 0.02, (renderer, up)


def check_shadow(folder: Path, renderer: str, up: str) -> None:
    """The shadow of a small square falls away from the sun."""
    load(folder, renderer, "--up", up, "--size", "128", *sky(*POSITION))
    correct_sun()
    plane(100.0, 0.0)
    height, width = 3.0, 12.0
    bpy.ops.mesh.primitive_plane_add(size=0.5, location=(0, 0, height))
    camera(Vector((0, 0, 100)), Vector((0, 0, -1)), type="ORTHO", ortho_scale=width)
    size = 240
    picture = render(folder / f"shadow-{renderer}-{up}.exr", size, 16)[..., 1]
    row, column = np.indices(picture.shape)
    x = (column + 0.5) / size * width - width / 2
    y = width / 2 - (row + 0.5) / size * width
    is_plane = np.hypot(x, y) > 0.5
    dark = is_plane & (picture < 0.6 * np.median(picture[is_plane]))
    got = np.array([x[dark].mean(), y[dark].mean()])
    direction = sun(*POSITION)
    expected = -height * direction[:2] / direction[2]
    print(f"shadow-{renderer}-{up}: at {got.round(3)}, {expected.round(3)} expected")
    assert np.abs(got - expected).max() < 0.05, (renderer, up)


def check_spot(folder: Path, renderer: str, up: str) -> None:
    """A camera that looks to the sun has the disc of the map in its middle."""
    for position in (POSITION, (5.0, -120.0)):
        load(folder, renderer, "--up", up, "--size", "1024", "--sun", *sky(*position))
        assert not any(object.type == "LIGHT" for object in bpy.data.objects)
        field, size = 6.0, 120
        camera(Vector((0, 0, 0)), Vector(sun(*position)), angle=math.radians(field))
        picture = render(folder / f"spot-{renderer}-{up}-{position[0]:.0f}.exr", size, 16)[..., 1]
        bright = np.argwhere(picture > 0.3 * picture.max()).mean(axis=0)
        off = np.hypot(*(bright - (size - 1) / 2)) * field / size
        print(f"spot-{renderer}-{up}: {off:.3f}° from the sun at {position}")
        # A pixel of the map.
        assert off < 180 / 1024, (renderer, up, position)


def main() -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for renderer, up in (("usd", "z"), ("usd", "y"), ("karma", "y")):
            check_spot(folder, renderer, up)
            check_shadow(folder, renderer, up)
            check_brightness(folder, renderer, up, has_sun=False)
        for up in "zy":
            check_brightness(folder, "usd", up, has_sun=True)


if __name__ == "__main__":
    main()
