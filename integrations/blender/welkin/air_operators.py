"""Adds aerial perspective to the compositor, and takes it away."""

import bpy

from . import air_nodes, images
from .core.air import COLUMNS, ROWS, SLICES
from .polling import is_local


class WELKIN_OT_add_air(bpy.types.Operator):
    """Add the air between camera and scene to the compositor, right behind the render layers"""

    bl_idname = "welkin.add_air"
    bl_label = "Add Air to Compositor"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if bpy.app.version < (5, 0):
            cls.poll_message_set("The compositor has the nodes from Blender 5.0 on")
            return False
        return is_local(cls, context) and context.scene.welkin.enabled and not context.scene.welkin.air

    def execute(self, context):
        scene = context.scene
        properties = scene.welkin
        for name, label, space in (
            ("air_light", "Welkin Air Light", "Linear Rec.709"),
            ("air_factors", "Welkin Air Factors", "Non-Color"),
        ):
            if getattr(properties, name) is None:
                setattr(properties, name, images.float_image(label, COLUMNS, ROWS * SLICES, space))
        for layer in scene.view_layers:
            layer.use_pass_z = layer.use_pass_environment = True
        scene.render.use_compositing = True
        if air_nodes.group_node(scene) is None:
            air_nodes.insert(scene, properties.air_light, properties.air_factors)
        properties.air = True
        return {"FINISHED"}


class WELKIN_OT_remove_air(bpy.types.Operator):
    """Take the air out of the compositor; its other nodes stay"""

    bl_idname = "welkin.remove_air"
    bl_label = "Remove Air"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return is_local(cls, context) and context.scene.welkin.air

    def execute(self, context):
        remove(context.scene)
        return {"FINISHED"}


def remove(scene) -> None:
    properties = scene.welkin
    properties.air = False
    air_nodes.take_out(scene)
    for name in ("air_light", "air_factors"):
        image = getattr(properties, name)
        setattr(properties, name, None)
        if image is not None and not image.users:
            bpy.data.images.remove(image)


CLASSES = (WELKIN_OT_add_air, WELKIN_OT_remove_air)
