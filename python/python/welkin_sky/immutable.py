"""What objects that never change have in common: how they are shown, copied and pickled."""

from math import degrees
from typing import Any, NoReturn

from . import _native
from .conditions import Conditions

_MADE_OF = {
    "Bands": "pickle the model and the tables of the responses",
    "Response": "pickle its table",
    "Plan": "pickle the model and the ranges",
}


def make_immutable(kind: type) -> None:
    """Copies of it are itself; it says what to pickle in its place; and it is shown by what it is about."""
    setattr(kind, "__copy__", lambda self: self)
    setattr(kind, "__deepcopy__", lambda self, memo: self)
    if kind is not _native.Model:
        setattr(kind, "__reduce__", _refuse_to_pickle)
    if "__repr__" not in vars(kind):
        setattr(kind, "__repr__", _shown)


def _refuse_to_pickle(self: Any) -> NoReturn:
    name = type(self).__name__
    instead = _MADE_OF.get(name, "pickle the Model and the Conditions, and make it anew of them")
    raise TypeError(f"a {name} cannot be pickled: {instead}")


def _shown(self: Any) -> str:
    return f"<welkin_sky.{type(self).__name__}: {', '.join(_told(self))}>"


def _told(one: Any) -> list[str]:
    """What distinguishes an object from others of its class."""
    told = []
    if isinstance(one, _native.SunCourse):
        low, high = map(degrees, one.elevations)
        told.append(f"{one.skies} skies, sun {low:.1f}° to {high:.1f}° high")
    if isinstance(one, _native.Response):
        first, last = one.range
        told.append(f"{first:g} to {last:g} nm, integral {one.integral:.6g}")
    if isinstance(one, _native.Bands):
        told.append(f"{len(one)} bands of {one.nodes.size} nodes")
    if isinstance(one, _native.SkySum):
        told.append(f"of {one.parts} of sun and moon")
    if isinstance(one, _native.JoinedAerialPerspective):
        told.append(f"camera at ({', '.join(f'{x:g}' for x in one.camera)}) m")
    if isinstance(one, (_native.SolarDisc, _native.BandSolarDisc)):
        x, y, z = one.direction
        told.append(f"towards ({x:.4f}, {y:.4f}, {z:.4f}), {'visible' if one.is_visible else 'below the horizon'}")
    conditions = getattr(one, "conditions", None)
    if conditions is not None:
        told.append(_conditions(conditions))
    bands = getattr(one, "bands", None)
    if bands is not None:
        told.append(f"{bands} bands")
    if hasattr(one, "wavelengths"):
        told.append(f"{one.wavelengths.size} nodes")
    if hasattr(one, "bytes"):
        told.append(f"{one.bytes} bytes")
    return told


def _conditions(at: Conditions) -> str:
    sun = f"sun {degrees(at.solar_elevation):.1f}° high at azimuth {degrees(at.solar_azimuth):.1f}°"
    return f"{sun}, visibility {at.visibility / 1e3:g} km, albedo {at.albedo:g}, altitude {at.altitude:g} m"
