"""What welkin says of the air along paths, as arrays over their start, direction and length."""

import dataclasses
import math

import mitsuba as mi
import numpy as np

from . import path_geometry
from .sources import COUNT, FIRST, STEP, bands_of

TINY = 1e-30


class Extent:
    """Where the paths of a scene are: altitudes from `floor` (of all ends) and `low` to `high` (of starts), at most `far`
    long, all in metres; and how many nodes tell them apart."""

    def __init__(self, planet, floor, low, high, far, heights, rows, azimuths, lengths):
        self.planet, self.floor, self.low, self.high, self.far = planet, floor, low, high, far
        self.heights, self.rows, self.azimuths, self.lengths = heights, rows, azimuths, lengths

    @property
    def shape(self):
        return self.heights, 2 * self.rows, self.azimuths, self.lengths

    def paths(self):
        """Altitude, cosine from the zenith, azimuth from the sun and length at each node."""
        # Not to the zenith itself, which has no azimuths.
        up = np.linspace(1e-4, 1.0 - 1e-5, self.rows)
        v = np.concatenate([-up[::-1], up])
        share = np.linspace(0.0, 1.0, self.lengths)
        axes = (np.linspace(self.low, self.high, self.heights), v, np.linspace(0.0, math.pi, self.azimuths), share)
        altitude, v, azimuth, share = np.meshgrid(*axes, indexing="ij")
        edge = path_geometry.horizon(np, altitude, self.floor, self.planet)
        mu = path_geometry.cosine(np, v, edge)
        whole = path_geometry.reach(np, altitude, mu, self.floor, self.planet, self.far)
        # Transmittances are told in single precision: shorter paths would not differ from 1 by enough.
        return altitude, mu, azimuth, np.maximum(whole * np.maximum(share * share, 1e-3), 30.0)


class SegmentArrays:
    """`source`: ln of in-scattered light over the opacity and the lobe, and with polarisation Q/I and U/I: (nodes…, wavelengths,
    1 or 3). `extinction`: ln of the mean extinction, m⁻¹: (nodes…, wavelengths); of colours red, green, blue and Y."""

    def __init__(self, model, key, conditions, extent, joined=False):
        """`joined`: to the sky that is seen from the one altitude of the extent, without a seam."""
        self.extent = extent
        altitude, mu, azimuth, length = extent.paths()
        flat = np.sqrt(np.maximum(1.0 - mu * mu, 0.0))
        turned = conditions.solar_azimuth + azimuth
        d = np.stack([flat * np.cos(turned), flat * np.sin(turned), mu], -1)
        start = np.stack([0.0 * altitude, 0.0 * altitude, altitude], -1)
        end = start + d * length[..., None]
        light, optical_depth, degrees = self.of_segments(model, key, conditions, start, end)
        if joined:
            light = light * joining(model, dataclasses.replace(conditions, altitude=max(extent.low, 0.0)), start, end)
        opacity = -np.expm1(-optical_depth[..., -1:] if light.shape[-1] == 3 else -optical_depth)
        e, a = conditions.solar_elevation, conditions.solar_azimuth
        sun = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
        lobe = path_geometry.lobe(d @ sun)[..., None]
        source = np.log(np.maximum(light / (opacity * lobe), TINY))[..., None]
        self.source = source if degrees is None else np.concatenate([source, degrees], -1)
        self.extinction = np.log(np.maximum(optical_depth / length[..., None], TINY))

    @staticmethod
    def of_segments(model, key, conditions, start, end):
        """Light, optical depth, and degrees of polarisation or none."""
        if not (mi.is_spectral or mi.is_polarized):
            air = model.colour_aerial_perspective(conditions)
            xyz, luminous = air.xyz(start, end)
            _, factors = air.rgb(start, end)
            transmittance = np.concatenate([factors, luminous[..., 1:2]], -1)
            return xyz, -np.log(np.clip(transmittance, TINY, 1.0 - 1e-7)), None
        air = model.band_aerial_perspective(bands_of(model, key), conditions)
        light, transmittance = air.in_scattering(start, end)
        optical_depth = -np.log(np.clip(transmittance, TINY, 1.0 - 1e-7))
        if not mi.is_polarized:
            return light, optical_depth, None
        air = model.aerial_perspective(conditions)
        stokes, _ = air.in_scattering_stokes(start, end)
        shares = stokes[..., 1:, :] / np.maximum(stokes[..., :1, :], TINY)
        return light, optical_depth, to_wavelengths(shares, np.asarray(air.wavelengths))


def joining(model, conditions, start, end):
    """What the light of paths from an observer is multiplied by, so that far things vanish in that observer's sky."""
    air = model.aerial_perspective(conditions)
    joined = air.joined_to(model.sky(conditions))
    if not (mi.is_spectral or mi.is_polarized):
        pair = joined.rgb(end, "xyz")[0], air.xyz(start, end)[0]
    else:
        pair = joined.in_scattering(end)[0], air.in_scattering(start, end)[0]
    share = np.clip(pair[0] / np.maximum(pair[1], TINY), 0.5, 2.0)
    return share if share.shape[-1] == 3 else to_wavelengths(share[..., None, :], np.asarray(air.wavelengths))[..., 0]


def to_wavelengths(shares, nodes):
    """(…, n, nodes) → (…, wavelengths, n), linear: for what is smooth, as degrees of polarisation are."""
    wavelengths = FIRST + STEP * np.arange(COUNT)
    cell = np.clip(np.searchsorted(nodes, wavelengths) - 1, 0, len(nodes) - 2)
    t = (wavelengths - nodes[cell]) / (nodes[cell + 1] - nodes[cell])
    at = shares[..., cell] * (1.0 - t) + shares[..., cell + 1] * t
    return np.moveaxis(at, -2, -1)
