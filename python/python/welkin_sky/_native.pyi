"""Types of the native part: what it says of itself is in its docstrings."""

from collections.abc import Callable, Iterable
from os import PathLike
from typing import Any, Protocol, TypeAlias, final

from typing_extensions import Self

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray
from xarray import Dataset

from .conditions import Conditions, Moon
from .samples import Samples

__all__ = [
    "ColourAerialPerspective",
    "JoinedAerialPerspective",
    "AerialPerspective",
    "BakedColourSky",
    "BakedPolarisedSky",
    "BakedSky",
    "Bands",
    "Response",
    "BandAerialPerspective",
    "BandTransmittance",
    "BakedBandSky",
    "BandSky",
    "PolarisedBandSky",
    "BandSolarDisc",
    "default_model",
    "from_bytes",
    "open",
    "stream",
    "Model",
    "ModelAxis",
    "Plan",
    "SkySum",
    "phase_angle_between",
    "PolarisedSky",
    "SkySampler",
    "ColourSky",
    "Sky",
    "colour_space_matrix",
    "SolarDisc",
    "SunCourse",
    "Transmittance",
]

_Floats: TypeAlias = NDArray[np.float32]
_Doubles: TypeAlias = NDArray[np.float64]
_Vector: TypeAlias = tuple[float, float, float]
_Range: TypeAlias = tuple[float, float]
_BakeError: TypeAlias = tuple[float, float, float, float, float]
_Buffer: TypeAlias = bytes | bytearray | memoryview

class _ReadAt(Protocol):
    def read_at(self, offset: int, length: int, /) -> _Buffer: ...

def default_model() -> Model: ...
def open(path: str | PathLike[str], in_memory: bool = False) -> Model: ...
def from_bytes(data: _Buffer) -> Model: ...
def stream(source: Callable[[int, int], _Buffer] | _ReadAt) -> Model: ...
def phase_angle_between(moon: tuple[float, float, float], sun: tuple[float, float, float]) -> float: ...
def colour_space_matrix(space: str) -> _Floats: ...

@final
class AerialPerspective:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def with_solar_azimuth(self, azimuth: float) -> AerialPerspective: ...
    def in_scattering(
        self,
        start: ArrayLike,
        end: ArrayLike,
        *,
        threads: int | None = None,
    ) -> tuple[_Floats, _Floats]: ...
    def to_end(
        self,
        start: ArrayLike,
        directions: ArrayLike,
        *,
        threads: int | None = None,
    ) -> tuple[_Floats, _Floats]: ...
    def in_scattering_at(
        self,
        start: ArrayLike,
        end: ArrayLike,
        wavelengths: ArrayLike,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def in_scattering_stokes(
        self,
        start: ArrayLike,
        end: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> tuple[_Floats, _Floats]: ...
    def xyz(self, start: ArrayLike, end: ArrayLike, *, threads: int | None = None) -> tuple[_Floats, _Floats]: ...
    def rgb(
        self,
        start: ArrayLike,
        end: ArrayLike,
        space: str = 'srgb',
        *,
        threads: int | None = None,
    ) -> tuple[_Floats, _Floats]: ...
    def linear_srgb_stokes(
        self,
        start: ArrayLike,
        end: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> tuple[_Floats, _Floats]: ...
    def in_scattering_along(
        self,
        start: ArrayLike,
        direction: ArrayLike,
        distances: ArrayLike,
    ) -> tuple[_Floats, _Floats]: ...
    def joined_to(self, sky: Sky) -> JoinedAerialPerspective: ...
    @property
    def reach(self) -> float: ...
    @property
    def bytes(self) -> int: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def transmittance(self) -> Transmittance: ...
    @property
    def wavelengths(self) -> _Doubles: ...

@final
class BakedBandSky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def buffers(self) -> dict[str, Any]: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def irradiance(self, normals: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    @property
    def bands(self) -> int: ...
    @property
    def bake_error(self) -> _BakeError: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def bytes(self) -> int: ...
    def to_xarray(
        sky,
        /,
        elevation: ArrayLike | None = None,
        azimuth: ArrayLike | None = None,
        wavelengths: ArrayLike | None = None,
    ) -> Dataset: ...

@final
class BakedColourSky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def buffers(self) -> dict[str, Any]: ...
    def with_solar_azimuth(self, azimuth: float) -> BakedColourSky: ...
    def xyz(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def rgb(self, directions: ArrayLike, space: str = 'srgb', *, threads: int | None = None) -> _Floats: ...
    def sampler(self, sun: SolarDisc | None = None) -> SkySampler: ...
    @property
    def bytes(self) -> int: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def bake_error(self) -> _BakeError: ...
    def plot(
        sky,
        /,
        wavelength: float | None = None,
        *,
        quantity: str = "radiance",
        size: int = 256,
        white: float | None = None,
        ax: Axes | None = None,
        **keywords: Any,
    ) -> Axes: ...
    def to_xarray(
        sky,
        /,
        elevation: ArrayLike | None = None,
        azimuth: ArrayLike | None = None,
        wavelengths: ArrayLike | None = None,
    ) -> Dataset: ...

@final
class BakedPolarisedSky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def with_solar_azimuth(self, azimuth: float) -> BakedPolarisedSky: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def stokes(
        self,
        directions: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def stokes_at(
        self,
        directions: ArrayLike,
        wavelengths: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def hero(
        self,
        directions: ArrayLike,
        wavelengths: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    @property
    def bytes(self) -> int: ...
    @property
    def polarisation_error(self) -> _BakeError: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def wavelengths(self) -> _Doubles: ...
    @property
    def bake_error(self) -> _BakeError: ...
    def plot(
        sky,
        /,
        wavelength: float | None = None,
        *,
        quantity: str = "radiance",
        size: int = 256,
        white: float | None = None,
        ax: Axes | None = None,
        **keywords: Any,
    ) -> Axes: ...
    def to_xarray(
        sky,
        /,
        elevation: ArrayLike | None = None,
        azimuth: ArrayLike | None = None,
        wavelengths: ArrayLike | None = None,
    ) -> Dataset: ...

@final
class BakedSky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def buffers(self) -> dict[str, Any]: ...
    def with_solar_azimuth(self, azimuth: float) -> BakedSky: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def radiance_at(self, directions: ArrayLike, wavelengths: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def hero(self, directions: ArrayLike, wavelengths: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def irradiance(self, normals: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    @property
    def wavelengths(self) -> _Doubles: ...
    @property
    def bytes(self) -> int: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def bake_error(self) -> _BakeError: ...
    def plot(
        sky,
        /,
        wavelength: float | None = None,
        *,
        quantity: str = "radiance",
        size: int = 256,
        white: float | None = None,
        ax: Axes | None = None,
        **keywords: Any,
    ) -> Axes: ...
    def to_xarray(
        sky,
        /,
        elevation: ArrayLike | None = None,
        azimuth: ArrayLike | None = None,
        wavelengths: ArrayLike | None = None,
    ) -> Dataset: ...

@final
class BandAerialPerspective:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def in_scattering(
        self,
        start: ArrayLike,
        end: ArrayLike,
        *,
        threads: int | None = None,
    ) -> tuple[_Floats, _Floats]: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def bands(self) -> int: ...

@final
class BandSky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def with_solar_azimuth(self, azimuth: float) -> BandSky: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def bake(self, tolerance: float = 0.0025) -> BakedBandSky: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def bands(self) -> int: ...
    @property
    def sun_direction(self) -> _Vector: ...
    def to_xarray(
        sky,
        /,
        elevation: ArrayLike | None = None,
        azimuth: ArrayLike | None = None,
        wavelengths: ArrayLike | None = None,
    ) -> Dataset: ...

@final
class BandSolarDisc:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def irradiance(self, normals: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    @property
    def bands(self) -> int: ...
    @property
    def direction(self) -> _Vector: ...
    @property
    def is_visible(self) -> bool: ...

@final
class BandTransmittance:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def between(self, start: ArrayLike, end: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def to_space(self, start: ArrayLike, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    @property
    def bands(self) -> int: ...

@final
class Bands:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def __len__(self) -> int: ...
    def project(self, relative_radiance: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    @property
    def residuals(self) -> list[tuple[float, float]]: ...
    @property
    def nodes(self) -> _Doubles: ...

@final
class ColourAerialPerspective:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def linear_srgb_volume(
        self,
        camera: ArrayLike,
        axis: ArrayLike,
        right: ArrayLike,
        up: ArrayLike,
        size: tuple[int, int],
        depths: ArrayLike,
        *,
        threads: int | None = None,
    ) -> tuple[_Floats, _Floats]: ...
    def with_solar_azimuth(self, azimuth: float) -> ColourAerialPerspective: ...
    def xyz(self, start: ArrayLike, end: ArrayLike, *, threads: int | None = None) -> tuple[_Floats, _Floats]: ...
    def rgb(
        self,
        start: ArrayLike,
        end: ArrayLike,
        space: str = 'srgb',
        *,
        threads: int | None = None,
    ) -> tuple[_Floats, _Floats]: ...
    def linear_srgb_along(
        self,
        start: ArrayLike,
        direction: ArrayLike,
        distances: ArrayLike,
    ) -> tuple[_Floats, _Floats]: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def bytes(self) -> int: ...

@final
class ColourSky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def with_solar_azimuth(self, azimuth: float) -> ColourSky: ...
    def xyz(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def rgb(self, directions: ArrayLike, space: str = 'srgb', *, threads: int | None = None) -> _Floats: ...
    def bake(self, tolerance: float = 0.0025) -> BakedColourSky: ...
    def bake_like(self, other: BakedColourSky) -> BakedColourSky: ...
    @property
    def bytes(self) -> int: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def sun_direction(self) -> _Vector: ...
    def plot(
        sky,
        /,
        wavelength: float | None = None,
        *,
        quantity: str = "radiance",
        size: int = 256,
        white: float | None = None,
        ax: Axes | None = None,
        **keywords: Any,
    ) -> Axes: ...
    def to_xarray(
        sky,
        /,
        elevation: ArrayLike | None = None,
        azimuth: ArrayLike | None = None,
        wavelengths: ArrayLike | None = None,
    ) -> Dataset: ...

@final
class JoinedAerialPerspective:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def in_scattering(self, points: ArrayLike, *, threads: int | None = None) -> tuple[_Floats, _Floats]: ...
    def rgb(self, points: ArrayLike, space: str = 'srgb', *, threads: int | None = None) -> tuple[_Floats, _Floats]: ...
    @property
    def camera(self) -> _Vector: ...

@final
class Model:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def band_radiance(
        self,
        directions: ArrayLike,
        bands: Bands,
        conditions: Conditions | None = None,
        *,
        solar_elevation: ArrayLike | None = None,
        solar_azimuth: ArrayLike | None = None,
        visibility: ArrayLike | None = None,
        albedo: ArrayLike | None = None,
        altitude: ArrayLike | None = None,
        threads: int | None = None,
    ) -> _Floats: ...
    def verify(self) -> None: ...
    def solar_irradiance(self, wavelengths: ArrayLike) -> _Doubles: ...
    def clamped(self, conditions: Conditions) -> Conditions: ...
    def bands(self, responses: Iterable[Response | float]) -> Bands: ...
    def band_sky(
        self,
        bands: Bands,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> BandSky: ...
    def polarised_band_sky(
        self,
        bands: Bands,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> PolarisedBandSky: ...
    def band_solar_disc(
        self,
        bands: Bands,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> BandSolarDisc: ...
    def band_aerial_perspective(
        self,
        bands: Bands,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> BandAerialPerspective: ...
    def band_transmittance(self, visibility: float, bands: Bands) -> BandTransmittance: ...
    def sky(
        self,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> Sky: ...
    def polarised_sky(
        self,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> PolarisedSky: ...
    def colour_sky(
        self,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> ColourSky: ...
    def solar_disc(
        self,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> SolarDisc: ...
    def aerial_perspective(
        self,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> AerialPerspective: ...
    def colour_aerial_perspective(
        self,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> ColourAerialPerspective: ...
    def sky_with_moon(
        self,
        moon: Moon,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> SkySum: ...
    def moonlit(self, moon: Moon) -> Model: ...
    def over(self, wavelengths: ArrayLike, albedos: ArrayLike) -> Model: ...
    def transmittance(self, visibility: float) -> Transmittance: ...
    def sun_course(
        self,
        elevations: ArrayLike,
        tolerance: float = 0.0025,
        conditions: Conditions | None = None,
        *,
        solar_elevation: float | None = None,
        solar_azimuth: float | None = None,
        visibility: float | None = None,
        albedo: float | None = None,
        altitude: float | None = None,
    ) -> SunCourse: ...
    def plan(
        self,
        *,
        altitude: tuple[float, float] | None = None,
        visibility: tuple[float, float] | None = None,
        solar_elevation: tuple[float, float] | None = None,
        tolerance: float = 0.0025,
        channels: str = 'spectral',
    ) -> Plan: ...
    def load(self, plan: Plan) -> None: ...
    def radiance(
        self,
        directions: ArrayLike,
        conditions: Conditions | None = None,
        *,
        solar_elevation: ArrayLike | None = None,
        solar_azimuth: ArrayLike | None = None,
        visibility: ArrayLike | None = None,
        albedo: ArrayLike | None = None,
        altitude: ArrayLike | None = None,
        threads: int | None = None,
    ) -> _Floats: ...
    def relative_radiance(
        self,
        directions: ArrayLike,
        conditions: Conditions | None = None,
        *,
        solar_elevation: ArrayLike | None = None,
        solar_azimuth: ArrayLike | None = None,
        visibility: ArrayLike | None = None,
        albedo: ArrayLike | None = None,
        altitude: ArrayLike | None = None,
        threads: int | None = None,
    ) -> _Floats: ...
    def radiance_at(
        self,
        directions: ArrayLike,
        wavelengths: ArrayLike,
        conditions: Conditions | None = None,
        *,
        solar_elevation: ArrayLike | None = None,
        solar_azimuth: ArrayLike | None = None,
        visibility: ArrayLike | None = None,
        albedo: ArrayLike | None = None,
        altitude: ArrayLike | None = None,
        threads: int | None = None,
    ) -> _Floats: ...
    def stokes(
        self,
        directions: ArrayLike,
        conditions: Conditions | None = None,
        *,
        frame: ArrayLike | str | None = None,
        solar_elevation: ArrayLike | None = None,
        solar_azimuth: ArrayLike | None = None,
        visibility: ArrayLike | None = None,
        albedo: ArrayLike | None = None,
        altitude: ArrayLike | None = None,
        threads: int | None = None,
    ) -> _Floats: ...
    @property
    def altitude_range(self) -> _Range: ...
    @property
    def axis(self) -> ModelAxis | None: ...
    @property
    def top_altitude(self) -> float: ...
    @property
    def file_bytes(self) -> int: ...
    @property
    def metadata(self) -> dict[str, Any]: ...
    @property
    def visibility_range(self) -> _Range: ...
    @property
    def solar_elevation_range(self) -> _Range: ...
    @property
    def planet_radius(self) -> float: ...
    @property
    def has_spectrum(self) -> bool: ...
    @property
    def is_polarised(self) -> bool: ...
    @property
    def is_moonlit(self) -> bool: ...
    @property
    def has_ground(self) -> bool: ...
    @property
    def touched_bytes(self) -> int: ...
    @property
    def traffic(self) -> tuple[int, int]: ...
    @property
    def wavelength_range(self) -> _Range: ...
    @property
    def wavelengths(self) -> _Doubles: ...

@final
class ModelAxis:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def visibility(self, value: float) -> float: ...
    def value(self, visibility: float) -> float: ...
    @property
    def name(self) -> str: ...
    @property
    def unit(self) -> str: ...
    @property
    def values(self) -> _Doubles: ...
    @property
    def range(self) -> _Range: ...

@final
class Plan:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    @property
    def degree_error(self) -> tuple[float, float] | None: ...
    @property
    def chunk_count(self) -> int: ...
    @property
    def file_bytes(self) -> int: ...
    @property
    def sky_bytes(self) -> int: ...
    @property
    def error_median(self) -> float: ...
    @property
    def bake_p95(self) -> float: ...
    @property
    def error_p99(self) -> float: ...

@final
class PolarisedBandSky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def buffers(self, tolerance: float = 0.0025) -> dict[str, Any]: ...
    def stokes(
        self,
        directions: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    @property
    def bands(self) -> int: ...
    @property
    def conditions(self) -> Conditions: ...

@final
class PolarisedSky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def with_solar_azimuth(self, azimuth: float) -> PolarisedSky: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def stokes(
        self,
        directions: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def relative_stokes(
        self,
        directions: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def stokes_at(
        self,
        directions: ArrayLike,
        wavelengths: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def xyz_stokes(
        self,
        directions: ArrayLike,
        frame: ArrayLike | str | None = None,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def bake(self, tolerance: float = 0.0025) -> BakedPolarisedSky: ...
    @property
    def bytes(self) -> int: ...
    @property
    def wavelengths(self) -> _Doubles: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def sun_direction(self) -> _Vector: ...
    def plot(
        sky,
        /,
        wavelength: float | None = None,
        *,
        quantity: str = "radiance",
        size: int = 256,
        white: float | None = None,
        ax: Axes | None = None,
        **keywords: Any,
    ) -> Axes: ...
    def to_xarray(
        sky,
        /,
        elevation: ArrayLike | None = None,
        azimuth: ArrayLike | None = None,
        wavelengths: ArrayLike | None = None,
    ) -> Dataset: ...

@final
class Response:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    @staticmethod
    def wavelength(wavelength: float) -> Response: ...
    @staticmethod
    def table(wavelengths: ArrayLike, values: ArrayLike) -> Response: ...
    def normalised(self) -> Response: ...
    @property
    def integral(self) -> float: ...
    @property
    def range(self) -> _Range: ...

@final
class Sky:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def with_solar_azimuth(self, azimuth: float) -> Sky: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def relative_radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def radiance_at(self, directions: ArrayLike, wavelengths: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def relative_radiance_at(
        self,
        directions: ArrayLike,
        wavelengths: ArrayLike,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def xyz(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def rgb(self, directions: ArrayLike, space: str = 'srgb', *, threads: int | None = None) -> _Floats: ...
    def bake(self, tolerance: float = 0.0025) -> BakedSky: ...
    def bake_colour(self, tolerance: float = 0.0025) -> BakedColourSky: ...
    @property
    def conditions(self) -> Conditions: ...
    @property
    def wavelengths(self) -> _Doubles: ...
    @property
    def sun_direction(self) -> _Vector: ...
    @property
    def bytes(self) -> int: ...
    def plot(
        sky,
        /,
        wavelength: float | None = None,
        *,
        quantity: str = "radiance",
        size: int = 256,
        white: float | None = None,
        ax: Axes | None = None,
        **keywords: Any,
    ) -> Axes: ...
    def to_xarray(
        sky,
        /,
        elevation: ArrayLike | None = None,
        azimuth: ArrayLike | None = None,
        wavelengths: ArrayLike | None = None,
    ) -> Dataset: ...

@final
class SkySampler:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def sample(self, unit_square: ArrayLike, *, threads: int | None = None) -> Samples: ...
    def pdf(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def xyz(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    @property
    def bytes(self) -> int: ...

@final
class SkySum:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def xyz(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def rgb(self, directions: ArrayLike, space: str = 'srgb', *, threads: int | None = None) -> _Floats: ...
    @property
    def parts(self) -> int: ...
    def plot(
        sky,
        /,
        wavelength: float | None = None,
        *,
        quantity: str = "radiance",
        size: int = 256,
        white: float | None = None,
        ax: Axes | None = None,
        **keywords: Any,
    ) -> Axes: ...

@final
class SolarDisc:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def radiance(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def radiance_at(self, directions: ArrayLike, wavelengths: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def xyz(self, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def irradiance(self, normals: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    @property
    def solid_angle(self) -> float: ...
    @property
    def wavelengths(self) -> _Doubles: ...
    @property
    def is_visible(self) -> bool: ...
    @property
    def direction(self) -> _Vector: ...

@final
class SunCourse:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def at(self, solar_elevation: float, solar_azimuth: float = 0.0) -> BakedColourSky: ...
    @property
    def elevations(self) -> _Range: ...
    @property
    def skies(self) -> int: ...
    @property
    def bytes(self) -> int: ...
    @property
    def interpolation_error(self) -> _BakeError: ...

@final
class Transmittance:
    def __copy__(self) -> Self: ...
    def __deepcopy__(self, memo: Any) -> Self: ...
    def between(self, start: ArrayLike, end: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def optical_depth(self, start: ArrayLike, end: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def to_space(self, start: ArrayLike, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def to_end(self, start: ArrayLike, directions: ArrayLike, *, threads: int | None = None) -> _Floats: ...
    def between_at(
        self,
        start: ArrayLike,
        end: ArrayLike,
        wavelengths: ArrayLike,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    def to_space_at(
        self,
        start: ArrayLike,
        directions: ArrayLike,
        wavelengths: ArrayLike,
        *,
        threads: int | None = None,
    ) -> _Floats: ...
    @property
    def wavelengths(self) -> _Doubles: ...
