"""Conditions of a scene, and the moon."""

from dataclasses import dataclass, replace
from math import cos, radians, sin

from . import _native


@dataclass(frozen=True, kw_only=True)
class Conditions:
    """Where the observer is, where the sun stands and what the air and the ground are like. Radians, metres.

    solar_elevation: geometric, of the sun's centre above the observer's horizontal plane
    solar_azimuth: counter-clockwise from +x seen from above
    visibility: horizontal meteorological range at the ground: where black things have 2 % contrast at 550 nm, so that
        the extinction coefficient of the air there is 3.912 / visibility
    albedo: 0 to 1, of the ground, the same at all wavelengths
    altitude: of the observer above the ground; from −500 up to 0 it counts as 0
    """

    solar_elevation: float = radians(20.0)
    solar_azimuth: float = 0.0
    visibility: float = 59.4e3
    albedo: float = 0.2
    altitude: float = 0.0

    @property
    def sun_direction(self) -> tuple[float, float, float]:
        """Unit vector towards the sun's centre."""
        return _unit_vector(self.solar_elevation, self.solar_azimuth)


@dataclass(frozen=True)
class Moon:
    """The moon, where it stands and how much of it is lit. Radians, metres.

    elevation: geometric, of its centre above the observer's horizontal plane
    azimuth: counter-clockwise from +x seen from above
    phase_angle: between the sun and the observer as seen from the moon; 0 is full, π new
    distance: of its centre from the observer, 3.4e8 to 4.2e8
    """

    elevation: float = radians(45.0)
    azimuth: float = 0.0
    phase_angle: float = radians(1.55)
    distance: float = 384_400e3

    @property
    def direction(self) -> tuple[float, float, float]:
        """Unit vector towards its centre."""
        return _unit_vector(self.elevation, self.azimuth)

    def conditions(self, conditions: Conditions) -> Conditions:
        """The conditions of the air that the moon lights: it stands where the sun does in `conditions`.

        For `Model.moonlit`.
        """
        return replace(conditions, solar_elevation=self.elevation, solar_azimuth=self.azimuth)

    @staticmethod
    def phase_angle_between(
        moon: tuple[float, float, float], sun: tuple[float, float, float]
    ) -> float:
        """The phase angle (rad) of a moon at mean distance in a direction, with the sun in another."""
        return _native.phase_angle_between(moon, sun)


def _unit_vector(elevation: float, azimuth: float) -> tuple[float, float, float]:
    return (cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation))
