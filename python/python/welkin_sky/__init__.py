"""The clear sky: radiance, colour, polarisation, transmittance and aerial perspective in numpy arrays.

A `Model` is opened (`default_model`, `open`), prepares a `Sky` for the `Conditions` of a scene, and the sky answers
arrays of directions::

    import numpy as np
    import welkin_sky

    model = welkin_sky.default_model()
    sky = model.sky(solar_elevation=np.radians(10.0), visibility=50e3)
    spectrum = sky.radiance_at([0.0, 0.0, 1.0], np.arange(400.0, 701.0, 5.0))     # W m⁻² sr⁻¹ nm⁻¹

Spectra are what the methods `…_at` give. Those without (`radiance`, `stokes`, `between`, `in_scattering`) give the
nodes of the model at its `wavelengths`, of which the others make spectra; within absorption bands they are not the
spectrum.

Units are SI, angles radians, wavelengths nanometres. +z is the zenith, azimuths count counter-clockwise from +x seen
from above, directions point away from the observer and need not be normalised. Arrays may have any real dtype and any
leading shape; contiguous float32 (directions) and float64 (points, conditions) are read without a copy. They must not
be changed by another thread meanwhile: evaluation runs without the interpreter's lock.
"""

from . import _native
from ._native import (
    AerialPerspective,
    BakedBandSky,
    BakedColourSky,
    BakedPolarisedSky,
    BakedSky,
    BandAerialPerspective,
    BandSky,
    BandSolarDisc,
    BandTransmittance,
    Bands,
    ColourAerialPerspective,
    ColourSky,
    JoinedAerialPerspective,
    Model,
    ModelAxis,
    Plan,
    PolarisedBandSky,
    PolarisedSky,
    Response,
    Sky,
    SkySampler,
    SkySum,
    SolarDisc,
    SunCourse,
    Transmittance,
    colour_space_matrix,
    default_model,
    from_bytes,
    open,
    stream,
)
from .conditions import Conditions, Moon
from .errors import (
    ChecksumError,
    DirectionError,
    EncodingError,
    FeatureError,
    FileMissingError,
    InvalidValueError,
    IoError,
    LengthError,
    LimitError,
    MagicError,
    MissingError,
    PointError,
    RangeError,
    ToleranceError,
    VersionError,
    WelkinError,
)
from .exposure import expose
from .grids import Grid, directions, fish_eye, lat_long
from .immutable import make_immutable
from .labelled import to_xarray
from .plots import plot
from .samples import Samples
from .stokes import angle_of_polarisation, degree_of_polarisation, through_polariser

__version__ = "0.1.0"

__all__ = [
    "AerialPerspective",
    "BakedBandSky",
    "BakedColourSky",
    "BakedPolarisedSky",
    "BakedSky",
    "BandAerialPerspective",
    "BandSky",
    "BandSolarDisc",
    "BandTransmittance",
    "Bands",
    "ChecksumError",
    "ColourAerialPerspective",
    "ColourSky",
    "Conditions",
    "DirectionError",
    "EncodingError",
    "FeatureError",
    "FileMissingError",
    "Grid",
    "InvalidValueError",
    "IoError",
    "JoinedAerialPerspective",
    "LengthError",
    "LimitError",
    "MagicError",
    "MissingError",
    "Model",
    "ModelAxis",
    "Moon",
    "Plan",
    "PointError",
    "PolarisedBandSky",
    "PolarisedSky",
    "RangeError",
    "Response",
    "Samples",
    "Sky",
    "SkySampler",
    "SkySum",
    "SolarDisc",
    "SunCourse",
    "ToleranceError",
    "Transmittance",
    "VersionError",
    "WelkinError",
    "angle_of_polarisation",
    "colour_space_matrix",
    "default_model",
    "degree_of_polarisation",
    "directions",
    "expose",
    "fish_eye",
    "from_bytes",
    "lat_long",
    "open",
    "plot",
    "stream",
    "through_polariser",
    "to_xarray",
]

# As methods, too: sky.plot(), sky.to_xarray().
_COLOURED = (Sky, BakedSky, ColourSky, BakedColourSky, PolarisedSky, BakedPolarisedSky)
_kind: type
for _kind in (*_COLOURED, SkySum):
    setattr(_kind, "plot", plot)
for _kind in (*_COLOURED, BandSky, BakedBandSky):
    setattr(_kind, "to_xarray", to_xarray)
for _kind in vars(_native).values():
    if isinstance(_kind, type):
        make_immutable(_kind)
