"""Registers everything, and takes everything back."""

import bpy

from . import air_operators, handlers, operators, panel, presets, properties

_CLASSES = (
    *properties.CLASSES,
    *operators.CLASSES,
    *air_operators.CLASSES,
    *presets.CLASSES,
    *panel.CLASSES,
)


def register() -> None:
    for kind in _CLASSES:
        bpy.utils.register_class(kind)
    bpy.types.Scene.welkin = bpy.props.PointerProperty(type=properties.WelkinSettings)
    handlers.register()
    presets.register()


def unregister() -> None:
    presets.unregister()
    handlers.unregister()
    del bpy.types.Scene.welkin
    for kind in reversed(_CLASSES):
        bpy.utils.unregister_class(kind)
