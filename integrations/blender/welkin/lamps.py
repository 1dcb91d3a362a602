"""Sun lamps as bright, as wide and where the discs are."""

import bpy
import numpy as np
import welkin_sky
from mathutils import Vector

from .core.units import strength_and_colour

_SPACES = {"Linear Rec.2020": "rec2020", "ACEScg": "acescg"}


_FOLLOWED = {"OBJECT", "ARMATURE"}
"""Kinds of parents that turn a lamp by their own matrix."""


def new_light(name: str) -> bpy.types.Light:
    light = bpy.data.lights.new(name, "SUN")
    light.energy = 0.0
    return light


def is_sun(lamp) -> bool:
    """Whether it is a sun lamp that can be set."""
    return lamp.type == "LIGHT" and lamp.data.type == "SUN" and lamp.library is None and lamp.data.library is None


def turned_by(lamp) -> str | None:
    """What turns the lamp after its rotation was set."""
    if any(not one.mute and one.influence > 0.0 for one in lamp.constraints):
        return "a constraint"
    if lamp.parent is not None and lamp.parent_type not in _FOLLOWED:
        return "its parent"
    data = lamp.animation_data
    if data is not None and (data.action or data.drivers or data.nla_tracks):
        return "its animation"
    return None


def free(lamp) -> None:
    """From what turns it."""
    lamp.constraints.clear()
    if lamp.parent_type not in _FOLLOWED:
        lamp.parent = None
    lamp.animation_data_clear()


def shine(lamp, luminary, settings, depsgraph) -> None:
    """Sets direction, angle, strength and colour. Without a luminary, or with its disc in the map, the lamp is dark."""
    if luminary is None or settings.disc_in_map:
        assign(lamp.data, "energy", 0.0)
        return
    strength, colour = strength_and_colour(_in_scene_linear(luminary.irradiance()), settings.exposure)
    assign(lamp.data, "energy", strength)
    _assign_vector(lamp.data, "color", colour)
    assign(lamp.data, "angle", 2.0 * luminary.angular_radius)
    _turn(lamp, Vector(luminary.direction), depsgraph)


def _turn(lamp, towards: Vector, depsgraph) -> None:
    """A lamp shines along its −Z, whatever its parent does and in whichever way it was turned before."""
    if lamp.rotation_mode != "XYZ":
        lamp.rotation_mode = "XYZ"
    _assign_vector(lamp, "delta_rotation_euler", (0.0, 0.0, 0.0))
    if lamp.parent is not None:
        parent = lamp.parent.evaluated_get(depsgraph) if depsgraph else lamp.parent
        to_world = (parent.matrix_world @ lamp.matrix_parent_inverse).to_3x3()
        towards = to_world.inverted_safe() @ towards
    _assign_vector(lamp, "rotation_euler", towards.to_track_quat("Z", "Y").to_euler("XYZ"))


def _in_scene_linear(srgb):
    """Colours of lamps are in the working space of the file."""
    colour_space = getattr(bpy.data, "colorspace", None)
    space = _SPACES.get(getattr(colour_space, "working_space", ""))
    if space is None:
        return srgb
    to_xyz = np.linalg.inv(np.asarray(welkin_sky.colour_space_matrix("srgb"), np.float64))
    return np.asarray(welkin_sky.colour_space_matrix(space), np.float64) @ to_xyz @ srgb


def assign(owner, name: str, value: float) -> None:
    """Sets what differs: what does not is no change to undo or to redraw."""
    if getattr(owner, name) != np.float32(value):
        setattr(owner, name, value)


def _assign_vector(owner, name: str, value) -> None:
    if any(a != np.float32(b) for a, b in zip(getattr(owner, name), value)):
        setattr(owner, name, value)
