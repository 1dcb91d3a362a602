"""What a picture of the sky is made for."""

from dataclasses import dataclass

from welkin_sky import Conditions, Moon


@dataclass(frozen=True)
class Settings:
    """Everything that the map and the lamps depend on: what is equal gives the same. Radians, metres, stops."""

    conditions: Conditions = Conditions()
    moon: Moon | None = None
    exposure: float = 0.0
    disc_in_map: bool = False
    ground: bool = True
    rows: int = 512

    def light(self) -> tuple:
        """What the sky depends on, but for the picture of it."""
        return (self.conditions, self.moon)

    def map(self) -> tuple:
        """What the pixels depend on: not the exposure, which is the strength of the world."""
        return (self.conditions, self.moon, self.disc_in_map, self.ground, self.rows)
