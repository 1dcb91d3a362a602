"""What is wrong with what was asked for, in words for the panel."""

import math


class InputError(Exception):
    """A setting beyond what is possible; the message names it, its value and the range."""


def explain(error: Exception) -> str:
    """One line on an error of the model, in the units of the panel."""
    name = getattr(error, "parameter", None)
    if name is None:
        return str(error)
    scale, unit = _UNITS.get(name, (1.0, ""))
    label = name.replace("_", " ").capitalize()
    value, low, high = (scale * getattr(error, part) for part in ("value", "min", "max"))
    return f"{label} {value:.6g}{unit}: the model has {low:.6g} to {high:.6g}{unit}"


_DEGREE = 180.0 / math.pi
_UNITS = {
    "visibility": (1e-3, " km"),
    "altitude": (1.0, " m"),
    "solar_elevation": (_DEGREE, "°"),
    "elevation": (_DEGREE, "°"),
    "phase_angle": (_DEGREE, "°"),
}
