"""Keeps the volume of air over the frustum of the camera up to date."""

import numpy as np

from .air_nodes import set_reach
from .core import air
from .core.units import blender_factor
from .images import write

_drawn: dict[int, tuple] = {}


def forget() -> None:
    _drawn.clear()


def refresh(scene, evaluated, depsgraph, settings, lights) -> list[str]:
    """Draws the two pictures of the volume; says why it could not."""
    properties = scene.welkin
    if not properties.air:
        return []
    problem = _problem(scene)
    if problem:
        return [f"No aerial perspective: {problem}"]
    camera = scene.camera.evaluated_get(depsgraph) if depsgraph else scene.camera
    frustum = frustum_of(evaluated, camera, _far(scene, scene.camera))
    update_reach(scene)
    key = (settings.light(), settings.exposure, frustum)
    if _drawn.get(properties.air_light.session_uid) == key:
        return []
    light, factors = air.volume(settings.conditions, lights, frustum)
    light[..., :3] *= blender_factor(settings.exposure)
    for image, pixels in ((properties.air_light, light), (properties.air_factors, factors)):
        write(image, pixels)
    _drawn[properties.air_light.session_uid] = key
    return []


def update_reach(scene) -> None:
    """Tells the nodes how far the volume reaches. A render has its own copy of them when its frame changes already:
    so this is called before, too."""
    if scene.welkin.air and scene.camera is not None:
        set_reach(scene, _far(scene, scene.camera) / scene.unit_settings.scale_length)


def _far(scene, camera) -> float:
    """m"""
    far = scene.welkin.air_far or camera.data.clip_end * scene.unit_settings.scale_length
    return min(max(far, 1.0), air.FARTHEST)


def _problem(scene) -> str | None:
    properties = scene.welkin
    if properties.air_light is None or properties.air_factors is None:
        return "its images are gone, remove and add it"
    if scene.camera is None:
        return "the scene has no camera"
    if scene.camera.data.type != "PERSP":
        return "the camera is not a perspective one"
    if scene.render.use_border and scene.render.use_crop_to_border:
        return "the render is cropped to a region"
    return None


def frustum_of(scene, camera, far: float) -> air.Frustum:
    """Of a perspective camera, with its shift and the aspect of the render. Evaluated ones for frames."""
    corners = [np.asarray(corner) for corner in camera.data.view_frame(scene=scene)]
    top_right, bottom_right, _, top_left = corners
    depth = -top_right[2]
    turn = np.asarray(camera.matrix_world.to_3x3().normalized())
    across, upward = (top_right - top_left) / 2.0, (top_right - bottom_right) / 2.0
    middle = top_right - across - upward
    axis, right, up = (tuple(turn @ (part / depth)) for part in (middle, across, upward))
    return air.Frustum(axis, right, up, far)
