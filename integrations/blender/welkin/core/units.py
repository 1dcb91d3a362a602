"""From photometric units to Blender's."""

EFFICACY = 683.0
"""lm/W. Blender's watts are taken to be as bright as light of 555 nm: docs/environment-maps.md."""


def blender_factor(exposure: float) -> float:
    """What cd m⁻² and lx are multiplied by to be W m⁻² sr⁻¹ and W m⁻². exposure: stops."""
    return 2.0**exposure / EFFICACY


def strength_and_colour(irradiance: tuple[float, float, float], exposure: float) -> tuple[float, tuple[float, ...]]:
    """Strength (W m⁻²) and colour, of which the largest component is 1, of a sun lamp. irradiance: RGB, lx.

    Lamps cannot take light away: a colour beyond the gamut loses its negative components.
    """
    lit = [max(component, 0.0) for component in irradiance]
    largest = max(lit)
    if largest <= 0.0:
        return 0.0, (1.0, 1.0, 1.0)
    return largest * blender_factor(exposure), tuple(component / largest for component in lit)
