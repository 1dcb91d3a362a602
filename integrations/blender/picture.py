"""Renders the picture of the README: mountains, and two balls, under a low and a high sun.

    python picture.py [picture.png] [--samples 64] [--width 480]

Needs bpy and pillow, and the extension that `build` made.
"""

import argparse
import os
from math import radians
from pathlib import Path

from headless import WORK, bpy

import numpy as np
from PIL import Image

HERE = Path(__file__).resolve().parent
SIDE, CELLS = 60e3, 700
CAMERA = (0.0, 0.0, 1500.0)
SUNS = ((4.0, 115.0), (48.0, 65.0))
"""Elevation and azimuth, degrees."""


def noise(cells: int, waves: int, random) -> np.ndarray:
    """Smooth noise: a lattice of random numbers, by cubic interpolation."""
    lattice = random.uniform(-1.0, 1.0, (waves + 3, waves + 3))
    place = np.linspace(0.0, waves - 1e-6, cells)
    first, t = place.astype(int), place % 1.0
    weights = np.stack(
        [(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3], axis=-1
    ) / 6.0
    matrix = np.zeros((cells, waves + 3))
    for k in range(4):
        matrix[np.arange(cells), first + k] += weights[:, k]
    return matrix @ lattice @ matrix.T


def heights(random) -> np.ndarray:
    """Ridges, lower near the camera: (x, y)."""
    total, size = np.zeros((CELLS, CELLS)), 1.0
    for waves in (9, 18, 36, 72, 144, 288):
        total += size * (1.0 - 2.5 * np.abs(noise(CELLS, waves, random)))
        size *= 0.46
    total = (total - total.min()) / (total.max() - total.min())
    x, y = np.meshgrid(*[np.linspace(-SIDE / 2, SIDE / 2, CELLS)] * 2, indexing="ij")
    distance = np.hypot(x, y)
    return 2900.0 * total**1.6 * np.clip(distance / 12e3, 0.1, 1.0)


def material(name, colour, roughness=1.0, metallic=0.0):
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0):
        made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    shader.inputs["Roughness"].default_value = roughness
    shader.inputs["Metallic"].default_value = metallic
    shader.inputs["Specular IOR Level"].default_value = 0.5 if metallic else 0.0
    return made


def add(mesh, shader):
    mesh.materials.append(shader)
    thing = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def terrain() -> None:
    place = np.linspace(-SIDE / 2, SIDE / 2, CELLS)
    x, y = np.meshgrid(place, place, indexing="ij")
    points = np.stack([x, y, heights(np.random.default_rng(11))], -1).reshape(-1, 3)
    index = np.arange(CELLS * CELLS).reshape(CELLS, CELLS)
    corners = [index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]]
    faces = np.stack(corners, -1).reshape(-1, 4)
    mesh = bpy.data.meshes.new("Mountains")
    mesh.from_pydata(points.tolist(), [], faces.tolist())
    mesh.polygons.foreach_set("use_smooth", np.ones(len(faces), bool))
    add(mesh, material("Rock", (0.14, 0.15, 0.11)))


def ball(name, centre, radius, shader) -> None:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=radius, location=centre)
    bpy.ops.object.shade_smooth()
    thing = bpy.context.object
    thing.name = name
    thing.data.materials.append(shader)


def terrace() -> None:
    """What is near: a slab before the camera with two balls on it."""
    top = CAMERA[2] - 3.1
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(11.0, 0.0, top - 0.15), scale=(4.0, 9.0, 0.3))
    bpy.context.object.data.materials.append(material("Stone", (0.42, 0.40, 0.37)))
    ball("Mirror", (11.0, 1.9, top + 1.0), 1.0, material("Steel", (0.9, 0.9, 0.9), 0.02, 1.0))
    ball("Matt", (11.0, -1.7, top + 1.0), 1.0, material("White", (0.75, 0.75, 0.75)))


def camera() -> None:
    data = bpy.data.cameras.new("Camera")
    data.angle, data.clip_start, data.clip_end = radians(56.0), 0.1, 60e3
    thing = bpy.data.objects.new("Camera", data)
    thing.location = CAMERA
    thing.rotation_euler = (radians(84.0), 0.0, radians(-90.0))
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def render(width: int, samples: int) -> list[Path]:
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.device, scene.cycles.samples = "CYCLES", "CPU", samples
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    scene.render.resolution_x, scene.render.resolution_y = width, width * 3 // 4
    scene.render.image_settings.file_format = "PNG"
    bpy.ops.welkin.add(expose=False)
    sky = scene.welkin
    sky.visibility, sky.follow_camera, sky.albedo = 110.0, True, 0.15
    bpy.context.view_layer.update()
    bpy.ops.welkin.add_air()
    paths = []
    for number, (elevation, azimuth) in enumerate(SUNS):
        sky.sun_elevation, sky.sun_azimuth = radians(elevation), radians(azimuth)
        bpy.ops.welkin.expose()
        scene.render.filepath = str(WORK / f"sun-{number}.png")
        bpy.ops.render.render(write_still=True)
        paths.append(Path(scene.render.filepath))
    return paths


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("target", nargs="?", type=Path, default=HERE / "picture.png")
    parser.add_argument("--samples", type=int, default=24)
    parser.add_argument("--width", type=int, default=480)
    options = parser.parse_args()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    terrain()
    terrace()
    camera()
    # Twice as large and reduced: at edges the air of a pixel is that of one of the things it shows.
    paths = render(2 * options.width, options.samples)
    pictures = [np.asarray(Image.open(path).convert("RGB").reduce(2)) for path in paths]
    part = options.target.with_suffix(".part")
    Image.fromarray(np.concatenate(pictures, axis=1)).save(part, format="PNG", optimize=True)
    os.replace(part, options.target)
    print(f"{options.target}: {options.target.stat().st_size} bytes")


if __name__ == "__main__":
    main()
