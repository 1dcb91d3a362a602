"""Brings image, world and lamps of a scene up to its settings."""

import bpy
from welkin_sky import WelkinError

from . import air_update, lamps, status
from .core.errors import InputError, explain
from .core.luminary import luminaries
from .core.sky_map import sky_map
from .core.units import blender_factor
from .datablocks import background_of, environment_of
from .images import make_cycles_look, write
from .read import read_settings, sun_in_degrees


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
    try:
        settings = read_settings(evaluated, camera_height(scene, depsgraph))
        lights = luminaries(settings.conditions, settings.moon)
        _draw(scene, settings, lights)
        missing = _shine(scene, settings, lights)
        notes = missing + air_update.refresh(scene, evaluated, depsgraph, settings, lights)
    except (InputError, WelkinError) as error:
        status.fail(scene, explain(error))
    else:
        status.succeed(scene, _hints(settings, lights) + notes)


def camera_height(scene, depsgraph) -> float:
    """Of the camera above z = 0, m."""
    if scene.camera is None:
        return 0.0
    camera = scene.camera.evaluated_get(depsgraph) if depsgraph else scene.camera
    return camera.matrix_world.translation.z * scene.unit_settings.scale_length


def _draw(scene, settings, lights) -> None:
    image = scene.welkin.image
    if image is None:
        raise InputError("The image of the sky is gone: press Restore")
    if _drawn.get(image.session_uid) == settings.map():
        return
    pixels = sky_map(settings, lights)
    make_cycles_look(image)
    write(image, pixels)
    if scene.welkin.world is not None and scene.welkin.world.node_tree is not None:
        scene.welkin.world.node_tree.update_tag()
    _drawn[image.session_uid] = settings.map()


def _shine(scene, settings, lights) -> list[str]:
    """World and lamps; says what of them is missing."""
    properties, missing = scene.welkin, []
    factor = blender_factor(settings.exposure)
    background, environment = background_of(properties.world), environment_of(properties.world)
    if background is None or environment is None or scene.world != properties.world:
        missing.append("The scene has another world: press Restore")
    if background is not None:
        lamps.assign(background.inputs["Strength"], "default_value", factor)
    by_kind = {light.kind: light for light in lights}
    for kind in ("sun", "moon"):
        lamp, light = getattr(properties, f"{kind}_lamp"), by_kind.get(kind)
        if lamp is not None:
            lamps.shine(lamp, light, settings)
        wanted = light is not None and not settings.disc_in_map
        if wanted and (lamp is None or scene.objects.get(lamp.name) != lamp):
            missing.append(f"The scene is without the lamp of the {kind}: press Restore")
    return missing


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
