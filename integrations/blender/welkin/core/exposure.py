"""How bright a scene is, and what makes it neither dark nor white."""

from math import log2, pi

import numpy as np

from . import illuminance
from .errors import InputError
from .luminary import luminaries
from .settings import Settings
from .units import EFFICACY

_LUMINANCE = np.array([0.2126390, 0.7151687, 0.0721923])


def for_grey_card(settings: Settings) -> float:
    """Stops with which level ground of any reflectance has that radiance: that of 0.18 is middle grey."""
    lights = luminaries(settings.conditions, settings.moon)
    lux = sum(float(_LUMINANCE @ illuminance.total(light)) for light in lights)
    if lux <= 0.0:
        raise InputError("Nothing shines: there is no exposure for darkness")
    return log2(pi * EFFICACY / lux)
