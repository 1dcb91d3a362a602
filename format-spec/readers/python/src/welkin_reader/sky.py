"""The sky of one scene: radiance, colour and polarisation (sections 7.2 to 7.5)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from . import _head
from ._axes import faded_rows, free_spline, linear_weights, mirrored_spline, node_weights
from ._estimate import Estimates
from ._geometry import Observer, azimuth_from_sun, azimuthal_fade, elevation_of, sun_across
from ._geometry import sun_vector, unit_vectors
from ._head import GROUND_BIT, PHASE_RAYLEIGH
from ._phase import Angle, phase_function, rayleigh_share
from ._stokes import bounded_stokes, interpolate_stokes
from .errors import InvalidValueError

# Numbers that one block of directions may hold at once in an intermediate array.
_BLOCK_NUMBERS = 1 << 20


@dataclass(frozen=True)
class Conditions:
    """One scene. Metres and radians; albedo 0 to 1; azimuth counter-clockwise from +x."""

    solar_elevation: float
    visibility: float
    albedo: float
    altitude: float
    solar_azimuth: float = 0.0


@dataclass(frozen=True)
class Factors:
    """Chunks at the conditions in one: up (nu+3, r), down (nd+3, r), phi (np+1, r), channel."""

    up: np.ndarray
    down: np.ndarray
    phi: np.ndarray
    channel: np.ndarray

    def at(self, view):
        """Sum over the components: (N, channels)."""
        alpha = view.by_side(self.up, self.down)
        return (alpha * mirrored_spline(view.phi_coordinate, self.phi)) @ self.channel


class Sky:
    """The sky of one scene. Made by `Model.sky`.

    Directions are arrays (…, 3) in the local frame: +z zenith, azimuth counter-clockwise from +x
    seen from above; they point away from the observer and may have any length. Results have the
    shape of the directions with the last axis replaced. Directions below the horizon are answered
    too: with the light of the air before black ground.
    """

    @np.errstate(all="ignore")
    def __init__(self, head, chunks, wavelengths, conditions):
        self.conditions = conditions
        self._head = head
        self._chunks = chunks
        self._wavelengths = wavelengths
        self._observer = Observer(head.planet_radius, head.top_altitude, conditions.altitude)
        self._sun = sun_vector(conditions.solar_elevation, conditions.solar_azimuth)
        self._altitudes, self._visibilities = self._stencils()
        self._elevation = self._elevation_coordinate()
        self._fade = azimuthal_fade(np.cos(conditions.solar_elevation))
        self._require_radiance()
        self._factors, level = self._combine(_head.RADIANCE, _head.RADIANCE_BASIS)
        self._level = np.exp(level)
        inverse = linear_weights(-1.0 / head.visibility, [-1.0 / conditions.visibility])[0]
        self._extinction = np.tensordot(inverse, head.extinction, 1)
        self._estimates = self._load_estimates() if head.has_estimates else None
        self._column = None if head.has_estimates else self._load_column()
        albedo = conditions.albedo
        self._bounce = albedo / (1.0 - albedo * (inverse @ head.spherical_albedo))

    @property
    def wavelengths(self):
        """Wavelengths of the results of functions that are not told any, nm: (W,)."""
        return self._wavelengths.nodes.copy()

    def relative_radiance(self, directions):
        """Radiance per unit of solar spectral irradiance, sr⁻¹: (…, 3) → (…, W)."""
        return self._blockwise(directions, self._relative)

    def radiance(self, directions):
        """Spectral radiance, W m⁻² sr⁻¹ nm⁻¹: (…, 3) → (…, W)."""
        return self._in_units(self.relative_radiance(directions), self._wavelengths.nodes)

    def relative_radiance_at(self, directions, wavelength):
        """Relative radiance, sr⁻¹, at wavelengths in nm, a number or (K,): (…, 3) → (…, K)."""
        wavelength = self._wavelengths.checked(wavelength)

        def evaluate(units):
            return self._wavelengths.rule.radiance(self._relative(units), wavelength)

        return self._blockwise(directions, evaluate, self._wavelengths.rule.width(wavelength))

    def radiance_at(self, directions, wavelength):
        """Spectral radiance, W m⁻² sr⁻¹ nm⁻¹, at wavelengths in nm: (…, 3) → (…, K)."""
        relative = self.relative_radiance_at(directions, wavelength)
        return self._in_units(relative, self._wavelengths.checked(wavelength))

    def xyz(self, directions):
        """CIE 1931 X, Y, Z, cd m⁻² (Y is luminance): (…, 3) → (…, 3)."""
        return self._blockwise(directions, lambda units: self._relative(units) @ self._head.xyz)

    def stokes(self, directions):
        """Relative Stokes components L, Q, U, sr⁻¹, in the vertical frame: (…, 3) → (…, 3, W).

        Q > 0 is polarisation in the vertical plane of the view direction; U > 0 is turned by 45°
        from up to the right of the viewer.
        """
        self._require_polarisation()
        return self._blockwise(directions, self._stokes)

    def stokes_at(self, directions, wavelength):
        """Relative Stokes components at wavelengths in nm: (…, 3) → (…, 3, K)."""
        self._require_polarisation()
        wavelength = self._wavelengths.checked(wavelength)

        def evaluate(units):
            return interpolate_stokes(self._wavelengths, self._stokes(units), wavelength)

        return self._blockwise(directions, evaluate, self._wavelengths.rule.width(wavelength))

    @np.errstate(all="ignore")
    def _blockwise(self, directions, evaluate, columns=0):
        """Applies `evaluate` to unit vectors (n, 3), few at once to save memory."""
        units = unit_vectors(directions)
        counts = self._head.counts
        widest = max(self._factors.channel.shape[0], counts["nf"] * counts["nw"], columns)
        if self._estimates is not None:
            widest = max(widest, self._estimates.width)
        step = max(1, _BLOCK_NUMBERS // widest)
        # At least one block, which gives the shape for no directions at all.
        starts = range(0, max(1, len(units)), step)
        values = np.concatenate([evaluate(units[i : i + step]) for i in starts])
        _require_finite(values)
        return values.reshape(np.shape(directions)[:-1] + values.shape[1:])

    @np.errstate(all="ignore")
    def _in_units(self, relative, wavelength):
        radiance = relative * self._wavelengths.irradiance(wavelength)
        _require_finite(radiance)
        return radiance

    def _relative(self, units):
        view = _View(self, units)
        base, _ = self._bases(view)
        return self._radiance_of_view(view, self._fields(view, base))

    def _radiance_of_view(self, view, fields):
        total = 0.0
        for code, parameter, factor, weight in self._each_field(fields):
            total = total + factor * weight * phase_function(code, parameter, view.angle)
        return np.maximum(0.0, total)

    def _bases(self, view):
        """What the fields, (N, nf or 1, nw), and Q and U of diffuse light, (N, nw), are relative to."""
        if self._estimates is None:
            lead = self._lead(view)
            return lead[:, None], lead
        estimates = self._estimates.along(view)
        return estimates[:, self._head.field_estimate], estimates[:, -1]

    def _fields(self, view, base):
        """F_f times what they are relative to: (N, nf, nw)."""
        counts = self._head.counts
        return base * self._factors.at(view).reshape(-1, counts["nf"], counts["nw"])

    def _each_field(self, fields):
        """Phase code, parameter (nw,), values (N, nw) and weight of each field."""
        for f, field in enumerate(self._head.field):
            weight = self._bounce if field & GROUND_BIT else 1.0
            code = int(field) & 0xFFFF
            yield code, self._head.phase_parameter[f], fields[:, f], weight

    def _lead(self, view):
        """(1 − T) · ω · S: (N, nw)."""
        nu = self._head.counts["nu"]
        logarithm = view.by_side(self._column[: nu + 3], self._column[nu + 3 :])
        density = np.exp(logarithm)
        extinction = density @ self._extinction
        depth = view.ray_length[:, None] * extinction
        scattering = density @ (self._head.scatters[:, None] * self._extinction)
        share = scattering / np.maximum(extinction, np.finfo(np.float64).tiny)
        return -np.expm1(-depth) * share * self._level

    def _stokes(self, units):
        view = _View(self, units)
        base, diffuse_base = self._bases(view)
        fields = self._fields(view, base)
        radiance = self._radiance_of_view(view, fields)
        dipole = 0.0
        for code, parameter, factor, weight in self._each_field(fields):
            if code == PHASE_RAYLEIGH:
                dipole = dipole + 0.75 * rayleigh_share(parameter) * factor * weight
        p1, p2 = view.sun_across
        m = self._polarisation.at(view).reshape(-1, 4, self._head.counts["nw"])
        q = dipole * (p2**2 - p1**2) + diffuse_base * (m[:, 0] + self._bounce * m[:, 2])
        side = self._fade * np.sin(view.phi)[:, None] * diffuse_base
        u = -2.0 * dipole * p1 * p2 + side * (m[:, 1] + self._bounce * m[:, 3])
        return bounded_stokes(radiance, q, u)

    def _stencils(self):
        """Weights other than zero of the nodes: altitudes and visibilities, {index: weight}."""
        head, conditions = self._head, self.conditions
        altitudes = node_weights(np.cbrt(head.altitude), np.cbrt([conditions.altitude]))
        visibilities = node_weights(-1.0 / head.visibility, [-1.0 / conditions.visibility])
        return _nonzero(altitudes[0]), _nonzero(visibilities[0])

    def _elevation_coordinate(self):
        head = self._head

        def warp(x):
            return np.arcsinh((x - head.elevation_centre) / head.elevation_width)

        low, high = warp(head.elevation_min), warp(head.elevation_max)
        if not high > low:
            raise InvalidValueError("the elevation axis has no extent")
        share = (warp(self.conditions.solar_elevation) - low) / (high - low)
        return np.array([head.counts["ne"] * share])

    def _require_radiance(self):
        self._require_pairs(_head.RADIANCE, _head.RADIANCE_BASIS)
        if not self._head.has_estimates:
            for j in self._altitudes:
                self._chunks.require_present(_head.COLUMN, j)

    def _load_column(self):
        """ln of mean profiles at the conditions: (nu+3 + nd+3, nk)."""
        columns = {j: self._chunks.get(_head.COLUMN, j) for j in self._altitudes}
        return sum(a * columns[j].astype(np.float64) for j, a in self._altitudes.items())

    def _load_estimates(self):
        tables = self._chunks.get(_head.ESTIMATE)
        return Estimates(tables, self._observer, self._sun, self._extinction)

    def _require_polarisation(self):
        self._require_pairs(_head.POLARISATION, _head.POLARISATION_BASIS)

    @cached_property
    def _polarisation(self):
        return self._combine(_head.POLARISATION, _head.POLARISATION_BASIS)[0]

    def _pairs(self):
        for j, a in self._altitudes.items():
            for m, b in self._visibilities.items():
                yield j, m, a * b

    def _require_pairs(self, kind, basis_kind):
        self._chunks.require_present(basis_kind)
        for j, m, _ in self._pairs():
            self._chunks.require_present(kind, j, m)

    def _combine(self, kind, basis_kind):
        """Factors and ln S of the chunks around the conditions."""
        counts = self._head.counts
        basis = self._chunks.get(basis_kind)
        chunks = [(self._chunks.get(kind, j, m), weight) for j, m, weight in self._pairs()]
        # Not the rank of the basis: the chunks may be much smaller, and memory has to follow them.
        used = max(len(chunk.scale) for chunk, _ in chunks)
        up = np.zeros((counts["nu"] + 3, used))
        down = np.zeros((counts["nd"] + 3, used))
        level = 0.0
        for chunk, weight in chunks:
            rank = len(chunk.scale)
            spline = free_spline(self._elevation, chunk.elevation.astype(np.float64))[0]
            share = weight * spline * chunk.scale
            up[:, :rank] += share * chunk.up
            down[:, :rank] += share * chunk.down
            if chunk.level is not None:
                level = level + weight * free_spline(self._elevation, chunk.level.astype(float))[0]
        phi = faded_rows(basis.phi[:, :used], self._fade)
        return Factors(up, down, phi, basis.channel[:used]), level


class _View:
    """Unit vectors (N, 3) and what follows from them: coordinates on the axes, angles, lengths."""

    def __init__(self, sky, units):
        head, observer, conditions = sky._head, sky._observer, sky.conditions
        self.angle = Angle(units, sky._sun)
        self.elevation = elevation_of(units)
        self.phi = azimuth_from_sun(units, conditions.solar_azimuth)
        self.phi_coordinate = head.counts["np"] * (np.abs(self.phi) / np.pi)
        above = self.elevation + observer.dip
        self.is_up = above >= 0.0
        self.ray_length = observer.ray_length(self.elevation, self.is_up)
        self._solar_elevation = conditions.solar_elevation
        share_up = np.maximum(above, 0.0) / (np.pi / 2 + observer.dip)
        share_down = np.maximum(-above, 0.0) / (np.pi / 2 - observer.dip)
        self._up = head.counts["nu"] * share_up ** (1.0 / head.alpha_up_exponent)
        self._down = head.counts["nd"] * share_down ** (1.0 / head.alpha_down_exponent)

    def by_side(self, up, down):
        """Values (N, M) of the spline `up` above the horizon and of `down` below it."""
        values = np.empty((len(self.is_up), up.shape[1]))
        values[self.is_up] = free_spline(self._up[self.is_up], up)
        values[~self.is_up] = free_spline(self._down[~self.is_up], down)
        return values

    @property
    def sun_across(self):
        """Components (N, 1) of the sun's direction along e1 and e2 of the vertical frame."""
        p1, p2 = sun_across(self.elevation, self._solar_elevation, self.phi)
        return p1[:, None], p2[:, None]


def _nonzero(weights):
    return {int(i): float(weights[i]) for i in np.flatnonzero(weights)}


def _require_finite(values):
    if not np.all(np.isfinite(values)):
        raise InvalidValueError("numbers of the file overflow")
