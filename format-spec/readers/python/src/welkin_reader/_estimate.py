"""Estimates of the light along rays, which the fields of some files are relative to (6.10, 7.2)."""

from dataclasses import dataclass

import numpy as np

from . import _head
from ._axes import interval
from ._disc import panel_share, visible_height
from ._geometry import SOLAR_RADIUS, horizon_dip
from ._head import require, require_within, round_up
from ._stops import Rays

_ROW = 8
"""Columns of tables that have one for each constituent."""
_MAX_WAVELENGTHS = 64
_SCALE_HEIGHT = 8000.0
_BEND = 0.1
"""Angle in rad below which columns are dense."""
_DIFFUSE_SHARE = 0.001
"""Share of diffuse light in the estimates of sunlight."""


@dataclass(frozen=True)
class Estimate:
    """The estimate chunk, without padding.

    level (n_l,), ring (n_r,), albedo (n_q, nk, nw) that is 0 for what does not scatter,
    density (n_d, nk), column (n_l, n_a, nk), light (n_l, n_s, nw).
    """

    sun_lowest: float
    sun_width: float
    level: np.ndarray
    ring: np.ndarray
    albedo: np.ndarray
    density: np.ndarray
    column: np.ndarray
    light: np.ndarray

    def sun_coordinate(self, sine):
        """Place on the axis of suns, 0..=1 from the lowest to the highest."""
        low, high = (np.arcsinh(m / self.sun_width) for m in (self.sun_lowest, 1.0))
        return (np.arcsinh(sine / self.sun_width) - low) / (high - low)

    def logarithm(self, table, altitude, place):
        """`table` between levels and along its second axis, a place 0..=1: (N, S) → (N, S, M)."""
        i, s = interval(self.level, altitude)
        j, t = _locate(place, table.shape[1])
        low, high = (_between(table[k, j], table[k, j + 1], t) for k in (i, i + 1))
        return _between(low, high, s)


class Estimates:
    """The estimates of one scene; extinction (nk, nw)."""

    def __init__(self, tables, observer, sun, extinction):
        self._tables = tables
        self._observer = observer
        self._sun = sun
        self._extinction = extinction
        self._scattering = tables.albedo * extinction

    @property
    def width(self):
        """Numbers that an intermediate array has for each ray, at most."""
        stops = 4 + 2 * (len(self._tables.level) - 1) + 2 * len(self._tables.ring)
        return stops * max(self._extinction.shape)

    def along(self, view):
        """Estimates along the views: (N, n_q, nw)."""
        tables = self._tables
        rays = Rays(self._observer, self._sun, view)
        distance = rays.stops(tables.level[1:], tables.ring)
        altitude = rays.altitude(distance)
        sine = rays.solar_sine(distance, altitude)
        dip = horizon_dip(self._observer.planet_radius, altitude)
        x = (np.arcsin(sine) + dip) / SOLAR_RADIUS
        share = panel_share(x[:, :-1], x[:, 1:], np.diff(altitude, axis=1) / _SCALE_HEIGHT)
        columns = self._panel_columns(rays, distance, altitude)
        passed = np.zeros((*distance.shape, columns.shape[2]))
        np.cumsum(columns, axis=1, out=passed[:, 1:])
        depth = self._depth(passed)
        lit = depth + self._depth(self._columns_to_sun(altitude, x, dip))
        sunlight = share[..., None] * _panel_means(lit) / (4.0 * np.pi)
        diffuse = depth - tables.logarithm(tables.light, altitude, tables.sun_coordinate(sine))
        return self._sums(columns, sunlight, _panel_means(diffuse))

    def _density(self, altitude):
        """Profiles of the constituents: (N, S) → (N, S, nk)."""
        table = self._tables.density
        i, t = _locate(np.sqrt(altitude / self._observer.top_altitude), len(table))
        return _between(table[i], table[i + 1], t)

    def _panel_columns(self, rays, distance, altitude):
        """ΔC of the panels: (N, S − 1, nk)."""
        middles = 0.5 * (distance[:, :-1] + distance[:, 1:])
        stops, middle = self._density(altitude), self._density(rays.altitude(middles))
        mean = (stops[:, :-1] + 4.0 * middle + stops[:, 1:]) / 6.0
        return np.diff(distance, axis=1)[..., None] * mean

    def _columns_to_sun(self, altitude, x, dip):
        """D at the stops: (N, S, nk)."""
        tables, radius = self._tables, self._observer.planet_radius
        seen = np.maximum(0.0, visible_height(x))
        i, s = interval(tables.level, altitude)

        def at(level):
            own = horizon_dip(radius, tables.level)[level]
            angle = np.maximum(0.0, seen * SOLAR_RADIUS + (own - dip) * seen / (seen + 1.0))
            range_ = np.pi / 2 + own
            place = angle * (range_ + _BEND) / (range_ * (angle + _BEND))
            j, t = _locate(place, tables.column.shape[1])
            return _between(tables.column[level, j], tables.column[level, j + 1], t)

        return np.exp(_between(at(i), at(i + 1), s))

    def _depth(self, columns):
        """Optical depths: (N, S, nk) → (N, S, nw). What does not scatter dims, too."""
        return np.tensordot(columns, self._extinction, 1)

    def _sums(self, columns, sunlight, diffuse):
        def over_panels(scattering, light):
            return np.einsum("npw,npw->nw", np.tensordot(columns, scattering, 1), light)

        *others, last = self._scattering
        background = over_panels(last, diffuse)
        sums = [over_panels(other, sunlight) + _DIFFUSE_SHARE * background for other in others]
        return np.stack([*sums, background], axis=1)


def _locate(place, nodes):
    """Index of the node before, and the part up to the next one, of places 0..=1."""
    u = np.clip(place, 0.0, 1.0) * (nodes - 1)
    i = np.minimum(u.astype(np.intp), nodes - 2)
    return i, u - i


def _between(low, high, t):
    return low + t[..., None] * (high - low)


def _panel_means(exponent):
    """M: means of exp(−exponent) over panels, in which it is linear: (N, S, nw) → (N, S − 1, nw)."""
    first, last = exponent[:, :-1], exponent[:, 1:]
    span = np.abs(last - first)
    mean = np.where(span > 0.0, -np.expm1(-span) / np.where(span > 0.0, span, 1.0), 1.0)
    return np.exp(-np.minimum(first, last)) * mean


def decode_estimate(payload, entry, head):
    nk, nw = head.counts["nk"], head.counts["nw"]
    require(nk <= _ROW, "more than 8 constituents in a file with estimates")
    require(nw <= _MAX_WAVELENGTHS, "more than 64 wavelengths in a file with estimates")
    levels, angles, suns, densities, rings, estimates = map(int, payload.take("<u4", 6))
    require(2 <= levels <= 24, "levels outside 2 to 24")
    require(2 <= angles <= 256, "angles outside 2 to 256")
    require(2 <= suns <= 256, "suns of the estimate outside 2 to 256")
    require(2 <= densities <= 4096, "densities outside 2 to 4096")
    require(rings <= 4, "more than 4 rings")
    require(1 <= estimates <= _head.MAX_ESTIMATES, "estimates outside 1 to 4")
    padded = round_up(nw, 8)
    lowest, width = map(float, payload.take("<f4", 2))
    level, ring = (payload.take("<f4", count).astype(np.float64) for count in (levels, rings))
    scatters = payload.take("<u4", estimates)
    albedo = payload.take("<f4", estimates, nk, padded)[..., :nw]
    density = payload.take("<f4", densities, _ROW)[:, :nk]
    column = payload.take("<f4", levels, angles, _ROW)[..., :nk]
    light = payload.take("<f4", levels, suns, padded)[..., :nw]
    payload.end()
    require(np.all(head.field_estimate < estimates), "a field is relative to an unknown estimate")
    require_within(lowest, -1.0, 0.0, "lowest sun")
    require_within(width, 1e-3, 1e3, "width of the axis of suns")
    _check_altitudes(level, ring, head.top_altitude)
    require(np.all(scatters >> nk == 0), "an unknown constituent scatters in an estimate")
    require_within(albedo, 0.0, 1.0, "albedo of an estimate")
    require_within(density, 0.0, 1e6, "density of an estimate")
    require_within(column, -80.0, 80.0, "column")
    require_within(light, -80.0, 80.0, "light")
    among = (scatters[:, None] >> np.arange(nk, dtype=np.uint32)) & 1
    tables = [table.astype(np.float64) for table in (density, column, light)]
    return Estimate(lowest, width, level, ring, albedo * among[..., None].astype(np.float64), *tables)


def _check_altitudes(level, ring, top):
    require(level[0] == 0.0, "the first level is not the ground")
    require(level[-1] == np.float32(top), "the last level is not the top")
    require(np.all(np.diff(level) >= 1e-3), "levels increase by less than 1 mm")
    require_within(ring, 0.0, np.float32(top), "ring")
