"""Sun lamps as bright, as wide and where the discs are."""

import bpy
import numpy as np
import welkin_sky
from mathutils import Vector

from .core.units import strength_and_colour

_SPACES = {"Linear Rec.2020": "rec2020", "ACEScg": "acescg"}


def shine(lamp, luminary, settings) -> None:
    """Sets direction, angle, strength and colour. Without a luminary, or with its disc in the map, the lamp is dark."""
    if luminary is None or settings.disc_in_map:
        assign(lamp.data, "energy", 0.0)
        return
    strength, colour = strength_and_colour(_in_scene_linear(luminary.irradiance()), settings.exposure)
    assign(lamp.data, "energy", strength)
    _assign_vector(lamp.data, "color", colour)
    assign(lamp.data, "angle", 2.0 * luminary.angular_radius)
    # A lamp shines along its −Z.
    turn = Vector(luminary.direction).to_track_quat("Z", "Y").to_euler("XYZ")
    _assign_vector(lamp, "rotation_euler", turn)


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
