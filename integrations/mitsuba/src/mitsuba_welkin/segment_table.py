"""In-scattered light and transmittance of paths, looked up in arrays of Dr.Jit."""

import drjit as dr
import mitsuba as mi
import numpy as np

from . import path_geometry
from .body import between_wavelengths, from_xyz
from .sources import COUNT
from .variants import gather_packet, storage


def packets(values, spectral):
    """(nodes…, wavelengths, parts) → a storage in which what one lookup needs is together, and how many numbers that is. With
    wavelengths: those of neighbours."""
    nodes = values.shape[:-2]
    if spectral:
        values = np.stack([values[..., :-1, :], values[..., 1:, :]], -2)
        parts = 4 if values.shape[-1] > 2 else values.shape[-1]
        packed = np.zeros((*nodes, COUNT - 1, 2, parts), np.float32)
        packed[..., : values.shape[-1]] = values
        return storage(packed), 2 * parts
    packed = np.zeros((*nodes, 4), np.float32)
    packed[..., : values.shape[-2]] = values[..., 0]
    return storage(packed), 4


class Taps:
    """Nodes about a place and their weights: the product of pairs on each axis."""

    def __init__(self, indices):
        self.pairs = [(mi.UInt32(0), mi.Float(1.0))]
        for (first, t), stride in indices:
            self.pairs = [
                (node + (first + k) * stride, weight * (t if k else 1.0 - t))
                for node, weight in self.pairs for k in (0, 1)]

    def of(self, source, size, scale, offset, active):
        total = [mi.Float(0.0)] * size
        for node, weight in self.pairs:
            packet = gather_packet(source, size, node * scale + offset, active)
            total = [dr.fma(weight, value, sum_) for value, sum_ in zip(packet, total)]
        return total


def cell(x, nodes):
    """The lower node and the share of the upper; none of an axis with one node."""
    if nodes == 1:
        return mi.UInt32(0), None
    place = dr.clip(x * (nodes - 1), 0.0, nodes - 1.0)
    first = dr.minimum(dr.floor(place), nodes - 2.0)
    return mi.UInt32(first), place - first


class SegmentTable:
    """Light from the sun or the moon along paths that start anywhere in the extent; `scale` counts for the light."""

    def __init__(self, light, transmittance, scale):
        self.extent, self.fine = light.extent, transmittance.extent
        # Opaque: scenes and cameras elsewhere need no new kernels.
        opaque = lambda v: dr.opaque(mi.Float, float(v))
        self.floor, self.far, self.low = opaque(light.extent.floor), opaque(light.extent.far), opaque(light.extent.low)
        self.shrink = opaque(1.0 / max(light.extent.high - light.extent.low, 1.0))
        self.spectral = mi.is_spectral or mi.is_polarized
        self.source, self.source_size = packets(light.source, self.spectral)
        # Extinction does not depend on the azimuth.
        self.extinction, self.extinction_size = packets(
            transmittance.extinction[:, :, 0, :, :, None], self.spectral)
        self.scale = scale

    def locate(self, altitude, mu, length, turn):
        """`turn`: the azimuth from the light, absolute, rad."""
        e = self.extent
        edge = path_geometry.horizon(dr, altitude, self.floor, e.planet)
        whole = path_geometry.reach(dr, altitude, mu, self.floor, e.planet, self.far)
        v = path_geometry.row(dr, mu, edge)
        share = dr.sqrt(dr.minimum(length / whole, 1.0))
        height = (altitude - self.low) * self.shrink

        def taps(extent, with_azimuth):
            sizes = [extent.heights, 2 * extent.rows, extent.azimuths if with_azimuth else 1, extent.lengths]
            strides = [sizes[1] * sizes[2] * sizes[3], sizes[2] * sizes[3], sizes[3], 1]
            first, t = cell(dr.select(v < 0.0, v + 1.0, v), extent.rows)
            rows = first + dr.select(v < 0.0, mi.UInt32(0), mi.UInt32(extent.rows)), t
            axes = [cell(height, sizes[0]), rows, cell(turn * dr.inv_pi, sizes[2]), cell(share, sizes[3])]
            return Taps([(axis, stride) for axis, stride in zip(axes, strides) if axis[1] is not None])

        return taps(e, True), taps(self.fine, False)

    def wavelengths(self, wavelengths, active):
        return [between_wavelengths(w, active) for w in wavelengths]

    def optical_depths(self, taps, length, wavelengths, active):
        """At the wavelengths; of colours of red, green, blue and Y."""
        if not self.spectral:
            return [dr.exp(value) * length for value in taps.of(self.extinction, 4, 1, 0, active)]
        depths = []
        for first, t, known in self.wavelengths(wavelengths, active):
            low, high = taps.of(self.extinction, self.extinction_size, COUNT - 1, first, active)
            depths.append(dr.exp(dr.fma(t, high - low, low)) * length)
        return depths

    def transmittance(self, optical_depths):
        factors = [dr.exp(-depth) for depth in optical_depths]
        if self.spectral:
            return mi.UnpolarizedSpectrum(factors)
        return mi.UnpolarizedSpectrum(factors[3] if mi.is_monochromatic else mi.Color3f(*factors[:3]))

    def in_scattering(self, taps, optical_depths, angle_cosine, wavelengths, active):
        """I, and Q and U in welkin's vertical frame where light is polarised (U for paths left of the light)."""
        lobe = path_geometry.lobe(angle_cosine) * self.scale
        opaque = lambda depth: -dr.select(depth < 1e-3, depth * (0.5 * depth - 1.0), dr.exp(-depth) - 1.0)
        if not self.spectral:
            values = taps.of(self.source, 4, 1, 0, active)
            opacity = opaque(optical_depths[3]) * lobe
            return [from_xyz([dr.exp(value) * opacity for value in values[:3]])]
        parts = [[], [], []]
        for (first, t, known), depth in zip(self.wavelengths(wavelengths, active), optical_depths):
            packet = taps.of(self.source, self.source_size, COUNT - 1, first, active)
            half = self.source_size // 2
            mix = [dr.fma(t, high - low, low) for low, high in zip(packet[:half], packet[half:])]
            light = dr.select(known, dr.exp(mix[0]) * opaque(depth) * lobe, 0.0)
            parts[0].append(light)
            for k in (1, 2) if half > 1 else ():
                parts[k].append(light * mix[k])
        return [mi.UnpolarizedSpectrum(part) for part in parts if part]
