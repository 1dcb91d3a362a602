"""From the properties of a scene to settings of the core."""

from math import degrees, pi, radians

from welkin_sky import Conditions, Moon

from .core import almanac
from .core.errors import InputError
from .core.settings import Settings

_STOPS = 40.0
_LARGEST_ANGLE = radians(36000.0)
"""Single precision has 0.004° there."""


def read_settings(scene, camera_height: float) -> Settings:
    """The settings of a scene, which may be an evaluated one. Raises `InputError`.

    camera_height: of the camera above z = 0, m.
    """
    properties = scene.welkin
    elevation, azimuth = _sun(properties)
    _check_angle("Azimuth", azimuth)
    conditions = Conditions(
        solar_elevation=elevation,
        solar_azimuth=azimuth,
        visibility=1e3 * _exact(properties.visibility),
        albedo=_exact(properties.albedo),
        altitude=_exact(properties.altitude) + (camera_height if properties.follow_camera else 0.0),
    )
    return Settings(
        conditions=conditions,
        moon=_moon(properties) if properties.moon else None,
        exposure=_exposure(properties.exposure),
        disc_in_map=properties.disc == "MAP",
        ground=properties.ground,
        rows=int(properties.resolution) // 2,
    )


def _sun(properties) -> tuple[float, float]:
    if properties.sun_from == "ANGLES":
        return _exact(properties.sun_elevation), _exact(properties.sun_azimuth)
    seconds = almanac.instant(
        properties.year, properties.month, properties.day, properties.hour, properties.utc_offset
    )
    elevation, azimuth = almanac.sun(seconds, properties.latitude, properties.longitude)
    return elevation, azimuth + properties.north - pi / 2


def _moon(properties) -> Moon:
    angles = (properties.moon_elevation, properties.moon_azimuth, properties.moon_phase)
    for name, angle in zip(("Elevation", "Azimuth", "Phase angle"), angles):
        _check_angle(f"{name} of the moon", angle)
    return Moon(*map(_exact, angles))


def _check_angle(name: str, angle: float) -> None:
    """Ranges of the model are its own to check; this is for what is no angle, or so many turns that none is left."""
    if not abs(angle) <= _LARGEST_ANGLE:
        limit = degrees(_LARGEST_ANGLE)
        raise InputError(f"{name} {degrees(angle):.6g}°: the panel has {-limit:.0f} to {limit:.0f}°")


def _exposure(stops: float) -> float:
    if not abs(stops) <= _STOPS:
        raise InputError(f"Exposure {stops:.6g}: the panel has {-_STOPS:.0f} to {_STOPS:.0f} stops")
    return stops


def _exact(value: float) -> float:
    """The number that was typed: Blender keeps 24 bits of it, and 131.8 would be beyond a range that ends there."""
    return float(f"{value:.7g}")


def sun_in_degrees(settings: Settings) -> tuple[float, float]:
    conditions = settings.conditions
    return degrees(conditions.solar_elevation), degrees(conditions.solar_azimuth) % 360.0
