"""Skies as labelled data sets of xarray (the extra `xarray`)."""

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .grids import directions

if TYPE_CHECKING:
    import xarray

_RADIANCE = {
    "long_name": "spectral radiance",
    "units": "W m-2 sr-1 nm-1",
    "comment": "of radiance_at or stokes_at: true within absorption bands too, where radiance and stokes, the nodes of "
    "the model, are not",
}


def to_xarray(
    sky: Any,
    /,
    elevation: ArrayLike | None = None,
    azimuth: ArrayLike | None = None,
    wavelengths: ArrayLike | None = None,
) -> "xarray.Dataset":
    """A sky on a grid of elevations (E,) and azimuths (A,), rad, as a data set with units in its attributes.

    Every degree of elevation from the horizon up and every five degrees of azimuth if not given. What the data set has
    depends on the sky: `radiance` (elevation, azimuth, wavelength or band), `stokes` (elevation, azimuth, component,
    wavelength), `xyz` (elevation, azimuth, primary). wavelengths: nm, (K,), in place of those of the model. Spectra
    are those of `radiance_at` and `stokes_at`, also at the wavelengths of the model.
    """
    import xarray

    if elevation is None:
        elevation = np.radians(np.arange(91.0))
    if azimuth is None:
        azimuth = np.radians(np.arange(0.0, 360.0, 5.0))
    elevation = np.atleast_1d(np.asarray(elevation, dtype=np.float64))
    azimuth = np.atleast_1d(np.asarray(azimuth, dtype=np.float64))
    towards = directions(elevation[:, None], azimuth)
    data = xarray.Dataset(attrs=asdict(sky.conditions))
    data.coords["elevation"] = ("elevation", elevation, {"units": "rad", "long_name": "elevation"})
    data.coords["azimuth"] = (
        "azimuth",
        azimuth,
        {"units": "rad", "long_name": "azimuth, counter-clockwise from +x seen from above"},
    )
    _add_spectra(data, sky, towards, wavelengths)
    _add_colours(data, sky, towards)
    return data


def _add_spectra(data: Any, sky: Any, towards: NDArray[np.float32], wavelengths: ArrayLike | None) -> None:
    place = ("elevation", "azimuth")
    if hasattr(sky, "bands"):
        data["radiance"] = ((*place, "band"), sky.radiance(towards))
        return
    if not hasattr(sky, "wavelengths"):
        return
    at = sky.wavelengths if wavelengths is None else np.atleast_1d(np.asarray(wavelengths, float))
    units = {"units": "nm", "long_name": "wavelength"}
    data.coords["wavelength"] = ("wavelength", at, units)
    if hasattr(sky, "stokes"):
        data["stokes"] = ((*place, "component", "wavelength"), sky.stokes_at(towards, at), _RADIANCE)
        data.coords["component"] = ("component", ["I", "Q", "U"])
        return
    data["radiance"] = ((*place, "wavelength"), sky.radiance_at(towards, at), _RADIANCE)


def _add_colours(data: Any, sky: Any, towards: NDArray[np.float32]) -> None:
    if hasattr(sky, "xyz"):
        name = {"units": "cd m-2", "long_name": "CIE 1931 XYZ"}
        data["xyz"] = (("elevation", "azimuth", "primary"), sky.xyz(towards), name)
        data.coords["primary"] = ("primary", ["X", "Y", "Z"])
