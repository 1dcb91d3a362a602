"""The sky of welkin in Mitsuba 3: `register` tells the variant that is set of the emitter `welkin` and the integrator
`welkin_path`."""

import importlib
import sys

import mitsuba as mi

_registered = {}


def register():
    """Registers both with the variant of Mitsuba that is set; call it after each `mitsuba.set_variant`."""
    variant = mi.variant()
    if variant is None:
        raise ImportError("call mitsuba.set_variant before")
    if variant not in _registered:
        # Classes are made for a variant: their base is that of the variant.
        for name in [name for name in sys.modules if name.startswith(f"{__name__}.")]:
            del sys.modules[name]
        emitter = importlib.import_module(".emitter", __name__)
        integrator = importlib.import_module(".integrator", __name__)
        mi.register_emitter("welkin", emitter.WelkinSky)
        mi.register_integrator("welkin_path", integrator.WelkinPath)
        _registered[variant] = emitter.WelkinSky
    return _registered[variant]


if mi.variant() is not None:
    register()
