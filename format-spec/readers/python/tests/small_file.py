"""Writes small files for tests: one constituent, one visibility of 50 km, the nodes 400 and 700 nm."""

import struct
import zlib
from dataclasses import dataclass

import numpy as np

from welkin_reader import _head

RADIUS, TOP = 6.378e6, 1e5
EDGES = np.array([0.0, 1e3, 3e3, 8e3, 16e3, 32e3, TOP])
SOURCE_LEVEL = 0.01


@dataclass(frozen=True)
class Chunk:
    kind: int
    payload: bytes
    visibility: int = _head.NONE
    altitude: int = _head.NONE
    rank: int = 0


def profile():
    """Bernstein coefficients (2·nl+1, 1) of about exp(−h / 8 km)."""
    middles = 0.5 * (EDGES[1:] + EDGES[:-1])
    altitudes = np.insert(EDGES, np.arange(1, len(EDGES)), middles)
    return np.exp(-altitudes / 8e3)[:, None]


def transmittance_chunk():
    counts = struct.pack("<II", len(EDGES) - 1, 0)
    return counts + EDGES.astype("<f8").tobytes() + profile().astype("<f4").tobytes()


def source_basis_chunk():
    """The same source everywhere: a tensor and a harmonic that give 1 in all directions."""
    head = struct.pack("<8I", 2, 2, 0, 0, 1, 1, 1, 1)
    axes = np.array([0.0, TOP, -1.0, 1.0], "<f8").tobytes()
    moments = [0.5, 0.5, 0.5, 0.0, np.sqrt(4.0 * np.pi)]
    factors = [1.0, 1.0, 1.0, 1.0, *moments, 1.0, 1.0, 0.0, 0.0]
    return head + axes + np.array(factors, "<f4").tobytes()


def source_chunk(phase, scattering):
    head = struct.pack("<6IfI", 1, 2, 1, 1, 1, 1, 2.0, 0)
    parameter = [0.0, 0.0]
    level = [np.log(SOURCE_LEVEL)] * 4 + [0.0] * 4
    numbers = np.array([*parameter, scattering, scattering, *level], "<f4").tobytes()
    return head + struct.pack("<I", phase) + numbers + np.array([0.5], "<f2").tobytes()


def aerial_file(phase, extinction, scattering, spectrum=None, features=None):
    """A file with kinds 4, 5 and 8, and 9 where a payload of it is given.

    extinction: m⁻¹, a number or one for each node
    """
    chunks = [
        Chunk(_head.TRANSMITTANCE, transmittance_chunk()),
        Chunk(_head.SOURCE, source_chunk(phase, scattering), visibility=0),
        Chunk(_head.SOURCE_BASIS, source_basis_chunk()),
    ]
    if spectrum is not None:
        chunks.append(Chunk(_head.SPECTRUM, spectrum))
    features = int(spectrum is not None) if features is None else features
    return small_file(chunks, np.broadcast_to(extinction, 2), features)


def small_file(chunks, extinction, features=0, fields=(0,)):
    """The bytes of a file with chunks; extinction (2,) in m⁻¹, the codes of the fields."""
    arrays = np.array([400, 700, 0, 2e4, 5e4, *extinction, 0, 0, *[0, 0] * len(fields)], "<f8")
    # Before the extinction stand the wavelengths, two altitudes and the visibility.
    body = arrays.tobytes() + np.array([1.0] * 6 + [400.0, 300.0], "<f8").tobytes()
    body += np.array([1.0, 1.0], "<f4").tobytes() + np.array(fields, "<u4").tobytes() + b"{}"
    body += bytes(-len(body) % 8)
    head_length = 128 + len(body) + 64 * len(chunks)
    directory, data = b"", b""
    for chunk in chunks:
        data += bytes(-(head_length + len(data)) % 64)
        size, crc = len(chunk.payload), zlib.crc32(chunk.payload)
        place = (chunk.kind, chunk.altitude, chunk.visibility, head_length + len(data))
        directory += struct.pack("<IHHQQQIIIIffQ", *place, size, size, 0, crc, chunk.rank, 0, 0.0, 0.0, 0)
        data += chunk.payload
    counts = (2, 2, 1, len(fields), 1, 1, 1, 1, 1, 2)
    floats = (RADIUS, TOP, 3.0, 2.5, -np.pi / 2, np.pi / 2, 0.0, 0.06)
    length = head_length + len(data)
    minor = 2 if features & _head.HAS_ESTIMATES else min(features, 1)
    front = struct.pack("<8sHHIQQ", _head.MAGIC, 1, minor, features, length, head_length)
    rest = struct.pack("<I10HI8d", len(chunks), *counts, 2, *floats) + body + directory
    crc = zlib.crc32(front + bytes(4) + rest)
    return front + struct.pack("<I", crc) + rest + data
