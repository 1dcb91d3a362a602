"""What Mitsuba learns for these scenes."""

import importlib
import sys

import mitsuba as mi

EMITTERS = {
    "placed_welkin": ("placed_sky", "PlacedSky"), "placed_sun": ("placed_sun", "PlacedSun"),
    "ground_level_sky": ("sky_without", "GroundLevelSky"), "unpolarised_sky": ("sky_without", "UnpolarisedSky"),
}


def register():
    """Tells the variant of Mitsuba that is set."""
    for module in ("placed_sky", "placed_sun", "sky_without", "partial_air"):
        # Classes are made for a variant: their base is that of the variant.
        sys.modules.pop(module, None)
    for name, (module, made) in EMITTERS.items():
        mi.register_emitter(name, getattr(importlib.import_module(module), made))
    mi.register_integrator("partial_air", importlib.import_module("partial_air").PartialAir)
