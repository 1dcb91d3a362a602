"""When Blender says that something changed.

`frame_change_post` comes before every frame that is rendered, still or animated, with the depsgraph of the render, as
well as when the frame changes on the screen. None of these pushes a step to undo.
"""

import bpy
from bpy.app.handlers import persistent

from . import air_update, update


@persistent
def _frame_changed(scene, depsgraph) -> None:
    update.refresh(scene, depsgraph)


@persistent
def _depsgraph_updated(scene, depsgraph) -> None:
    """The camera was moved by hand, or a lamp turned."""
    properties = scene.welkin
    if not properties.enabled:
        return
    watched = [properties.sun_lamp, properties.moon_lamp]
    if properties.follow_camera:
        watched.append(scene.camera)
    if any(one.is_updated_transform and one.id.original in watched for one in depsgraph.updates):
        update.refresh(scene, depsgraph)


@persistent
def _rendering(scene, *_) -> None:
    air_update.update_reach(scene.original)


@persistent
def _replaced(*_) -> None:
    """A file was opened, or a step undone or redone: pixels of images are not part of steps."""
    update.forget()
    update.refresh_all()


@persistent
def _saving(*_) -> None:
    """The file must open without this extension, too."""
    for scene in bpy.data.scenes:
        properties = scene.welkin
        for image in (properties.image, properties.air_light, properties.air_factors):
            if image is not None and image.is_dirty:
                image.pack()


_HANDLERS = {
    "frame_change_post": _frame_changed,
    "depsgraph_update_post": _depsgraph_updated,
    "render_pre": _rendering,
    "load_post": _replaced,
    "undo_post": _replaced,
    "redo_post": _replaced,
    "save_pre": _saving,
}


def register() -> None:
    for name, handler in _HANDLERS.items():
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    for name, handler in _HANDLERS.items():
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)
    update.forget()
