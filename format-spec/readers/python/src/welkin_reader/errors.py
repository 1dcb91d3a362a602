"""Exceptions. Each has the error class of section 8 of the specification as `error_class`."""


class WelkinError(Exception):
    """Base of all errors of this package."""

    error_class = "value"


class MagicError(WelkinError):
    """The file is not a welkin file."""

    error_class = "magic"


class VersionError(WelkinError):
    """The file has another major version."""

    error_class = "version"


class FeatureError(WelkinError):
    """The file requires a feature that this reader does not know."""

    error_class = "feature"


class LengthError(WelkinError):
    """The file is cut off, or has bytes too many."""

    error_class = "length"


class ChecksumError(WelkinError):
    """The file is damaged."""

    error_class = "checksum"


class EncodingError(WelkinError):
    """A chunk is compressed in a way that this reader cannot decode."""

    error_class = "encoding"


class InvalidValueError(WelkinError, ValueError):
    """The file holds something that the format rules out, or numbers that overflow."""

    error_class = "value"


class RangeError(WelkinError, ValueError):
    """A condition or wavelength outside what the file covers."""

    error_class = "range"


class MissingError(WelkinError, LookupError):
    """The file lacks a chunk that the question needs."""

    error_class = "missing"


class DirectionError(WelkinError, ValueError):
    """A direction that is zero or not finite."""

    error_class = "direction"


class PointError(WelkinError, ValueError):
    """An end of a segment that is not finite or farther than 1e9 m away."""

    error_class = "point"
