"""Reads welkin files: models of the radiance of the clear sky. Needs numpy only."""

from .errors import (
    ChecksumError,
    DirectionError,
    EncodingError,
    FeatureError,
    InvalidValueError,
    LengthError,
    MagicError,
    MissingError,
    RangeError,
    VersionError,
    WelkinError,
)
from .model import Model, from_bytes, open
from .sky import Conditions, Sky

__all__ = [
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
    "RangeError",
    "Sky",
    "VersionError",
    "WelkinError",
    "from_bytes",
    "open",
]
__version__ = "1.0.0"
