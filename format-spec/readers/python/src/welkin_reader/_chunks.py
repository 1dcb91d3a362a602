"""Payloads of chunks (section 6), checked before use."""

import zlib
from dataclasses import dataclass

import numpy as np

from . import _head
from ._aerial_perspective import decode_source, decode_source_basis
from ._axis import decode_axis
from ._estimate import decode_estimate
from ._head import NONE, Cursor, require, require_within, round_up
from ._spectrum import decode_spectrum
from ._zstd import decompress
from .errors import ChecksumError, EncodingError, InvalidValueError, MissingError

_NAMES = {
    _head.RADIANCE: "radiance",
    _head.COLUMN: "column",
    _head.RADIANCE_BASIS: "radiance basis",
    _head.TRANSMITTANCE: "transmittance",
    _head.SOURCE: "source",
    _head.POLARISATION: "polarisation",
    _head.POLARISATION_BASIS: "polarisation basis",
    _head.SOURCE_BASIS: "source basis",
    _head.SPECTRUM: "spectrum",
    _head.ESTIMATE: "estimate",
    _head.AXIS: "axis",
}


@dataclass(frozen=True)
class Directional:
    """Radiance (6.1) or polarisation (6.6) at one altitude and visibility, without padding.

    scale (r,), up (nu+3, r), down (nd+3, r), elevation (ne+3, r), level (ne+3, nw) or None.
    """

    scale: np.ndarray
    up: np.ndarray
    down: np.ndarray
    elevation: np.ndarray
    level: np.ndarray | None


@dataclass(frozen=True)
class Basis:
    """Radiance basis (6.3) or polarisation basis (6.7): phi (np+1, r), channel (r, channels)."""

    phi: np.ndarray
    channel: np.ndarray


@dataclass(frozen=True)
class Profiles:
    """Profiles of the constituents (6.4): edge (nl+1,) in m, density (2·nl+1, nk)."""

    edge: np.ndarray
    density: np.ndarray


class Chunks:
    """Finds, checks and keeps the chunks of a file."""

    def __init__(self, source, head):
        self._source = source
        self._head = head
        self._kept = {}

    def require_present(self, kind, altitude=NONE, visibility=NONE):
        """Raises MissingError if the file lacks the chunk."""
        entry = self._head.chunk(kind, altitude, visibility)
        if entry is None:
            place = _place(altitude, visibility)
            raise MissingError(f"the file has no {_NAMES[kind]} chunk{place}")
        return entry

    @np.errstate(all="ignore")
    def get(self, kind, altitude=NONE, visibility=NONE):
        """The decoded chunk."""
        key = (kind, altitude, visibility)
        if key not in self._kept:
            entry = self.require_present(*key)
            self._kept[key] = _decode(self._payload(entry), entry, self._head)
        return self._kept[key]

    def _payload(self, entry):
        # A copy: what was checked cannot change any more, even if the mapped file does.
        stored = self._source[entry.offset : entry.offset + entry.stored_length]
        if zlib.crc32(stored) != entry.crc32:
            raise ChecksumError(f"a {_NAMES[entry.kind]} chunk is damaged")
        if entry.encoding == 1:
            return decompress(stored, entry.raw_length)
        if entry.encoding != 0:
            raise EncodingError(f"unknown encoding {entry.encoding}")
        return stored


def _place(altitude, visibility):
    parts = [("altitude", altitude), ("visibility", visibility)]
    named = [f"{name} node {index}" for name, index in parts if index != NONE]
    return " at " + ", ".join(named) if named else ""


def _decode(payload, entry, head):
    decoders = {
        _head.RADIANCE: _directional,
        _head.POLARISATION: _directional,
        _head.COLUMN: _column,
        _head.RADIANCE_BASIS: _basis,
        _head.POLARISATION_BASIS: _basis,
        _head.TRANSMITTANCE: _profiles,
        _head.SOURCE: decode_source,
        _head.SOURCE_BASIS: decode_source_basis,
        _head.SPECTRUM: decode_spectrum,
        _head.ESTIMATE: decode_estimate,
        _head.AXIS: decode_axis,
    }
    return decoders[entry.kind](Payload(payload), entry, head)


class Payload(Cursor):
    """Takes finite arrays from the front of a payload, and refuses to read beyond its end."""

    def __init__(self, data):
        super().__init__(data, 0)

    def take(self, dtype, *shape):
        length = np.dtype(dtype).itemsize
        for size in shape:
            length *= size
        require(length <= len(self.data) - self.offset, "a payload is too short")
        array = super().take(dtype, *shape)
        if array.dtype.kind == "f" and not np.all(np.isfinite(array)):
            raise InvalidValueError("a payload has a number that is not finite")
        return array

    def end(self):
        require(self.offset == len(self.data), "a payload is too long")


def _directional(payload, entry, head):
    counts, rank = head.counts, entry.rank
    q = round_up(rank, 16)
    scale = payload.take("<f4", q)[:rank]
    up = payload.take("<f2", counts["nu"] + 3, q)[:, :rank]
    down = payload.take("<f2", counts["nd"] + 3, q)[:, :rank]
    elevation = payload.take("<f2", counts["ne"] + 3, q)[:, :rank]
    level = None
    if entry.kind == _head.RADIANCE and not head.has_estimates:
        level = payload.take("<f2", counts["ne"] + 3, counts["nw"])
    payload.end()
    return Directional(scale, up, down, elevation, level)


def _column(payload, entry, head):
    """ln of mean profiles: (nu+3 + nd+3, nk)."""
    counts = head.counts
    table = payload.take("<f4", counts["nu"] + 3 + counts["nd"] + 3, counts["nk"])
    payload.end()
    return table


def _basis(payload, entry, head):
    counts, rank = head.counts, entry.rank
    q = round_up(rank, 16)
    parts = counts["nf"] if entry.kind == _head.RADIANCE_BASIS else 4
    channels = parts * counts["nw"]
    phi = payload.take("<f2", counts["np"] + 1, q)[:, :rank]
    channel = payload.take("<f2", q, round_up(channels, 16))[:rank, :channels]
    payload.end()
    return Basis(phi.astype(np.float64), channel.astype(np.float64))


def _profiles(payload, entry, head):
    layers = int(payload.take("<u4", 2)[0])
    require(1 <= layers <= 1024, "layers outside 1 to 1024")
    edge = payload.take("<f8", layers + 1)
    density = payload.take("<f4", 2 * layers + 1, head.counts["nk"]).astype(np.float64)
    payload.end()
    require(edge[0] == 0.0, "the first layer does not start at the ground")
    require(edge[-1] == head.top_altitude, "the last layer does not end at the top")
    require(np.all(np.diff(edge) >= 1e-3), "a layer is thinner than 1 mm")
    require_within(density, 0.0, 1e6, "density")
    return Profiles(edge, density)
