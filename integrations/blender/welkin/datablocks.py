"""The image, the world and the lamps that belong to a scene: makes those that are missing."""

import bpy

from .images import float_image

ENVIRONMENT, BACKGROUND = "Welkin Sky", "Welkin Background"


def ensure_image(scene) -> bpy.types.Image:
    properties = scene.welkin
    if properties.image is None:
        columns = int(properties.resolution)
        properties.image = float_image("Welkin Sky", columns, columns // 2, "Linear Rec.709")
    return properties.image


def ensure_world(scene) -> bpy.types.World:
    """The scene's world becomes one of the sky; the former one is kept."""
    properties = scene.welkin
    if properties.world is None:
        properties.world = bpy.data.worlds.new("Welkin")
    if scene.world != properties.world:
        properties.former_world = scene.world
        scene.world = properties.world
    if background_of(properties.world) is None or environment_of(properties.world) is None:
        _build(properties.world)
    environment_of(properties.world).image = properties.image
    # EEVEE would make a second sun of the brightest part of the sky.
    if hasattr(properties.world, "sun_threshold"):
        properties.world.sun_threshold = 0.0
    return properties.world


def _build(world: bpy.types.World) -> None:
    if bpy.app.version < (5, 0):
        world.use_nodes = True
    tree = world.node_tree
    tree.nodes.clear()
    environment = tree.nodes.new("ShaderNodeTexEnvironment")
    background = tree.nodes.new("ShaderNodeBackground")
    output = tree.nodes.new("ShaderNodeOutputWorld")
    environment.name = environment.label = ENVIRONMENT
    background.name = background.label = BACKGROUND
    environment.projection, environment.interpolation = "EQUIRECTANGULAR", "Linear"
    environment.location, background.location, output.location = (-300, 0), (0, 0), (200, 0)
    tree.links.new(environment.outputs["Color"], background.inputs["Color"])
    tree.links.new(background.outputs["Background"], output.inputs["Surface"])


def environment_of(world):
    return _node(world, ENVIRONMENT)


def background_of(world):
    return _node(world, BACKGROUND)


def _node(world, name: str):
    tree = world.node_tree if world else None
    return tree.nodes.get(name) if tree else None


def ensure_lamp(scene, kind: str) -> bpy.types.Object:
    """The lamp of the sun or the moon, in the scene."""
    name = f"{kind}_lamp"
    lamp = getattr(scene.welkin, name)
    if lamp is None:
        label = f"Welkin {kind.capitalize()}"
        light = bpy.data.lights.new(label, "SUN")
        light.energy = 0.0
        lamp = bpy.data.objects.new(label, light)
        lamp.rotation_mode = "XYZ"
        lamp.lock_rotation = (True, True, True)
        setattr(scene.welkin, name, lamp)
    if scene.objects.get(lamp.name) != lamp:
        scene.collection.objects.link(lamp)
    return lamp


def remove(scene) -> None:
    """Takes away what was made, and brings the former world back."""
    properties = scene.welkin
    if scene.world == properties.world:
        scene.world = properties.former_world
    for name, collection in (
        ("sun_lamp", bpy.data.objects),
        ("moon_lamp", bpy.data.objects),
        ("world", bpy.data.worlds),
        ("image", bpy.data.images),
    ):
        _drop(scene, name, collection)
    properties.former_world = None


def _drop(scene, name: str, collection) -> None:
    block = getattr(scene.welkin, name)
    setattr(scene.welkin, name, None)
    # Other scenes, a copy of this one for example, may have it too.
    others = [other for other in bpy.data.scenes if other != scene and getattr(other.welkin, name) == block]
    if block is None or others:
        return
    light = getattr(block, "data", None)
    collection.remove(block)
    if isinstance(light, bpy.types.Light) and not light.users:
        bpy.data.lights.remove(light)
