"""Exceptions. Each has the error class of the format specification, section 8, as `error_class`.

What an error knows is in its attributes: a `RangeError` has `parameter`, `value`, `min`, `max` and `unit`.
"""

from typing import Any


class WelkinError(Exception):
    """Base of all errors of this package."""

    error_class = "value"

    def __init__(self, message: str = "", **attributes: Any) -> None:
        super().__init__(message)
        for name, value in attributes.items():
            setattr(self, name, value)

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class IoError(WelkinError, OSError):
    """The system refused to read a file, or the source of a streamed model failed: `errno`, `filename`, `offset`."""

    error_class = "io"


class FileMissingError(IoError, FileNotFoundError):
    """There is no such file."""


class MagicError(WelkinError, ValueError):
    """The file is not a welkin file."""

    error_class = "magic"


class VersionError(WelkinError):
    """The file has another major version."""

    error_class = "version"


class FeatureError(WelkinError):
    """The file requires a feature that this version does not know."""

    error_class = "feature"


class LengthError(WelkinError, ValueError):
    """The file is cut off, or an array has the wrong shape: `expected`, `got`."""

    error_class = "length"


class ChecksumError(WelkinError):
    """The file is damaged."""

    error_class = "checksum"


class EncodingError(WelkinError):
    """A chunk is compressed in a way that cannot be decoded."""

    error_class = "encoding"


class InvalidValueError(WelkinError, ValueError):
    """The file holds something that the format rules out, or an argument is none of the known ones."""

    error_class = "value"


class RangeError(WelkinError, ValueError):
    """A condition or wavelength outside what the model covers: `parameter`, `value`, `min`, `max`, `unit`."""

    error_class = "range"

    parameter: str
    value: float
    min: float
    max: float
    unit: str


class MissingError(WelkinError, LookupError):
    """The file lacks a chunk that the question needs: `kind`, `altitude`, `visibility`."""

    error_class = "missing"


class ToleranceError(WelkinError):
    """No table is large enough for the wanted error: `expected`, `got`."""

    error_class = "tolerance"


class LimitError(WelkinError):
    """Too much of something for fixed room."""

    error_class = "limit"


class DirectionError(WelkinError, ValueError):
    """A direction that is zero or not finite: `got`."""

    error_class = "direction"


class PointError(WelkinError, ValueError):
    """A point that is not finite, too far away, or beyond the reach of an aerial perspective: `got`."""

    error_class = "point"


_CLASSES = {
    kind.error_class: kind
    for kind in (
        IoError,
        MagicError,
        VersionError,
        FeatureError,
        LengthError,
        ChecksumError,
        EncodingError,
        InvalidValueError,
        RangeError,
        MissingError,
        ToleranceError,
        LimitError,
        DirectionError,
        PointError,
    )
}


def _of_class(error_class: str, message: str, attributes: dict[str, Any]) -> WelkinError:
    """The exception for an error of the native library."""
    kind = FileMissingError if attributes.pop("missing", False) else _CLASSES.get(error_class, WelkinError)
    return kind(message, **attributes)
