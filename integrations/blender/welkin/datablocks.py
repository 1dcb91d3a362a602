"""The image, the world and the lamps that belong to a scene: makes those that are missing, and mends the others.

What makes or mends says in words what it was.
"""

import bpy

from . import images, lamps, sharing, worlds

KINDS = ("sun", "moon")


def are_there(scene) -> bool:
    """Whether anything is left of a sky that was added."""
    properties = scene.welkin
    blocks = (properties.image, properties.world, properties.sun_lamp, properties.moon_lamp)
    return properties.enabled or any(block is not None for block in blocks)


def ensure(scene) -> list[str]:
    sharing.part(scene)
    done = ensure_image(scene) + ensure_world(scene)
    for kind in KINDS:
        if kind == "sun" or scene.welkin.moon:
            done += ensure_lamp(scene, kind)
    return done


def ensure_image(scene) -> list[str]:
    properties = scene.welkin
    if properties.image is None or not images.is_writable(properties.image):
        columns = int(properties.resolution)
        properties.image = images.float_image("Welkin Sky", columns, columns // 2, images.COLOUR_SPACE)
        return ["image"]
    if properties.image.colorspace_settings.name != images.COLOUR_SPACE:
        properties.image.colorspace_settings.name = images.COLOUR_SPACE
        return ["colour space of the image"]
    return []


def ensure_world(scene) -> list[str]:
    """The scene's world becomes one of the sky; the former one is kept."""
    properties, done = scene.welkin, []
    if properties.world is None:
        properties.world = bpy.data.worlds.new("Welkin")
    if scene.world != properties.world:
        worlds.change(scene, properties.world)
        done.append("world")
    if not worlds.is_whole(properties.world):
        worlds.build(properties.world)
        done = done or ["nodes of the world"]
    if not worlds.is_linked(properties.world):
        worlds.link(properties.world)
        done.append("links of the world")
    environment = worlds.environment_of(properties.world)
    if environment.image != properties.image:
        environment.image = properties.image
        done.append("image of the world")
    # EEVEE would make a second sun of the brightest part of the sky.
    if hasattr(properties.world, "sun_threshold"):
        properties.world.sun_threshold = 0.0
    return done


def ensure_lamp(scene, kind: str) -> list[str]:
    """The lamp of the sun or the moon, in the scene."""
    name, label, done = f"{kind}_lamp", f"Welkin {kind.capitalize()}", []
    lamp = getattr(scene.welkin, name)
    if lamp is None or lamp.type != "LIGHT" or lamp.library is not None:
        lamp = bpy.data.objects.new(label, lamps.new_light(label))
        lamp.rotation_mode = "XYZ"
        lamp.lock_rotation = (True, True, True)
        setattr(scene.welkin, name, lamp)
        done.append(f"lamp of the {kind}")
    if not lamps.is_sun(lamp):
        light, lamp.data = lamp.data, lamps.new_light(label)
        _discard_light(light)
        done.append(f"type of the lamp of the {kind}")
    if lamps.turned_by(lamp):
        lamps.free(lamp)
        done.append(f"direction of the lamp of the {kind}")
    if scene.objects.get(lamp.name) != lamp:
        scene.collection.objects.link(lamp)
        done = done or [f"lamp of the {kind} in the scene"]
    return done


def faults(scene) -> list[str]:
    """What is wrong with image and world, and mended by `ensure`."""
    properties = scene.welkin
    world = properties.world
    if world is None or scene.world != world or not worlds.is_whole(world):
        return ["The scene has another world: press Restore"]
    found = []
    if worlds.environment_of(world).image != properties.image:
        found.append("The world has another image: press Restore")
    if not worlds.is_linked(world):
        found.append("The links of the world are cut: press Restore")
    space = properties.image.colorspace_settings.name
    if space != images.COLOUR_SPACE:
        found.append(f"The colour space of the image is {space}, not {images.COLOUR_SPACE}: press Restore")
    return found


def remove(scene) -> None:
    """Takes away what was made, and brings the former world back."""
    properties = scene.welkin
    former = properties.former_world
    if scene.world == properties.world:
        scene.world = former
    for name, collection in (
        ("sun_lamp", bpy.data.objects),
        ("moon_lamp", bpy.data.objects),
        ("world", bpy.data.worlds),
        ("image", bpy.data.images),
    ):
        _drop(scene, name, collection)
    properties.former_world = None
    if former is not None:
        worlds.keep(former)


def _drop(scene, name: str, collection) -> None:
    block = getattr(scene.welkin, name)
    # Other scenes, a copy of this one for example, may have it too.
    others = sharing.others_with(scene, name)
    setattr(scene.welkin, name, None)
    if others:
        sharing.take_out(scene, block)
    if block is None or others:
        return
    light = getattr(block, "data", None)
    if name.endswith("lamp") and not isinstance(light, bpy.types.Light):
        return
    collection.remove(block)
    _discard_light(light)


def _discard_light(light) -> None:
    if isinstance(light, bpy.types.Light) and not light.users:
        bpy.data.lights.remove(light)
