"""Brings image, world and lamps of a scene up to its settings."""

import bpy
from welkin_sky import WelkinError

from . import air_update, datablocks, images, lamps, sharing, status
from .core.errors import InputError, explain
from .core.luminary import luminaries
from .core.sky_map import sky_map
from .core.units import blender_factor
from .read import read_settings, sun_in_degrees
from .worlds import background_of


_drawn: dict[int, tuple] = {}
"""What the pixels of each image were made for."""


def forget() -> None:
    """Other pixels may be in the images: a file was opened, or a step undone."""
    _drawn.clear()
    air_update.forget()
    status.clear()


def refresh(scene, depsgraph=None) -> None:
    """The sky of a scene by its settings; those of the frame if there is a depsgraph, animation and all.

    What is wrong with them is kept for the panel, and the sky stays as it was.
    """
    scene = scene.original
    if not scene.welkin.enabled or scene.library is not None:
        return
    evaluated = scene.evaluated_get(depsgraph) if depsgraph else scene
    frame = evaluated.frame_current if depsgraph else None
    try:
        problem = obstacle(scene)
        if problem:
            raise InputError(problem)
        settings = read_settings(evaluated, camera_height(scene, depsgraph))
        lights = luminaries(settings.conditions, settings.moon)
        _draw(scene, settings, lights)
        faults = datablocks.faults(scene) + _shine(scene, settings, lights, depsgraph)
        faults += air_update.refresh(scene, evaluated, depsgraph, settings, lights)
    except (InputError, WelkinError) as error:
        status.fail(scene, explain(error), frame)
    else:
        status.succeed(scene, _hints(settings, lights), faults, frame)


def obstacle(scene) -> str | None:
    """Why no settings at all could be followed; Restore mends it."""
    image = scene.welkin.image
    if image is None:
        return "The image of the sky is gone: press Restore"
    other = sharing.owner(scene)
    if other is not None:
        return f"The sky is that of the scene {other.name}: press Restore for one of its own"
    if not images.is_writable(image):
        return "The image of the sky is one of a file: press Restore"
    return None


def draw_anew(scene) -> None:
    """Whatever the pixels were made for."""
    _drawn.pop(scene.welkin.image.session_uid, None)
    refresh(scene)


def camera_height(scene, depsgraph) -> float:
    """Of the camera above z = 0, m."""
    if scene.camera is None:
        return 0.0
    camera = scene.camera.evaluated_get(depsgraph) if depsgraph else scene.camera
    return camera.matrix_world.translation.z * scene.unit_settings.scale_length


def _draw(scene, settings, lights) -> None:
    image = scene.welkin.image
    if _drawn.get(image.session_uid) == settings.map():
        return
    pixels = sky_map(settings, lights)
    images.make_cycles_look(image)
    images.write(image, pixels)
    if scene.welkin.world is not None and scene.welkin.world.node_tree is not None:
        scene.welkin.world.node_tree.update_tag()
    _drawn[image.session_uid] = settings.map()


def _shine(scene, settings, lights, depsgraph) -> list[str]:
    """World and lamps; says which lamps are not as they should be."""
    properties, faults = scene.welkin, []
    factor = blender_factor(settings.exposure)
    background = background_of(properties.world)
    if background is not None:
        lamps.assign(background.inputs["Strength"], "default_value", factor)
    by_kind = {light.kind: light for light in lights}
    for kind in datablocks.KINDS:
        lamp, light = getattr(properties, f"{kind}_lamp"), by_kind.get(kind)
        if lamp is not None and lamps.is_sun(lamp):
            lamps.shine(lamp, light, settings, depsgraph)
        if light is not None and not settings.disc_in_map:
            faults += _lamp_faults(scene, lamp, kind)
    return faults


def _lamp_faults(scene, lamp, kind: str) -> list[str]:
    if lamp is None or scene.objects.get(lamp.name) != lamp:
        return [f"The scene is without the lamp of the {kind}: press Restore"]
    if not lamps.is_sun(lamp):
        return [f"The lamp of the {kind} is no sun lamp of this file: press Restore"]
    other = lamps.turned_by(lamp)
    return [f"The lamp of the {kind} is turned by {other}: press Restore"] if other else []


def _hints(settings, lights) -> list[str]:
    hints = []
    kinds = {light.kind for light in lights}
    if "sun" not in kinds:
        hints.append(f"The sun, at {sun_in_degrees(settings)[0]:.1f}°, is too low to give light")
    if settings.moon is not None and "moon" not in kinds:
        hints.append("The moon is too low to give light")
    return hints


def refresh_all() -> None:
    for scene in bpy.data.scenes:
        refresh(scene)
