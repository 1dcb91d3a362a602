"""Interpolation between wavelengths (sections 7.3 and 7.5)."""

import numpy as np

from . import _head
from ._axes import linear_weights, node_weights
from .errors import RangeError


class _Nodes:
    """The rule of files without a spectrum; `_spectrum.Spectrum` is that of the others."""

    def __init__(self, axis):
        self.axis = axis

    def width(self, wavelength):
        return len(wavelength)

    def radiance(self, radiance, wavelength):
        """Logarithmic, linear where a node is dark."""
        weights, plain = node_weights(self.axis, wavelength), linear_weights(self.axis, wavelength)
        used = np.flatnonzero(np.any((weights != 0.0) | (plain != 0.0), axis=0))
        radiance, weights, plain = radiance[:, used], weights[:, used], plain[:, used]
        dark = radiance == 0.0
        smooth = np.exp(np.log(np.where(dark, 1.0, radiance)) @ weights.T)
        if not np.any(dark):
            return smooth
        touched = dark.astype(np.float64) @ (weights != 0.0).T > 0.0
        return np.where(touched, radiance @ plain.T, smooth)

    def stokes(self, stokes, wavelength):
        lit = np.where(stokes[:, :1] > 0.0, stokes[:, :1], 1.0)
        shares = (stokes[:, 1:] / lit) @ node_weights(self.axis, wavelength).T
        return np.concatenate([self.radiance(stokes[:, 0], wavelength)[:, None], shares], axis=1)


class Wavelengths:
    """The wavelengths of a file and its solar spectrum."""

    def __init__(self, head, chunks):
        self.nodes = head.wavelength
        self._has_spectrum = head.chunk(_head.SPECTRUM) is not None
        self._chunks = chunks
        self._irradiance = head.solar_irradiance
        self._grid = head.solar_start + head.solar_step * np.arange(len(head.solar_irradiance))

    @property
    def spectrum(self):
        """What lies between the nodes. Raises MissingError in a file without a spectrum."""
        return self._chunks.get(_head.SPECTRUM)

    @property
    def rule(self):
        """What answers between the nodes: radiance (N, nw) → (N, K), and L, Q, U → L, Q/L, U/L."""
        return self.spectrum if self._has_spectrum else _Nodes(self.nodes)

    @property
    def range(self):
        """First and last wavelength that can be asked, nm."""
        axis = self.rule.axis
        return float(axis[0]), float(axis[-1])

    def checked(self, wavelength):
        """Wavelengths as an array (K,). Raises RangeError, also for an excess by rounding."""
        wavelength = np.atleast_1d(np.asarray(wavelength, dtype=np.float64))
        if wavelength.ndim != 1:
            raise RangeError("wavelength must be a number or one-dimensional")
        low, high = self.range
        if not np.all((wavelength >= low) & (wavelength <= high)):
            raise RangeError(f"wavelength outside {low:g} to {high:g} nm")
        return wavelength

    def irradiance(self, wavelength):
        """Solar spectral irradiance (K,), W m⁻² nm⁻¹."""
        return np.interp(wavelength, self._grid, self._irradiance)
