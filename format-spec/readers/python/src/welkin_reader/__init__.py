"""Reads welkin files: models of the radiance of the clear sky. Needs numpy only."""

from ._axis import Axis
from ._zstd import AVAILABLE as ZSTD
from .errors import (
    ChecksumError,
    DirectionError,
    EncodingError,
    FeatureError,
    InvalidValueError,
    LengthError,
    MagicError,
    MissingError,
    PointError,
    RangeError,
    VersionError,
    WelkinError,
)
from .model import Model, from_bytes, open
from .sky import Conditions, Sky

__all__ = [
    "Axis",
    "ChecksumError",
    "Conditions",
    "DirectionError",
    "EncodingError",
    "FeatureError",
    "InvalidValueError",
    "LengthError",
    "MagicError",
    "MissingError",
    "Model",
    "PointError",
    "RangeError",
    "Sky",
    "VersionError",
    "WelkinError",
    "ZSTD",
    "from_bytes",
    "open",
]
__version__ = "1.0.0"
