"""Opening files."""

import json
import math
import mmap
from pathlib import Path

import numpy as np

from . import _head
from ._aerial_perspective import AerialPerspective
from ._axes import linear_weights
from ._chunks import Chunks
from ._geometry import unit_vectors
from ._head import read_head
from ._spectral import Wavelengths
from ._stokes import bounded_stokes, interpolate_stokes
from ._transmittance import path_integrals
from .errors import InvalidValueError, PointError, RangeError
from .sky import Conditions, Sky

FARTHEST = 1e9
"""Largest coordinate of an end of a segment, m."""

_BLOCK_NUMBERS = 1 << 20
"""Numbers that one block of lines may hold at once in an intermediate array."""

LOWEST = -500.0
"""Altitude below which no land lies, m."""


def open(path, in_memory=False):
    """Opens a welkin file, and reads its head.

    The file is mapped, and only the chunks that questions need are read. A file that another
    program may cut off meanwhile should be read into memory: a mapped one can end the process.
    """
    return Model(_read(Path(path), in_memory), (open, (path, in_memory)))


def from_bytes(data):
    """Opens a welkin file that is in memory."""
    data = bytes(data)
    return Model(data, (from_bytes, (data,)))


def _read(path, in_memory):
    with path.open("rb") as file:
        # An empty file cannot be mapped.
        if in_memory or path.stat().st_size == 0:
            return file.read()
        return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)


class Model:
    """A model of the clear sky. Made by `welkin_reader.open` or `welkin_reader.from_bytes`."""

    def __init__(self, source, recipe=None):
        self._recipe = recipe
        self._head = read_head(source)
        self._chunks = Chunks(source, self._head)
        self._wavelengths = Wavelengths(self._head, self._chunks)

    def __reduce__(self):
        return self._recipe

    @property
    def wavelengths(self):
        """Wavelengths that the file stores, its nodes, nm: (W,)."""
        return self._head.wavelength.copy()

    @property
    def wavelength_range(self):
        """First and last wavelength that can be asked, nm: of the spectrum's cells, or of the nodes."""
        return self._wavelengths.range

    @property
    def altitude_range(self):
        """Lowest and highest altitude of an observer, m."""
        return _ends(self._head.altitude)

    @property
    def visibility_range(self):
        """Lowest and highest visibility, m."""
        return _ends(self._head.visibility)

    @property
    def axis(self):
        """The quantity that the visibilities stand for, an `Axis`, or None if they stand for themselves."""
        if self._head.chunk(_head.AXIS) is None:
            return None
        return self._chunks.get(_head.AXIS)

    @property
    def solar_elevation_range(self):
        """Lowest and highest elevation of the sun, rad."""
        return self._head.elevation_min, self._head.elevation_max

    @property
    def planet_radius(self):
        """Radius of the planet, m."""
        return self._head.planet_radius

    @property
    def top_altitude(self):
        """Altitude at which the atmosphere ends, m."""
        return self._head.top_altitude

    @property
    def metadata(self):
        """Metadata as a dict: text from whoever wrote the file, never needed for evaluation."""
        try:
            metadata = json.loads(self._head.metadata_text)
        except (ValueError, RecursionError) as error:
            raise InvalidValueError("metadata is not JSON") from error
        if not isinstance(metadata, dict):
            raise InvalidValueError("metadata is not a JSON object")
        return metadata

    def solar_irradiance(self, wavelength):
        """Solar spectral irradiance at wavelengths in nm, W m⁻² nm⁻¹: (K,)."""
        return self._wavelengths.irradiance(self._wavelengths.checked(wavelength))

    def sky(self, *, solar_elevation, visibility, albedo, altitude, solar_azimuth=0.0):
        """The sky of one scene.

        solar_elevation: rad, of the sun's centre above the horizontal of the observer
        visibility: m, horizontal meteorological range at the ground
        albedo: 0 to 1, of the ground, the same at all wavelengths
        altitude: m, of the observer above the ground; from −500 up to 0 it counts as 0
        solar_azimuth: rad, counter-clockwise from +x seen from above
        """
        conditions = self._conditions(solar_elevation, visibility, albedo, altitude, solar_azimuth)
        return Sky(self._head, self._chunks, self._wavelengths, conditions)

    @np.errstate(all="ignore")
    def transmittance(self, directions, distance, *, altitude, visibility):
        """Transmittance of straight segments from an observer at `altitude`: (…, 3) → (…, W).

        distance: m, a number or an array (…), may be infinite
        altitude, visibility: m, numbers; any altitude
        """
        weights = self._visibility_weights(visibility)
        profiles = self._chunks.get(_head.TRANSMITTANCE)
        columns = self._columns(profiles, directions, distance, altitude)
        result = np.exp(-(columns @ np.tensordot(weights, self._head.extinction, 1)))
        return _finite(result).reshape(*np.shape(directions)[:-1], -1)

    @np.errstate(all="ignore")
    def transmittance_at(self, directions, distance, wavelength, *, altitude, visibility):
        """Transmittance at wavelengths in nm, a number or (K,): (…, 3) → (…, K).

        For files with a spectrum; others know it at their nodes only, and MissingError is raised.
        In absorption bands it is a mean over the band, so that the product of those of two parts
        of a segment is not that of the whole.
        """
        weights = self._visibility_weights(visibility)
        profiles, spectrum = self._chunks.get(_head.TRANSMITTANCE), self._wavelengths.spectrum
        columns = self._columns(profiles, directions, distance, altitude)
        wavelength = self._wavelengths.checked(wavelength)
        step = max(1, _BLOCK_NUMBERS // max(1, spectrum.width(wavelength)))
        blocks = (columns[i : i + step] for i in range(0, max(1, len(columns)), step))
        result = np.concatenate([spectrum.transmittance(b, weights, wavelength) for b in blocks])
        return _finite(result).reshape(*np.shape(directions)[:-1], -1)

    def _visibility_weights(self, visibility):
        """Weights of the visibilities, linear in their inverse: (nv,)."""
        visibility = _clamp(visibility, self.visibility_range, "visibility")
        return linear_weights(-1.0 / self._head.visibility, [-1.0 / visibility])[0]

    def _columns(self, profiles, directions, distance, altitude):
        """Integrals (N, nk) of the profiles along segments."""
        units = unit_vectors(directions)
        altitude, distance = _segments(altitude, units, distance, np.shape(directions)[:-1])
        radius = self._head.planet_radius
        return path_integrals(profiles, radius, altitude, units[:, 2], distance)

    def in_scattering(self, directions, distance, **scene):
        """Light that the air of straight segments scatters to an observer: (…, 3) → (…, W).

        It is per unit of solar spectral irradiance, sr⁻¹. `scene` is that of `sky`, but
        with any altitude; `distance` is as in `transmittance`. An integral over many points: slow for images.
        """
        return self.in_scattering_stokes(directions, distance, **scene)[..., 0, :]

    def in_scattering_at(self, directions, distance, wavelength, **scene):
        """The same light at wavelengths in nm, a number or (K,): (…, 3) → (…, K)."""
        return self.in_scattering_stokes_at(directions, distance, wavelength, **scene)[..., 0, :]

    @np.errstate(all="ignore")
    def in_scattering_stokes_at(self, directions, distance, wavelength, **scene):
        """The same light as Stokes components at wavelengths in nm: (…, 3) → (…, 3, K)."""
        aerial = self._aerial_perspective(**scene)
        wavelength = self._wavelengths.checked(wavelength)
        nodes = self._gathered(aerial, directions, distance)
        light = interpolate_stokes(self._wavelengths, nodes.reshape(-1, *nodes.shape[-2:]), wavelength)
        return _finite(light).reshape(*nodes.shape[:-1], -1)

    @np.errstate(all="ignore")
    def in_scattering_stokes(
        self,
        directions,
        distance,
        *,
        solar_elevation,
        visibility,
        albedo,
        altitude,
        solar_azimuth=0.0,
    ):
        """The same light as Stokes components L, Q, U: (…, 3) → (…, 3, W).

        They are those of the vertical frame at the observer, as in `Sky.stokes`.
        """
        scene = (solar_elevation, visibility, albedo, altitude, solar_azimuth)
        return self._gathered(self._aerial_perspective(*scene), directions, distance)

    def _aerial_perspective(
        self, solar_elevation, visibility, albedo, altitude, solar_azimuth=0.0
    ):
        lowest, _ = self.altitude_range
        conditions = self._conditions(solar_elevation, visibility, albedo, lowest, solar_azimuth)
        return AerialPerspective(self._head, self._chunks, conditions, float(altitude))

    def _gathered(self, aerial, directions, distance):
        """L, Q, U (…, 3, W) of segments."""
        units = unit_vectors(directions)
        _, distance = _segments(aerial.altitude, units, distance, np.shape(directions)[:-1])
        starts = range(0, max(1, len(units)), aerial.block)
        blocks = (slice(i, i + aerial.block) for i in starts)
        light = np.concatenate([aerial.in_scattering(units[b], distance[b]) for b in blocks])
        light = bounded_stokes(*np.moveaxis(_finite(light), 1, 0))
        return _finite(light).reshape(*np.shape(directions)[:-1], 3, -1)

    def _conditions(self, solar_elevation, visibility, albedo, altitude, solar_azimuth):
        if not math.isfinite(solar_azimuth):
            raise RangeError("solar_azimuth is not finite")
        return Conditions(
            solar_elevation=_clamp(solar_elevation, self.solar_elevation_range, "solar_elevation"),
            visibility=_clamp(visibility, self.visibility_range, "visibility"),
            albedo=_clamp(albedo, (0.0, 1.0), "albedo"),
            altitude=_clamp(_grounded(altitude), self.altitude_range, "altitude"),
            solar_azimuth=float(solar_azimuth),
        )


def _ends(axis):
    return float(axis[0]), float(axis[-1])


def _segments(altitude, units, distance, shape):
    """Altitude of the start, and distances in m for each direction (N,). Raises PointError."""
    altitude = float(altitude)
    distance = np.broadcast_to(np.asarray(distance, dtype=np.float64), shape).ravel()
    if not np.all(distance >= 0.0):
        raise PointError("a distance is below 0 or not a number")
    finite = np.where(np.isinf(distance), 0.0, distance)[:, None]
    ends = [0.0, 0.0, altitude] + finite * units
    if not (abs(altitude) <= FARTHEST and np.all(np.abs(ends) <= FARTHEST)):
        raise PointError("an end of a segment is farther than 1e9 m away")
    return altitude, distance


def _finite(values):
    if not np.all(np.isfinite(values)):
        raise InvalidValueError("numbers of the file overflow")
    return values


def _grounded(altitude):
    """An observer in a depression stands on the ground (section 7)."""
    altitude = float(altitude)
    return 0.0 if LOWEST <= altitude < 0.0 else altitude


def _clamp(value, limits, name):
    """`value` as float, excess by rounding removed. Raises RangeError."""
    low, high = limits
    slack = 1e-9 * max(abs(low), abs(high))
    value = float(value)
    if not low - slack <= value <= high + slack:
        raise RangeError(f"{name} {value:g} outside {low:g} to {high:g}")
    return min(max(value, low), high)
