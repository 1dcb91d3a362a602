"""Presets of the settings: some that come with the extension, and those of the user."""

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

_FOLDER = "welkin"
_ROOT = str(Path(__file__).parent / "data")


class WELKIN_PT_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Clear Sky Presets"
    preset_subdir = _FOLDER
    preset_operator = "script.execute_preset"
    preset_add_operator = "welkin.add_preset"


class WELKIN_OT_add_preset(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of the sky"""

    bl_idname = "welkin.add_preset"
    bl_label = "Add Clear Sky Preset"
    preset_menu = "WELKIN_PT_presets"
    preset_defines = ["sky = bpy.context.scene.welkin"]
    preset_subdir = _FOLDER
    preset_values = [
        f"sky.{name}"
        for name in (
            "sun_from sun_elevation sun_azimuth year month day hour utc_offset latitude longitude north "
            "visibility altitude albedo moon moon_elevation moon_azimuth moon_phase exposure"
        ).split()
    ]


CLASSES = (WELKIN_PT_presets, WELKIN_OT_add_preset)


def register() -> None:
    bpy.utils.register_preset_path(_ROOT)


def unregister() -> None:
    bpy.utils.unregister_preset_path(_ROOT)
