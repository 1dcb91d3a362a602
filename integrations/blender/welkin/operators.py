"""What the buttons of the panel do."""

import bpy
from bpy.props import BoolProperty
from welkin_sky import WelkinError

from . import air_operators, datablocks, status, update
from .core import exposure
from .core.errors import InputError, explain
from .polling import is_local
from .read import read_settings


class WELKIN_OT_add(bpy.types.Operator):
    """Give the scene a clear sky and a sun lamp; the former world is kept. Restores what of them is missing"""

    bl_idname = "welkin.add"
    bl_label = "Add Clear Sky"
    bl_options = {"REGISTER", "UNDO"}

    expose: BoolProperty(
        name="Set Exposure", description="Make a level grey card middle grey", default=True, options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context):
        return is_local(cls, context)

    def execute(self, context):
        scene = context.scene
        is_new = not datablocks.are_there(scene)
        restored = datablocks.ensure(scene)
        scene.welkin.enabled = True
        if self.expose and is_new:
            _expose(self, scene)
        update.draw_anew(scene)
        if not is_new:
            self.report({"INFO"}, f"Restored: {', '.join(restored) or 'nothing was missing'}")
        return _finish(self, scene)


class WELKIN_OT_remove(bpy.types.Operator):
    """Take sky and lamps away and bring the former world back; the settings stay"""

    bl_idname = "welkin.remove"
    bl_label = "Remove Clear Sky"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return is_local(cls, context) and datablocks.are_there(context.scene)

    def execute(self, context):
        context.scene.welkin.enabled = False
        air_operators.remove(context.scene)
        datablocks.remove(context.scene)
        return {"FINISHED"}


class WELKIN_OT_expose(bpy.types.Operator):
    """Set the exposure so that a level grey card in the light of sun, moon and sky is middle grey"""

    bl_idname = "welkin.expose"
    bl_label = "Expose for Grey Card"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return is_local(cls, context) and context.scene.welkin.enabled

    def execute(self, context):
        return _finish(self, context.scene) if _expose(self, context.scene) else {"CANCELLED"}


def _expose(operator, scene) -> bool:
    try:
        settings = read_settings(scene, update.camera_height(scene, None))
        scene.welkin.exposure = exposure.for_grey_card(settings)
    except (InputError, WelkinError) as error:
        operator.report({"WARNING"}, explain(error))
        return False
    return True


def _finish(operator, scene):
    error = status.error(scene)
    if error:
        operator.report({"WARNING"}, error)
    return {"FINISHED"}


CLASSES = (WELKIN_OT_add, WELKIN_OT_remove, WELKIN_OT_expose)
