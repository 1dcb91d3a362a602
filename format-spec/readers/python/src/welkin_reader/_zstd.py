"""Chunks compressed with zstd (encoding 1): by whichever decoder is there."""

from ._head import require
from .errors import EncodingError, InvalidValueError

try:
    from compression import zstd as _standard  # Python 3.14
except ImportError:
    try:
        from backports import zstd as _standard
    except ImportError:
        _standard = None
try:
    import zstandard as _package
except ImportError:
    _package = None

AVAILABLE = _standard is not None or _package is not None

_MAGIC = bytes([0x28, 0xB5, 0x2F, 0xFD])
_WIDEST_WINDOW = 27 - 10 << 3
"""Window_Descriptor of 2^27 bytes, the most that decoders of streams take; smaller windows are smaller numbers."""


def decompress(stored, raw_length):
    """The payload: one frame that declares its length and fills the stored bytes."""
    if not AVAILABLE:
        raise EncodingError("compressed chunks need Python 3.14, backports.zstd or zstandard")
    stored = bytes(stored)
    _check_header(stored, raw_length)
    if _standard:
        decoder, failure = _standard.ZstdDecompressor(), _standard.ZstdError
    else:
        decoder, failure = _package.ZstdDecompressor().decompressobj(), _package.ZstdError
    try:
        payload = decoder.decompress(stored)
    except failure as error:
        raise InvalidValueError("a broken zstd frame") from error
    require(decoder.eof, "a zstd frame ends early")
    require(not decoder.unused_data, "bytes after a zstd frame")
    require(len(payload) == raw_length, "a zstd frame has another length than raw_length")
    return payload


def _check_header(stored, raw_length):
    """RFC 8878, section 3.1.1.1: the length is declared before anything is allocated for it."""
    require(len(stored) > 6, "a zstd frame is too short")
    require(stored[:4] == _MAGIC, "not a zstd frame")
    descriptor = stored[4]
    single_segment = descriptor >> 5 & 1
    require(single_segment or stored[5] <= _WIDEST_WINDOW, "a zstd frame needs more than 128 MiB")
    dictionary = 6 - single_segment
    start = dictionary + (0, 1, 2, 4)[descriptor & 3]
    require(not any(stored[dictionary:start]), "a zstd frame with a dictionary")
    flag = descriptor >> 6
    length = (single_segment, 2, 4, 8)[flag]
    require(length > 0, "a zstd frame without its content size")
    require(len(stored) >= start + length, "a zstd frame is too short")
    size = int.from_bytes(stored[start : start + length], "little") + (256 if flag == 1 else 0)
    require(size == raw_length, "a zstd frame declares another length than raw_length")
