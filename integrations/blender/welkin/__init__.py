"""The clear sky of welkin in Blender."""


def register() -> None:
    # Not at the top: what knows nothing of Blender can be imported without it.
    from . import addon

    addon.register()


def unregister() -> None:
    from . import addon

    addon.unregister()
