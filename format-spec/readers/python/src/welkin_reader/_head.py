"""The head of a file: header, head arrays and directory (sections 3 to 5), read with suspicion."""

import math
import struct
import zlib
from dataclasses import dataclass

import numpy as np

from .errors import (
    ChecksumError,
    FeatureError,
    InvalidValueError,
    LengthError,
    MagicError,
    VersionError,
)

MAGIC = b"\x89WLK\r\n\x1a\n"
HEADER_LENGTH = 128
ENTRY_LENGTH = 64
NONE = 0xFFFF
MAX_COEFFICIENTS = 1 << 24
MAX_RANK = 4096
MAX_EXPANSION = 256

HAS_SPECTRUM, HAS_ESTIMATES = 1, 2
"""Bits of required_features."""
ABSORBERS_SHIFT = 16
"""From this bit of required_features on: which constituents absorb and do not scatter."""

RADIANCE, COLUMN, RADIANCE_BASIS, TRANSMITTANCE = 1, 2, 3, 4
SOURCE, POLARISATION, POLARISATION_BASIS, SOURCE_BASIS, SPECTRUM = 5, 6, 7, 8, 9
ESTIMATE, AXIS = 10, 11

# Which kinds belong to an altitude, to a visibility, and have a rank.
WITH_ALTITUDE = {RADIANCE, COLUMN, POLARISATION}
WITH_VISIBILITY = {RADIANCE, SOURCE, POLARISATION}
WITH_RANK = {RADIANCE, RADIANCE_BASIS, POLARISATION, POLARISATION_BASIS}

PHASE_NONE, PHASE_RAYLEIGH, PHASE_HENYEY_GREENSTEIN = 0, 1, 2
GROUND_BIT = 1 << 16
ESTIMATE_SHIFT = 24
"""From this bit of the code of a field on: the estimate that it is relative to."""
MAX_ESTIMATES = 4

_HEADER = struct.Struct("<8sHHIQQII10HI8d")
_ENTRY = struct.Struct("<IHHQQQIIIIffQ")

_COUNT_LIMITS = {
    "nw": (2, 256),
    "na": (1, 1024),
    "nv": (1, 1024),
    "nf": (1, 16),
    "nk": (1, 16),
    "nu": (1, 1024),
    "nd": (1, 1024),
    "np": (1, 1024),
    "ne": (1, 1024),
    "ns": (2, 16384),
}


def require(condition, message):
    """Refuses a file unless `condition` holds, which a comparison with NaN does not."""
    if not condition:
        raise InvalidValueError(message)


def require_within(values, low, high, name):
    """Refuses anything outside low..=high, NaN included."""
    require(np.all((values >= low) & (values <= high)), f"{name} outside {low:g} to {high:g}")


def require_increasing(values, name):
    require(np.all(values[1:] > values[:-1]), f"{name} does not increase strictly")


def round_up(number, multiple):
    return -(-number // multiple) * multiple


@dataclass(frozen=True)
class Entry:
    """One chunk, as the directory tells it."""

    kind: int
    altitude: int
    visibility: int
    offset: int
    stored_length: int
    raw_length: int
    encoding: int
    crc32: int
    rank: int
    tier: int
    error_median: float
    error_p99: float
    reserved: int


@dataclass(frozen=True)
class Head:
    """What stands before the chunks. Arrays have the shapes of section 4."""

    counts: dict
    planet_radius: float
    top_altitude: float
    alpha_up_exponent: float
    alpha_down_exponent: float
    elevation_min: float
    elevation_max: float
    elevation_centre: float
    elevation_width: float
    wavelength: np.ndarray
    altitude: np.ndarray
    visibility: np.ndarray
    extinction: np.ndarray
    scatters: np.ndarray
    spherical_albedo: np.ndarray
    phase_parameter: np.ndarray
    xyz: np.ndarray
    solar_start: float
    solar_step: float
    solar_irradiance: np.ndarray
    field: np.ndarray
    metadata_text: str
    chunks: dict

    @property
    def has_estimates(self):
        """Whether the fields are relative to estimates."""
        return self.chunk(ESTIMATE) is not None

    @property
    def field_estimate(self):
        """The estimate that each field is relative to, 0 in a file without: (nf,)."""
        return (self.field >> ESTIMATE_SHIFT).astype(np.intp)

    def chunk(self, kind, altitude=NONE, visibility=NONE):
        """The entry of a chunk, or None."""
        return self.chunks.get((kind, altitude, visibility))


@np.errstate(all="ignore")
def read_head(source):
    """Reads and checks the head.

    `source` has a length, and slices of it are bytes: `bytes` itself or an `mmap`.
    """
    header, counts, chunk_count, metadata_length = _read_header(source)
    head_length = header["head_length"]
    arrays_length = _arrays_length(counts, metadata_length)
    expected = arrays_length + ENTRY_LENGTH * chunk_count
    if head_length != expected:
        raise LengthError(f"head_length is {head_length}, but the counts give {expected}")
    if head_length > len(source):
        raise LengthError("the file ends within its head")
    head = source[:head_length]
    _check_crc(head, header["head_crc32"])
    _check_header_values(header, counts)
    arrays = _read_arrays(head[:arrays_length], counts, metadata_length)
    _check_arrays(header, arrays)
    has_estimates = bool(header["features"] & HAS_ESTIMATES)
    chunks = _read_directory(head[arrays_length:], head_length, len(source), counts, has_estimates)
    for kind, bit in ((SPECTRUM, HAS_SPECTRUM), (ESTIMATE, HAS_ESTIMATES)):
        present = (kind, NONE, NONE) in chunks
        require(present == bool(header["features"] & bit), f"chunk of kind {kind} and feature bit differ")
    names = ("planet_radius", "top_altitude", "alpha_up_exponent", "alpha_down_exponent")
    names += ("elevation_min", "elevation_max", "elevation_centre", "elevation_width")
    scatters = (header["features"] >> ABSORBERS_SHIFT + np.arange(counts["nk"])) & 1 == 0
    require(scatters.any(), "no constituent scatters")
    return Head(counts=counts, chunks=chunks, scatters=scatters, **{name: header[name] for name in names}, **arrays)


def _read_header(source):
    data = source[:HEADER_LENGTH]
    if data[: len(MAGIC)] != MAGIC:
        raise MagicError("not a welkin file")
    if len(data) < HEADER_LENGTH:
        raise LengthError("the file ends within its header")
    names = ("magic", "major", "minor", "features", "file_length", "head_length", "head_crc32")
    names += ("chunk_count", *_COUNT_LIMITS, "metadata_length", "planet_radius", "top_altitude")
    names += ("alpha_up_exponent", "alpha_down_exponent", "elevation_min", "elevation_max")
    names += ("elevation_centre", "elevation_width")
    header = dict(zip(names, _HEADER.unpack(data), strict=True))
    if header["major"] != 1:
        raise VersionError(f"version {header['major']}.{header['minor']} is not 1.x")
    constituents = (1 << min(header["nk"], 16)) - 1
    if header["features"] & ~(HAS_SPECTRUM | HAS_ESTIMATES | constituents << ABSORBERS_SHIFT):
        raise FeatureError(f"unknown required features {header['features']:#x}")
    if header["file_length"] != len(source):
        raise LengthError(f"the file has {len(source)} bytes, not {header['file_length']}")
    counts = {name: header[name] for name in _COUNT_LIMITS}
    for name, (low, high) in _COUNT_LIMITS.items():
        require(low <= counts[name] <= high, f"{name} outside {low} to {high}")
    return header, counts, header["chunk_count"], header["metadata_length"]


def _arrays_length(counts, metadata_length):
    """Bytes of header and head arrays with the padding."""
    nw, na, nv, nf, nk = (counts[name] for name in ("nw", "na", "nv", "nf", "nk"))
    doubles = nw + na + nv + nv * nk * nw + nv * nw + nf * nw + 3 * nw + 2
    words = counts["ns"] + nf
    return round_up(HEADER_LENGTH + 8 * doubles + 4 * words + metadata_length, 8)


def _check_crc(head, expected):
    crc = zlib.crc32(head[:32])
    crc = zlib.crc32(bytes(4), crc)
    crc = zlib.crc32(memoryview(head)[36:], crc)
    if crc != expected:
        raise ChecksumError("the head is damaged")


def _check_header_values(header, counts):
    half_pi = math.pi / 2
    require_within(header["planet_radius"], 1e3, 1e9, "planet_radius")
    require_within(header["top_altitude"], 0.0, 1e9, "top_altitude")
    require_within(header["alpha_up_exponent"], 1.0, 8.0, "alpha_up_exponent")
    require_within(header["alpha_down_exponent"], 1.0, 8.0, "alpha_down_exponent")
    require_within(header["elevation_min"], -half_pi, half_pi, "elevation_min")
    require_within(header["elevation_max"], -half_pi, half_pi, "elevation_max")
    require(header["elevation_max"] > header["elevation_min"], "elevation_max too low")
    require_within(header["elevation_centre"], -half_pi, half_pi, "elevation_centre")
    require_within(header["elevation_width"], 1e-6, 1e6, "elevation_width")
    nodes = (counts["nu"] + 3 + counts["nd"] + 3) * (counts["np"] + 1)
    coefficients = nodes * counts["nf"] * counts["nw"]
    require(coefficients <= MAX_COEFFICIENTS, "too many coefficients of a sky")


class Cursor:
    """Takes arrays from the front of bytes."""

    def __init__(self, data, offset):
        self.data = data
        self.offset = offset

    def take(self, dtype, *shape):
        count = math.prod(shape)
        array = np.frombuffer(self.data, dtype, count, self.offset).reshape(shape)
        self.offset += array.nbytes
        return array


def _read_arrays(data, counts, metadata_length):
    nw, na, nv, nf, nk = (counts[name] for name in ("nw", "na", "nv", "nf", "nk"))
    cursor = Cursor(data, HEADER_LENGTH)
    arrays = {
        "wavelength": cursor.take("<f8", nw),
        "altitude": cursor.take("<f8", na),
        "visibility": cursor.take("<f8", nv),
        "extinction": cursor.take("<f8", nv, nk, nw),
        "spherical_albedo": cursor.take("<f8", nv, nw),
        "phase_parameter": cursor.take("<f8", nf, nw),
        "xyz": cursor.take("<f8", nw, 3),
    }
    arrays["solar_start"], arrays["solar_step"] = map(float, cursor.take("<f8", 2))
    arrays["solar_irradiance"] = cursor.take("<f4", counts["ns"]).astype(np.float64)
    arrays["field"] = cursor.take("<u4", nf)
    end = cursor.offset + metadata_length
    try:
        arrays["metadata_text"] = data[cursor.offset : end].decode("utf-8")
    except UnicodeDecodeError as error:
        raise InvalidValueError("metadata is not UTF-8") from error
    require(not any(data[end:]), "padding after the metadata is not zero")
    return arrays


def _check_arrays(header, arrays):
    wavelength, altitude, visibility = (arrays[x] for x in ("wavelength", "altitude", "visibility"))
    require_within(wavelength, 1.0, 1e6, "wavelength")
    require_increasing(wavelength, "wavelength")
    require_within(altitude, 0.0, 1e9, "altitude")
    require_increasing(altitude, "altitude")
    require_increasing(np.cbrt(altitude), "cube root of altitude")
    require(header["top_altitude"] > altitude[-1], "top_altitude is not above the last altitude")
    require_within(visibility, 1.0, 1e9, "visibility")
    require_increasing(visibility, "visibility")
    require_increasing(-1.0 / visibility, "inverse visibility")
    require_within(arrays["extinction"], 0.0, 1e6, "extinction")
    require_within(arrays["spherical_albedo"], 0.0, 1.0, "spherical_albedo")
    require(np.all(arrays["spherical_albedo"] < 1.0), "spherical_albedo of 1")
    require_within(arrays["xyz"], -1e30, 1e30, "xyz")
    # How many there are is told by their chunk, which is not read at open.
    estimates = MAX_ESTIMATES if header["features"] & HAS_ESTIMATES else 1
    _check_fields(arrays["field"], arrays["phase_parameter"], estimates)
    _check_solar(arrays)


def _check_fields(fields, parameters, estimates):
    require(np.all(np.isfinite(parameters)), "phase_parameter is not finite")
    for field, parameter in zip(fields, parameters):
        field = int(field)
        unknown = (1 << ESTIMATE_SHIFT) - 2 * GROUND_BIT
        require(field & unknown == 0, "unknown bits of a field")
        require(field >> ESTIMATE_SHIFT < estimates, "a field is relative to an unknown estimate")
        check_phase(field & 0xFFFF, parameter)


def check_phase(code, parameter):
    """Refuses unknown phase functions and parameters out of their range."""
    if code == PHASE_RAYLEIGH:
        require_within(parameter, 0.0, 1.0, "depolarisation")
    elif code == PHASE_HENYEY_GREENSTEIN:
        require(np.all(np.abs(parameter) < 1.0), "asymmetry outside −1 to 1")
    else:
        require(code == PHASE_NONE, f"unknown phase function {code}")


def _check_solar(arrays):
    start, step, irradiance = (arrays[x] for x in ("solar_start", "solar_step", "solar_irradiance"))
    require_within(step, 1e-3, 1e6, "solar_step")
    _check_span(start, step, len(irradiance), arrays["wavelength"])
    require_within(irradiance, 0.0, np.finfo(np.float32).max, "solar_irradiance")


def check_solar_span(head, axis):
    """Refuses wavelengths (n,) for which there is no solar irradiance."""
    _check_span(head.solar_start, head.solar_step, len(head.solar_irradiance), axis)


def _check_span(start, step, samples, axis):
    require_within(start, 0.0, axis[0], "solar_start")
    require(start + (samples - 1) * step >= axis[-1], "the solar spectrum ends too early")


def _read_directory(data, head_length, file_length, counts, has_estimates):
    """Entries of known kinds by (kind, altitude, visibility)."""
    chunks = {}
    end = head_length
    for fields in _ENTRY.iter_unpack(data):
        entry = Entry(*fields)
        require(entry.offset == round_up(end, 64), "a chunk is out of its place")
        end = entry.offset + entry.stored_length
        require(end <= file_length, "a chunk reaches beyond the file")
        if not RADIANCE <= entry.kind <= AXIS:
            continue
        _check_entry(entry, counts, has_estimates)
        key = (entry.kind, entry.altitude, entry.visibility)
        require(key not in chunks, "two chunks for the same conditions")
        chunks[key] = entry
    require(end == file_length, "bytes after the last chunk")
    _check_ranks(chunks)
    return chunks


def _check_entry(entry, counts, has_estimates):
    _check_index(entry.altitude, entry.kind in WITH_ALTITUDE, counts["na"], "altitude")
    _check_index(entry.visibility, entry.kind in WITH_VISIBILITY, counts["nv"], "visibility")
    if entry.kind in WITH_RANK:
        require(1 <= entry.rank <= MAX_RANK, "rank of a chunk outside 1 to 4096")
    else:
        require(entry.rank == 0, "rank of a chunk that has none")
    require(entry.tier == 0, "tier of a chunk is not 0")
    errors = (entry.error_median, entry.error_p99)
    require(all(math.isfinite(x) and x >= 0.0 for x in errors), "invalid error of a chunk")
    require(entry.raw_length <= MAX_EXPANSION * entry.stored_length, "a chunk expands too much")
    if entry.encoding == 0:
        require(entry.raw_length == entry.stored_length, "lengths of a raw chunk differ")
    expected = payload_length(entry.kind, entry.rank, counts, has_estimates)
    require(expected in (None, entry.raw_length), "raw_length is not what the shape gives")


def _check_index(index, present, count, name):
    if present:
        require(index < count, f"{name} index of a chunk beyond the axis")
    else:
        require(index == NONE, f"a chunk has an {name} that should have none")


def _check_ranks(chunks):
    """Compares the ranks of chunks with that of their basis, where it exists."""
    for kind, basis_kind in ((RADIANCE, RADIANCE_BASIS), (POLARISATION, POLARISATION_BASIS)):
        basis = chunks.get((basis_kind, NONE, NONE))
        for entry in chunks.values():
            if basis and entry.kind == kind:
                require(entry.rank <= basis.rank, "rank of a chunk above that of its basis")


def payload_length(kind, rank, counts, has_estimates):
    """Bytes of a payload (section 6), or None where they follow from counts in the payload."""
    nw, nf, np_, ne = (counts[name] for name in ("nw", "nf", "np", "ne"))
    alphas = counts["nu"] + 3 + counts["nd"] + 3
    q = round_up(rank, 16)
    if kind == RADIANCE:
        level = 0 if has_estimates else 2 * (ne + 3) * nw
        return 4 * q + 2 * q * (alphas + ne + 3) + level
    if kind == COLUMN:
        return 4 * alphas * counts["nk"]
    if kind == RADIANCE_BASIS:
        return 2 * q * (np_ + 1 + round_up(nf * nw, 16))
    if kind == POLARISATION:
        return 4 * q + 2 * q * (alphas + ne + 3)
    if kind == POLARISATION_BASIS:
        return 2 * q * (np_ + 1 + round_up(4 * nw, 16))
    return None
