"""Scenes that were copied with the settings of a sky, and so point to the image, world and lamps of the first."""

import bpy

from . import air_nodes

BLOCKS = ("image", "world", "sun_lamp", "moon_lamp", "air_light", "air_factors")


def others_with(scene, name: str) -> list:
    block = getattr(scene.welkin, name)
    if block is None:
        return []
    return [other for other in bpy.data.scenes if other != scene and getattr(other.welkin, name) == block]


def _owner(scene, name: str):
    """The scene that had the block first, if that is another. Copies come later, and after it in files."""
    earlier = [other for other in others_with(scene, name) if other.session_uid < scene.session_uid]
    return min(earlier, key=lambda other: other.session_uid, default=None)


def owner(scene):
    """Another scene to which something of this one's sky belongs."""
    found = (_owner(scene, name) for name in BLOCKS)
    return next((other for other in found if other is not None), None)


def part(scene) -> None:
    """Leaves to other scenes what is theirs."""
    properties = scene.welkin
    for name in BLOCKS:
        if _owner(scene, name) is None:
            continue
        block = getattr(properties, name)
        setattr(properties, name, None)
        if name.startswith("air"):
            properties.air = False
            _take_air_out(scene)
        take_out(scene, block)


def _take_air_out(scene) -> None:
    """Its nodes show the volume of the first scene."""
    tree = air_nodes.tree_of(scene)
    if not any(air_nodes.tree_of(other) == tree for other in bpy.data.scenes if other != scene):
        air_nodes.take_out(scene)


def take_out(scene, block) -> None:
    """Linked copies show the lamps of the first scene, too: with lamps of their own they would have two suns."""
    if isinstance(block, bpy.types.Object) and scene.collection.objects.get(block.name) == block:
        scene.collection.objects.unlink(block)
