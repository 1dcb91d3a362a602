"""What a scene keeps of its sky. Stored in the file; every change updates the sky."""

from math import pi, radians

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
    PointerProperty,
)

from . import datablocks, update


def _changed(self, context) -> None:
    update.refresh(self.id_data)


def _moon_switched(self, context) -> None:
    if self.moon and self.image is not None and self.id_data.library is None:
        datablocks.ensure_lamp(self.id_data, "moon")
    _changed(self, context)


def _angle(name: str, description: str, default: float, low: float, high: float):
    return FloatProperty(
        name=name,
        description=description,
        subtype="ANGLE",
        default=radians(default),
        min=radians(low),
        max=radians(high),
        precision=3,
        update=_changed,
    )


def _number(name: str, description: str, default: float, low: float, high: float, **more):
    return FloatProperty(
        name=name, description=description, default=default, min=low, max=high, update=_changed, **more
    )


def _whole(name: str, default: int, low: int, high: int):
    return IntProperty(name=name, default=default, min=low, max=high, update=_changed)


def _switch(name: str, description: str, default: bool = False):
    return BoolProperty(name=name, description=description, default=default, update=_changed)


class WelkinSettings(bpy.types.PropertyGroup):
    """Ranges here are wider than the model's: what it does not reach is said in the panel."""

    enabled: BoolProperty(
        name="Clear Sky", description="The sky follows the settings", default=False, update=_changed
    )
    sun_from: EnumProperty(
        name="Sun",
        description="What says where the sun stands",
        items=(
            ("ANGLES", "Angles", "Elevation and azimuth of the sun"),
            ("DATE", "Date and Place", "Date, time and place on the Earth: +X is east and +Y north"),
        ),
        default="ANGLES",
        update=_changed,
    )
    sun_elevation: _angle("Elevation", "Of the sun's centre above the horizon, without refraction", 20, -90, 90)
    sun_azimuth: FloatProperty(
        name="Azimuth",
        description="Of the sun, counter-clockwise from +X seen from above",
        subtype="ANGLE",
        default=0.0,
        soft_min=-pi,
        soft_max=pi,
        precision=3,
        update=_changed,
    )
    year: _whole("Year", 2026, 1, 9999)
    month: _whole("Month", 6, 1, 12)
    day: _whole("Day", 21, 1, 31)
    hour: _number("Time", "Hours of the day by the clock; below 0 and above 24 are other days", 12, -240, 240)
    utc_offset: _number("UTC Offset", "Hours that the clock is before UTC, with summer time", 0, -14, 14, step=50)
    latitude: _angle("Latitude", "North is positive", 48.1, -90, 90)
    longitude: _angle("Longitude", "East is positive", 11.6, -180, 180)
    north: _angle("North", "Azimuth of north, counter-clockwise from +X; 90° is +Y", 90, -360, 360)

    visibility: _number(
        "Visibility (km)",
        "Meteorological range at the ground: where black things have 2 % contrast",
        59.4,
        1,
        1000,
        soft_min=20,
        soft_max=131.8,
        precision=1,
    )
    altitude: _number(
        "Altitude (m)", "Of the observer above the ground", 0, -1e3, 1e6, soft_min=0, soft_max=15e3, precision=0
    )
    follow_camera: _switch("Add Camera Height", "Adds the height of the camera above Z = 0 to the altitude")
    albedo: _number("Ground Albedo", "Share of the light that the ground reflects", 0.2, 0, 1, precision=2)

    moon: BoolProperty(name="Moon", description="Adds the light of the moon", update=_moon_switched)
    moon_elevation: _angle("Elevation", "Of the moon's centre above the horizon", 45, -90, 90)
    moon_azimuth: _angle("Azimuth", "Of the moon, counter-clockwise from +X seen from above", 180, -360, 360)
    moon_phase: _angle("Phase Angle", "Between sun and observer, seen from the moon: 0 is full, 180° new", 1.55, 0, 180)

    exposure: _number(
        "Exposure", "Stops by which sky and lamps are brighter than 1 W for each 683 lm", 0, -40, 40, precision=2
    )
    disc: EnumProperty(
        name="Disc",
        description="What shines as the sun",
        items=(
            ("LAMP", "Sun Lamp", "A sun lamp; the map is without the disc"),
            ("MAP", "In the Map", "Some very bright pixels of the map; the lamp is dark"),
        ),
        default="LAMP",
        update=_changed,
    )
    ground: _switch("Ground Below Horizon", "Lit ground in the lower half of the map", True)
    resolution: EnumProperty(
        name="Resolution",
        description="Columns of the map; it has half as many rows",
        items=[(str(columns), f"{columns} × {columns // 2}", "") for columns in (256, 512, 1024, 2048, 4096)],
        default="1024",
        update=_changed,
    )

    image: PointerProperty(type=bpy.types.Image)
    world: PointerProperty(type=bpy.types.World)
    former_world: PointerProperty(type=bpy.types.World)
    sun_lamp: PointerProperty(type=bpy.types.Object)
    moon_lamp: PointerProperty(type=bpy.types.Object)

    air: _switch("Air", "Keeps the volume of air before the camera up to date for the compositor")
    air_far: _number(
        "Reach (m)", "How far the air is known; 0 is to the camera's clip end", 0, 0, 1e6, precision=0
    )
    air_light: PointerProperty(type=bpy.types.Image)
    air_factors: PointerProperty(type=bpy.types.Image)


CLASSES = (WelkinSettings,)
