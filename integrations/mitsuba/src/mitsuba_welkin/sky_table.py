"""A baked sky in arrays of Dr.Jit: the formulae of welkin's `SkyBuffers` and nothing else."""

import drjit as dr
import mitsuba as mi

from .variants import gather, storage


def _taps(x, intervals):
    """The first of four coefficients and the weights of them on an axis of so many intervals."""
    place = x * intervals
    cell = dr.clip(dr.floor(place), 0.0, intervals - 1.0)
    t = place - cell
    s = 1.0 - t
    inner = lambda t: dr.fma(t * t, 3.0 * t - 6.0, 4.0)
    sixth = 1.0 / 6.0
    return mi.UInt32(cell), (s * s * s * sixth, inner(t) * sixth, inner(s) * sixth, t * t * t * sixth)


class Place:
    """Where a direction is looked up: what all channels share."""

    def __init__(self, first, rows, columns, envelope, stride, opacity, sine):
        self.first = first
        self.rows = rows
        self.columns = columns
        self.envelope = envelope
        self.stride = stride
        self.opacity = opacity
        self.sine = sine


class SkyTable:
    """Evaluates a baked sky. Directions are unit vectors in welkin's frame: +z up."""

    def __init__(self, buffers):
        h = buffers
        self.channels = int(h["channels"])
        up, down, azimuth = (int(n) for n in h["intervals"])
        # Opaque: skies of other sizes need no new kernels.
        index = lambda v: dr.opaque(mi.UInt32, int(v))
        self.polarised = h["polarisation"] is not None
        opaque = lambda v: dr.opaque(mi.Float, float(v))
        self.up, self.down, self.across = opaque(up), opaque(down), opaque(azimuth)
        self.sun_intervals, self.envelope_stride = opaque(h["sun_intervals"]), index(int(h["sun_intervals"]) + 3)
        self.crowding = [opaque(v) for v in h["crowding"]]
        self.pole = opaque(h["pole"])
        self.sun = mi.Vector3f(*[opaque(v) for v in h["sun"]])
        self.horizon = opaque(h["horizon"])
        self.azimuth = [opaque(v) for v in h["azimuth"]]
        self.shrink = [opaque(v) for v in h["shrink"]]
        self.opaque = opaque(h["opaque"])
        self.stride, self.rows_above = index(azimuth + 3), index(up + 3)
        self.size = index((up + down + 6) * (azimuth + 3))
        self.envelope = storage(h["envelope"])
        self.cells = storage(h["cells"])
        self.scale = storage(h["scale"])
        self.polarisation = storage(h["polarisation"]) if self.polarised else None

    def locate(self, d):
        side = d.z - self.horizon
        above = side >= 0.0
        pick = lambda pair: dr.select(above, pair[0], pair[1])
        shrink, crowding = pick(self.shrink), pick(self.crowding)
        sine = dr.sqrt(dr.minimum(dr.abs(side) * shrink, 1.0))
        z = dr.select(above, d.z, -d.z)
        cosine = dr.sqrt(dr.clip((1.0 - z) * shrink, 0.0, 1.0))
        row = dr.fma(sine, crowding, sine) / (dr.fma(crowding, sine, 1.0) + self.pole * cosine)
        cos_phi, sin_phi = self._azimuth(d)
        chord = dr.norm(d - self.sun)
        root = dr.sqrt(dr.maximum((d.z + self.horizon) * (d.z - self.horizon), 0.0)) + dr.abs(d.z)
        opacity = dr.select(above, 1.0, self.opaque / dr.maximum(self.opaque + root, 1e-20))
        first_row, rows = _taps(row, dr.select(above, self.up, self.down))
        first_row += dr.select(above, mi.UInt32(0), self.rows_above)
        first_column, columns = _taps(dr.sqrt(dr.clip(0.5 - 0.5 * cos_phi, 0.0, 1.0)), self.across)
        envelope = _taps(dr.minimum(0.5 * chord, 1.0), self.sun_intervals)
        return Place(first_row * self.stride + first_column, rows, columns, envelope, self.stride, opacity, sin_phi)

    def _azimuth(self, d):
        square = dr.fma(d.x, d.x, d.y * d.y)
        shrink = dr.rsqrt(dr.maximum(square, 1e-38))
        flat = square > 1e-38
        c, s = self.azimuth
        cos_phi = dr.select(flat, dr.fma(d.x, c, d.y * s) * shrink, 1.0)
        sin_phi = dr.select(flat, dr.fma(d.y, c, -(d.x * s)) * shrink, 0.0)
        return cos_phi, sin_phi

    def _surface(self, place, cells, base, active):
        """The bicubic spline whose coefficients start at `base`, a number of floats."""
        total = mi.Float(0.0)
        for r, weight in enumerate(place.rows):
            row = mi.Float(0.0)
            for c, other in enumerate(place.columns):
                cell = place.first + (r * place.stride + c)
                row = dr.fma(other, gather(cells, base + 4 * cell, active), row)
            total = dr.fma(weight, row, total)
        return total

    def value(self, place, channel, active=True):
        """A channel: an index, or an array of them."""
        channel = mi.UInt32(channel)
        group, lane = channel >> 2, channel & 3
        first, weights = place.envelope
        base = 4 * (group * self.envelope_stride + first) + lane
        logarithm = self._surface(place, self.cells, 4 * group * self.size + lane, active)
        for k, weight in enumerate(weights):
            logarithm = dr.fma(weight, gather(self.envelope, base + 4 * k, active), logarithm)
        scale = gather(self.scale, channel, active)
        return dr.exp2(logarithm) * place.opacity * scale

    def degrees(self, place, channel, active=True):
        """Q/I and U/I in the vertical frame of welkin."""
        channel = mi.UInt32(channel)
        group, lane = channel >> 2, channel & 3
        part = lambda k: self._surface(
            place, self.polarisation, 4 * (2 * group + k) * self.size + lane, active)
        q, u = part(0), part(1) * place.sine
        shrink = 1.0 / dr.maximum(dr.sqrt(dr.fma(q, q, u * u)), 1.0)
        return q * shrink, u * shrink
