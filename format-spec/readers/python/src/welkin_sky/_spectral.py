"""Interpolation between wavelengths (section 7.3)."""

import numpy as np

from ._axes import linear_weights, node_weights
from .errors import RangeError


class Wavelengths:
    """The wavelengths of a file and its solar spectrum."""

    def __init__(self, head):
        self.nodes = head.wavelength
        self._irradiance = head.solar_irradiance
        self._grid = head.solar_start + head.solar_step * np.arange(len(head.solar_irradiance))

    def checked(self, wavelength):
        """Wavelengths as an array (W,). Raises RangeError, also for an excess by rounding."""
        wavelength = np.atleast_1d(np.asarray(wavelength, dtype=np.float64))
        if wavelength.ndim != 1:
            raise RangeError("wavelength must be a number or one-dimensional")
        low, high = self.nodes[0], self.nodes[-1]
        if not np.all((wavelength >= low) & (wavelength <= high)):
            raise RangeError(f"wavelength outside {low:g} to {high:g} nm")
        return wavelength

    def irradiance(self, wavelength):
        """Solar spectral irradiance (W,), W m⁻² nm⁻¹."""
        return np.interp(wavelength, self._grid, self._irradiance)

    def weights(self, wavelength):
        """Cubic weights of the nodes: (W, nw)."""
        return node_weights(self.nodes, wavelength)

    def interpolate_radiance(self, radiance, wavelength):
        """Radiance (N, nw) at wavelengths (W,): (N, W). Logarithmic, linear next to zeros."""
        columns = []
        linear = radiance @ linear_weights(self.nodes, wavelength).T
        for k, weights in enumerate(self.weights(wavelength)):
            used = np.flatnonzero(weights)
            values = radiance[:, used]
            dark = np.any(values == 0.0, axis=1)
            smooth = np.exp(np.log(values) @ weights[used])
            columns.append(np.where(dark, linear[:, k], smooth))
        return np.stack(columns, axis=1)
