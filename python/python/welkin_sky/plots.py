"""Plots of skies with matplotlib (the extra `plot`)."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._native import colour_space_matrix
from .errors import InvalidValueError
from .exposure import expose
from .grids import fish_eye
from .stokes import degree_of_polarisation

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.floating[Any]]


def plot(
    sky: Any,
    /,
    wavelength: float | None = None,
    *,
    quantity: str = "radiance",
    size: int = 256,
    white: float | None = None,
    ax: "Axes | None" = None,
    **keywords: Any,
) -> "Axes":
    """Draws the upper hemisphere as a fish-eye, +x to the right and +y up, and returns the axes.

    wavelength: nm, for a map of radiance in false colour; without, a picture in sRGB that `expose` makes with `white`
    quantity: "radiance", or "degree" of polarisation for a polarised sky, at the wavelength or else at 550 nm
    size: pixels across; ax: axes to draw on; keywords go to `imshow`
    """
    grid = fish_eye(size)
    label, values = _values(sky, grid.visible, wavelength, quantity)
    if ax is None:
        import matplotlib.pyplot as plt

        _, ax = plt.subplots()
    extent = (-90.0, 90.0, -90.0, 90.0)
    if label is None:
        picture = grid.image(expose(values, white), outside=1.0)
        ax.imshow(picture, **{"extent": extent, "interpolation": "nearest", **keywords})
    else:
        shown = ax.imshow(grid.image(values), **{"extent": extent, **keywords})
        ax.figure.colorbar(shown, ax=ax, label=label, shrink=0.8)
    _decorate(ax, sky)
    return ax


def _values(
    sky: Any, directions: Floats, wavelength: float | None, quantity: str
) -> tuple[str | None, Floats]:
    """What is shown of directions, with the label of its scale; none for colours."""
    if quantity == "degree":
        at = 550.0 if wavelength is None else wavelength
        degree = degree_of_polarisation(_stokes_at(sky, directions, at))[..., 0]
        return f"degree of polarisation at {at:g} nm", degree
    if quantity != "radiance":
        raise InvalidValueError(f"unknown quantity {quantity!r}: known are radiance, degree")
    if wavelength is not None:
        label = f"radiance at {wavelength:g} nm, W m⁻² sr⁻¹ nm⁻¹"
        return label, _radiance_at(sky, directions, wavelength)
    return None, _linear_srgb(sky, directions)


def _radiance_at(sky: Any, directions: Floats, wavelength: float) -> Floats:
    if hasattr(sky, "radiance_at"):
        return np.asarray(sky.radiance_at(directions, wavelength))[..., 0]
    if hasattr(sky, "stokes"):
        return _stokes_at(sky, directions, wavelength)[..., 0, 0]
    raise TypeError(f"a {type(sky).__name__} does not tell wavelengths apart")


def _linear_srgb(sky: Any, directions: Floats) -> Floats:
    if hasattr(sky, "rgb"):
        return np.asarray(sky.rgb(directions))
    if hasattr(sky, "xyz_stokes"):
        xyz = np.asarray(sky.xyz_stokes(directions))[..., 0, :]
        return np.asarray(xyz @ np.transpose(colour_space_matrix("srgb")))
    raise TypeError(f"a {type(sky).__name__} has no colour: give a wavelength")


def _stokes_at(sky: Any, directions: Floats, wavelength: float) -> Floats:
    """Stokes vectors (N, 3, 1)."""
    if hasattr(sky, "stokes_at"):
        return np.asarray(sky.stokes_at(directions, wavelength))
    raise TypeError(f"a {type(sky).__name__} is not polarised")


def _decorate(ax: "Axes", sky: Any) -> None:
    ax.set(xlabel="zenith angle towards +x, °", ylabel="zenith angle towards +y, °", aspect="equal")
    ax.set_xticks([-90, -45, 0, 45, 90])
    ax.set_yticks([-90, -45, 0, 45, 90])
    for side in ax.spines.values():
        side.set_visible(False)
    conditions = getattr(sky, "conditions", None)
    if conditions is not None:
        ax.set_title(f"sun {np.degrees(conditions.solar_elevation):.1f}° high", fontsize="medium")
