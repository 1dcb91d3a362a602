"""Where the sun stands at a time and a place, by the series of low precision for the sun's longitude.

Good to 0.02° from 1900 to 2100. There is no refraction, as the light of the model goes straight.
"""

import datetime
import math

from .errors import InputError

_J2000 = 2451545.0
_UNIX_EPOCH = 2440587.5
_DAY = 86400.0
_CENTURY = 36525.0
_PARALLAX = math.radians(8.794 / 3600.0)
YEARS = (1900, 2100)


def instant(year: int, month: int, day: int, hour: float, utc_offset: float) -> float:
    """Seconds since 1970 in UTC. hour: of the day, by a clock that is `utc_offset` hours before UTC."""
    if not YEARS[0] <= year <= YEARS[1]:
        raise InputError(f"Year {year}: the position of the sun is known from {YEARS[0]} to {YEARS[1]}")
    try:
        midnight = datetime.datetime(year, month, day, tzinfo=datetime.timezone.utc)
    except ValueError:
        raise InputError(f"There is no day {year}-{month:02}-{day:02}") from None
    return midnight.timestamp() + 3600.0 * (hour - utc_offset)


def sun(seconds: float, latitude: float, longitude: float) -> tuple[float, float]:
    """Elevation and azimuth (rad) of the sun's centre; +x is east and +y north, as azimuths count from +x.

    seconds: since 1970 in UTC; latitude, longitude: rad, north and east positive.
    """
    julian = _UNIX_EPOCH + seconds / _DAY
    right_ascension, declination, nutation = _apparent_place(julian + _delta_t(julian) / _DAY)
    hour_angle = _sidereal_time(julian) + nutation + longitude - right_ascension
    sine = math.sin(latitude) * math.sin(declination)
    sine += math.cos(latitude) * math.cos(declination) * math.cos(hour_angle)
    elevation = math.asin(max(-1.0, min(1.0, sine)))
    east = -math.cos(declination) * math.sin(hour_angle)
    north = math.cos(latitude) * math.sin(declination)
    north -= math.sin(latitude) * math.cos(declination) * math.cos(hour_angle)
    return elevation - _PARALLAX * math.cos(elevation), math.atan2(north, east) % math.tau


def _apparent_place(julian: float) -> tuple[float, float, float]:
    """Right ascension, declination and nutation in right ascension (rad) at a Julian date of terrestrial time."""
    t = (julian - _J2000) / _CENTURY
    mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032)
    anomaly = math.radians(357.52911 + t * (35999.05029 - t * 0.0001537))
    centre = (1.914602 - t * (0.004817 + t * 0.000014)) * math.sin(anomaly)
    centre += (0.019993 - 0.000101 * t) * math.sin(2.0 * anomaly) + 0.000289 * math.sin(3.0 * anomaly)
    node = math.radians(125.04 - 1934.136 * t)
    # Aberration and nutation in longitude.
    longitude = math.radians(mean_longitude + centre - 0.00569 - 0.00478 * math.sin(node))
    obliquity = math.radians(23.4392911 - 0.0130042 * t + 0.00256 * math.cos(node))
    right_ascension = math.atan2(math.cos(obliquity) * math.sin(longitude), math.cos(longitude))
    declination = math.asin(math.sin(obliquity) * math.sin(longitude))
    return right_ascension, declination, math.radians(-0.00478 * math.sin(node)) * math.cos(obliquity)


def _sidereal_time(julian: float) -> float:
    """Mean sidereal time at Greenwich, rad; of universal time."""
    days = julian - _J2000
    t = days / _CENTURY
    return math.radians((280.46061837 + 360.98564736629 * days + 0.000387933 * t * t) % 360.0)


def _delta_t(julian: float) -> float:
    """Terrestrial less universal time, s: a parabola through 1900 to 2100; half a minute is 0.0003° of the sun."""
    t = (julian - _J2000) / _CENTURY
    return 64.0 + t * (60.0 + 35.0 * t)
