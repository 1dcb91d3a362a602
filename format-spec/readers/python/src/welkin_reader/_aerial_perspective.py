"""Light that the air of segments scatters towards the observer (sections 6.5, 6.8 and 7.7)."""

from dataclasses import dataclass

import numpy as np

from . import _head
from ._axes import linear_weights, node_weights
from ._geometry import SOLAR_RADIUS, azimuthal_fade, elevation_of, horizon_dip, sun_across, sun_vector
from ._head import PHASE_RAYLEIGH, check_phase, require, require_increasing, require_within
from ._phase import Angle, phase_function, rayleigh_share
from ._transmittance import altitude_on_line, path_integrals, profile_at

TENSOR = 4
_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True)
class Source:
    """Source function at one visibility (6.5), the core with its scale."""

    phase: tuple
    parameter: np.ndarray
    scattering: np.ndarray
    level: np.ndarray
    core: np.ndarray


@dataclass(frozen=True)
class SourceBasis:
    """What all source chunks share (6.8)."""

    ranks: tuple
    orders: int
    degree: int
    altitude: np.ndarray
    sun: np.ndarray
    altitude_factor: np.ndarray
    sun_factor: np.ndarray
    moment_factor: np.ndarray
    channel_factor: np.ndarray


def decode_source(payload, entry, head):
    nw, nk = head.counts["nw"], head.counts["nk"]
    species, suns = map(int, payload.take("<u4", 2))
    ranks = _take_ranks(payload)
    require(1 <= species <= 16, "species outside 1 to 16")
    require(2 <= suns <= 256, "suns outside 2 to 256")
    scale = float(payload.take("<f4", 1)[0])
    payload.take("<u4", 1)
    phase = tuple(int(code) for code in payload.take("<u4", species))
    parameter = payload.take("<f4", species, nw).astype(np.float64)
    scattering = payload.take("<f4", species, nk, nw).astype(np.float64)
    level = payload.take("<f4", 2, suns, nw).astype(np.float64)
    core = payload.take("<f2", *ranks)
    payload.end()
    for code, row in zip(phase, parameter):
        require(code != _head.PHASE_NONE, "a species without phase function")
        check_phase(code, row)
    require_within(scattering, 0.0, 1e6, "scattering")
    return Source(phase, parameter, scattering, level, scale * core.astype(np.float64))


def decode_source_basis(payload, entry, head):
    altitudes, suns, degree, orders = map(int, payload.take("<u4", 4))
    ranks = _take_ranks(payload)
    require(2 <= altitudes <= 256, "altitudes outside 2 to 256")
    require(2 <= suns <= 256, "suns outside 2 to 256")
    require(degree <= 24 and orders <= degree, "degree above 24 or orders above degree")
    nodes = altitudes * head.counts["nw"] * ranks[2]
    require(nodes <= 1 << 18, "too many altitudes, wavelengths and moments")
    moments = TENSOR + len(_harmonics(degree, orders))
    altitude = payload.take("<f8", altitudes)
    sun = payload.take("<f8", suns)
    tables = [
        payload.take("<f4", rows, rank).astype(np.float64)
        for rows, rank in zip((altitudes, suns, moments, 2 * head.counts["nw"]), ranks)
    ]
    payload.end()
    require_within(altitude, 0.0, 1e9, "altitude of the source")
    require(np.all(np.diff(altitude) >= 1e-3), "altitudes of the source increase by less than 1 mm")
    require_increasing(np.cbrt(altitude), "cube root of altitude")
    require_within(sun, -1.0, 1.0, "sun")
    require(np.all(np.diff(sun) >= 1e-9), "suns increase by less than 1e-9")
    return SourceBasis(ranks, orders, degree, altitude, sun, *tables)


def _take_ranks(payload):
    ranks = tuple(map(int, payload.take("<u4", 4)))
    require(all(1 <= rank <= 64 for rank in ranks), "rank of the source outside 1 to 64")
    require(ranks[2] <= 32, "rank of the source's moments above 32")
    return ranks


def _harmonics(degree, orders):
    """(l, m) in the order of the file."""
    return [(l, m) for m in range(orders + 1) for l in range(m, degree + 1)]


def _harmonic_values(degree, orders, cos_theta, phi, fade):
    """N_lm P_lm(cos θ) f^m cos mφ: (P, nh)."""
    sin_theta = np.sqrt(np.maximum(0.0, 1.0 - cos_theta**2))
    diagonal = np.full_like(cos_theta, np.sqrt(0.25 / np.pi))
    columns = []
    for m in range(orders + 1):
        if m > 0:
            diagonal = np.sqrt((2 * m + 1) / (2 * m)) * sin_theta * diagonal
        azimuthal = np.sqrt(2.0) * fade**m * np.cos(m * phi) if m > 0 else 1.0
        before, value = 0.0, diagonal
        for l in range(m, degree + 1):
            columns.append(value * azimuthal)
            before, value = value, _next_legendre(l + 1, m, cos_theta, value, before)
    return np.stack(columns, axis=1)


def _next_legendre(l, m, x, value, before):
    """N_lm P_lm from those of the degrees l − 1 and l − 2."""
    a = np.sqrt((4 * l * l - 1) / (l * l - m * m))
    b = np.sqrt(((l - 1) ** 2 - m * m) / (4 * (l - 1) ** 2 - 1)) if l > m + 1 else 0.0
    return a * (x * value - b * before)


class AerialPerspective:
    """The light that air scatters in one scene."""

    @np.errstate(all="ignore")
    def __init__(self, head, chunks, conditions, altitude):
        self._head = head
        self.altitude = altitude
        inverse = -1.0 / head.visibility, [-1.0 / conditions.visibility]
        cubic, linear = node_weights(*inverse)[0], linear_weights(*inverse)[0]
        sources = self._load(chunks, cubic)
        self._profiles = chunks.get(_head.TRANSMITTANCE)
        self._phase = next(iter(sources.values())).phase
        self._mix = [(cubic[m], source) for m, source in sources.items()]
        self._level = sum(weight * source.level[0] for weight, source in self._mix)
        near = {m: sources[m] for m in map(int, np.flatnonzero(linear))}
        self._parameter = sum(linear[m] * source.parameter for m, source in near.items())
        self._scattering = sum(linear[m] * source.scattering for m, source in near.items())
        self._extinction = np.tensordot(linear, head.extinction, 1)
        albedo = conditions.albedo
        self._bounce = albedo / (1.0 - albedo * (linear @ head.spherical_albedo))
        self._sun = sun_vector(conditions.solar_elevation, conditions.solar_azimuth)

    def _load(self, chunks, weights):
        used = [int(m) for m in np.flatnonzero(weights)]
        chunks.require_present(_head.TRANSMITTANCE)
        chunks.require_present(_head.SOURCE_BASIS)
        for m in used:
            chunks.require_present(_head.SOURCE, visibility=m)
        self._basis = chunks.get(_head.SOURCE_BASIS)
        sources = {m: chunks.get(_head.SOURCE, visibility=m) for m in used}
        first = sources[used[0]]
        for source in sources.values():
            fits = source.core.shape == self._basis.ranks
            fits = fits and source.level.shape[1] == len(self._basis.sun)
            require(fits, "a source chunk does not fit the basis")
            require(source.phase == first.phase, "source chunks have different species")
        return sources

    @property
    def block(self):
        """How many directions to evaluate at once."""
        ra, rs, rm, rc = self._basis.ranks
        axes = len(self._basis.altitude), len(self._basis.sun)
        widest = max(ra * rs, rm * rc, len(self._basis.moment_factor), *axes)
        return max(1, (1 << 20) // (64 * widest))

    def in_scattering(self, units, distance):
        """L, Q, U (N, 3, nw), sr⁻¹, of segments along units (N, 3), of lengths (N,) in m."""
        along, weights = self._quadrature(units, distance)
        n, q = along.shape
        points = _Points(self, np.repeat(units, q, axis=0), along.ravel())
        through = self._transmittance_from_observer(units, along)
        light = through[:, None, :] * self._emission(points)
        return np.sum(weights[:, :, None, None] * light.reshape(n, q, 3, -1), axis=1)

    def _quadrature(self, units, distance):
        """Distances (N, Q) of points from the observer, and their weights in m.

        Intervals shrink towards the observer and towards the lowest point, where most light is.
        """
        radius, h = self._head.planet_radius, self.altitude
        top = self._head.top_altitude
        start = (radius + h) * units[:, 2]
        to_top = (top - h) * (2.0 * radius + top + h)
        chord = np.sqrt(np.maximum(0.0, start**2 + to_top))
        first = np.clip(-start - chord, 0.0, distance)[:, None]
        last = np.clip(-start + chord, first[:, 0], distance)[:, None]
        lowest, span = np.clip(-start[:, None], first, last), last - first
        halves = 0.5 ** np.arange(1, 9)
        marks = [first, first + span * 0.25**2 * halves, first + span * halves[:5], lowest, last]
        marks += [lowest - span * halves, lowest + span * halves]
        marks = np.sort(np.clip(np.concatenate(marks, axis=1), first, last), axis=1)
        middle, half = 0.5 * (marks[:, 1:] + marks[:, :-1]), 0.5 * np.diff(marks, axis=1)
        along = middle[:, :, None] + half[:, :, None] * _GAUSS_NODES
        weights = half[:, :, None] * _GAUSS_WEIGHTS
        return along.reshape(len(units), -1), weights.reshape(len(units), -1)

    def _transmittance_from_observer(self, units, along):
        rise = np.repeat(units[:, 2], along.shape[1])
        return self._transmittance(self.altitude, rise, along.ravel())

    def _transmittance(self, altitude, rise, distance):
        radius = self._head.planet_radius
        columns = path_integrals(self._profiles, radius, altitude, rise, distance)
        return np.exp(-(columns @ self._extinction))

    def _emission(self, points):
        """L, Q, U per metre (P, 3, nw) of what the air at points sends towards the observer."""
        air = profile_at(self._profiles, self._head.planet_radius, points.altitude)
        sunlight = self._sunlight(points) / (4.0 * np.pi)
        p1, p2 = points.sun_across
        molecules, q, u, particles = self._sources(points)
        light, polarised = 0.0, [0.0, 0.0]
        for p, code in enumerate(self._phase):
            coefficient = air @ self._scattering[p]
            once = phase_function(code, self._parameter[p], points.angle) * sunlight
            if code == PHASE_RAYLEIGH:
                light = light + coefficient * (once + molecules)
                dipole = 0.75 * rayleigh_share(self._parameter[p]) * sunlight
                polarised[0] = polarised[0] + coefficient * (dipole * (p2**2 - p1**2) + q)
                polarised[1] = polarised[1] + coefficient * (-2.0 * dipole * p1 * p2 + u)
            else:
                light = light + coefficient * (once + particles)
        return np.stack(np.broadcast_arrays(light, *polarised), axis=1)

    def _sunlight(self, points):
        """D: share of the sun's disc above the horizon times transmittance to space: (P, nw)."""
        elevation = np.arcsin(np.clip(points.sin_sun, -1.0, 1.0))
        dip = horizon_dip(self._head.planet_radius, points.altitude)
        c = np.clip((elevation + dip) / SOLAR_RADIUS, -1.0, 1.0)
        area = 0.5 * np.pi + c * np.sqrt(1.0 - c * c) + np.arcsin(c)
        visible = area > 0.0
        centroid = (2.0 / 3.0) * (1.0 - c * c) ** 1.5 / np.where(visible, area, 1.0)
        rise = np.sin(elevation + SOLAR_RADIUS * centroid)
        space = self._transmittance(points.altitude, rise, np.inf)
        return np.where(visible, area / np.pi, 0.0)[:, None] * space

    def _sources(self, points):
        """S_R, Q_R, U_R of molecules and S_A of particles: (P, nw) each."""
        basis = self._basis
        ra, rs, rm, rc = basis.ranks
        a = _at_nodes(np.cbrt(basis.altitude), np.cbrt(points.altitude)) @ basis.altitude_factor
        sun_weights = _at_nodes(np.arcsinh(12.5 * basis.sun), np.arcsinh(12.5 * points.sin_sun))
        pairs = (a[:, :, None] * (sun_weights @ basis.sun_factor)[:, None, :]).reshape(-1, ra * rs)
        nw = self._head.counts["nw"]
        channels = basis.channel_factor[:nw], basis.channel_factor[nw:]
        sides = [moments @ basis.moment_factor[:TENSOR] for moments in points.tensor_moments]
        sides.append(points.harmonics(basis) @ basis.moment_factor[TENSOR:])
        sums = [0.0] * len(sides)
        for weight, source in self._mix:
            tensor = (pairs @ source.core.reshape(ra * rs, rm * rc)).reshape(-1, rm, rc)
            ground = self._bounce * np.exp(sun_weights @ (source.level[1] - source.level[0]))
            for side, moments in enumerate(sides):
                light = np.einsum("pb,pbc->pc", moments, tensor)
                light = light @ channels[0].T + ground * (light @ channels[1].T)
                sums[side] = sums[side] + weight * light
        level = np.exp(sun_weights @ self._level)
        molecules, q, u, particles = (level * light for light in sums)
        return np.maximum(0.0, molecules), q, u, np.maximum(0.0, particles)


def _at_nodes(nodes, x):
    """Weights (P, n) by the rule *between chunks*, beyond the ends those of the end."""
    return node_weights(nodes, np.clip(x, nodes[0], nodes[-1]))


class _Points:
    """Points on lines of sight, with the local directions of the view and of the sun there."""

    def __init__(self, aerial, units, along):
        radius, h = aerial._head.planet_radius, aerial.altitude
        rise = units[:, 2]
        self.altitude = np.maximum(0.0, altitude_on_line(radius, h, rise, along))
        self.angle = Angle(units, aerial._sun)
        position = along[:, None] * units
        position[:, 2] += radius + h
        up = position / np.linalg.norm(position, axis=1, keepdims=True)
        self.sin_sun = up @ aerial._sun
        self.cos_view = np.sum(up * units, axis=1)
        self.phi = _azimuth(up, units, aerial._sun)
        self.fade = azimuthal_fade(np.linalg.norm(np.cross(up, aerial._sun), axis=1))
        start = _azimuth(np.array([[0.0, 0.0, 1.0]]), units, aerial._sun)
        elevation = elevation_of(units), np.arctan2(aerial._sun[2], np.hypot(*aerial._sun[:2]))
        self.sun_across = [part[:, None] for part in sun_across(*elevation, start)]

    @property
    def tensor_moments(self):
        """Factors of M_xx, M_yy, M_zz and M_xz in S_R, Q_R and U_R: (P, 4) each."""
        cos = self.cos_view
        sin = np.sqrt(np.maximum(0.0, 1.0 - cos**2))
        cos_phi, sin_phi = self.fade * np.cos(self.phi), self.fade * np.sin(self.phi)
        double = cos_phi**2 - sin_phi**2
        cos2, sin2 = 0.5 * (1.0 + double), 0.5 * (1.0 - double)
        xx, yy = cos**2 * cos2, cos**2 * sin2
        zz, xz = sin**2, -2.0 * sin * cos * cos_phi
        mixed = 2.0 * cos * sin_phi * cos_phi
        return (
            np.stack([xx + sin2, yy + cos2, zz, xz], axis=1),
            np.stack([xx - sin2, yy - cos2, zz, xz], axis=1),
            np.stack([-mixed, mixed, 0.0 * mixed, 2.0 * sin * sin_phi], axis=1),
        )

    def harmonics(self, basis):
        return _harmonic_values(basis.degree, basis.orders, self.cos_view, self.phi, self.fade)


def _azimuth(up, units, sun):
    """Azimuth (P,) of the view less that of the sun, counter-clockwise around `up`; 0 where there is none."""
    view = units - np.sum(up * units, axis=1, keepdims=True) * up
    light = sun - (up @ sun)[:, None] * up
    lengths = np.linalg.norm(view, axis=1) * np.linalg.norm(light, axis=1)
    turn = np.sum(up * np.cross(light, view), axis=1)
    return np.where(lengths > 1e-12, np.arctan2(turn, np.sum(view * light, axis=1)), 0.0)
