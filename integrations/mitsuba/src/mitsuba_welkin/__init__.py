"""The sky of welkin in Mitsuba 3: `register` tells the variant that is set of the emitter `welkin`."""

import importlib
import sys

import mitsuba as mi

_registered = {}


def register():
    """Registers the emitter with the variant of Mitsuba that is set; call it after each `mitsuba.set_variant`."""
    variant = mi.variant()
    if variant is None:
        raise ImportError("call mitsuba.set_variant before")
    if variant not in _registered:
        # Classes are made for a variant: their base is that of the variant.
        for name in ("sky_table", "sources", "emitter"):
            sys.modules.pop(f"{__name__}.{name}", None)
        emitter = importlib.import_module(".emitter", __name__)
        mi.register_emitter("welkin", emitter.WelkinSky)
        _registered[variant] = emitter.WelkinSky
    return _registered[variant]


if mi.variant() is not None:
    register()
