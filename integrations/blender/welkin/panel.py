"""The panel in the properties of the world."""

import bpy

from . import datablocks, lamps, status, update


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "world"


class _Part(_Panel):
    bl_parent_id = "WELKIN_PT_sky"

    @classmethod
    def poll(cls, context):
        return datablocks.are_there(context.scene)

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = True
        self.fill(layout, context.scene.welkin)


class WELKIN_PT_sky(_Panel, bpy.types.Panel):
    bl_label = "Clear Sky"

    def draw_header_preset(self, context):
        from .presets import WELKIN_PT_presets

        WELKIN_PT_presets.draw_panel_header(self.layout)

    def draw(self, context):
        layout, properties = self.layout, context.scene.welkin
        if not datablocks.are_there(context.scene):
            layout.operator("welkin.add", icon="ADD")
            return
        row = layout.row(align=True)
        row.prop(properties, "enabled", text="Follow Settings")
        row.operator("welkin.add", text="Restore", icon="FILE_REFRESH")
        row.operator("welkin.remove", text="", icon="X")
        error = update.obstacle(context.scene) or status.error(context.scene)
        if error:
            box = layout.box()
            box.alert = True
            box.label(text=error, icon="ERROR")
            box.label(text="The sky is still the one before")
        for note in status.notes(context.scene):
            layout.label(text=note, icon="INFO")


class WELKIN_PT_sun(_Part, bpy.types.Panel):
    bl_label = "Sun"

    def fill(self, layout, properties):
        layout.prop(properties, "sun_from", text="From")
        if properties.sun_from == "ANGLES":
            names = ("sun_elevation", "sun_azimuth")
        else:
            names = ("year", "month", "day", "hour", "utc_offset", "latitude", "longitude", "north")
        column = layout.column(align=True)
        for name in names:
            column.prop(properties, name)
        layout.prop(properties, "disc")
        lamp = properties.sun_lamp
        if lamp is not None and lamps.is_sun(lamp):
            layout.label(text=f"Lamp: {lamp.data.energy:.4g} W/m²", icon="LIGHT_SUN")


class WELKIN_PT_air(_Part, bpy.types.Panel):
    bl_label = "Air and Ground"

    def fill(self, layout, properties):
        for name in ("visibility", "altitude", "follow_camera", "albedo", "ground"):
            layout.prop(properties, name)


class WELKIN_PT_moon(_Part, bpy.types.Panel):
    bl_label = "Moon"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.welkin, "moon", text="")

    def fill(self, layout, properties):
        layout.active = properties.moon
        for name in ("moon_elevation", "moon_azimuth", "moon_phase"):
            layout.prop(properties, name)


class WELKIN_PT_picture(_Part, bpy.types.Panel):
    bl_label = "Exposure and Map"

    def fill(self, layout, properties):
        layout.prop(properties, "exposure")
        layout.operator("welkin.expose")
        layout.prop(properties, "resolution")


class WELKIN_PT_distance(_Part, bpy.types.Panel):
    bl_label = "Aerial Perspective"
    bl_options = {"DEFAULT_CLOSED"}

    def fill(self, layout, properties):
        if not properties.air:
            layout.operator("welkin.add_air", icon="NODE_COMPOSITING")
            return
        layout.prop(properties, "air_far")
        layout.operator("welkin.remove_air", icon="X")


CLASSES = (
    WELKIN_PT_sky,
    WELKIN_PT_sun,
    WELKIN_PT_air,
    WELKIN_PT_moon,
    WELKIN_PT_picture,
    WELKIN_PT_distance,
)
