"""From spectra to pictures."""

import csv
from pathlib import Path

import numpy as np

DATA = Path(__file__).resolve().parents[3] / "fitter/data"
EFFICACY = 683.002
SRGB = np.array(
    [
        [3.2404542, -1.5371385, -0.4985314],
        [-0.9692660, 1.8760108, 0.0415560],
        [0.0556434, -0.2040259, 1.0572252],
    ]
)
LUMINANCE = np.array([0.2126729, 0.7151522, 0.0721750])
# White of the CIE's daylight D65.
WHITE = np.array([0.95047, 1.0, 1.08883])
VISIBLE = np.arange(380.0, 781.0)


def _curve(name, column):
    with open(DATA / name, encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    nm = [float(row["wavelength_nm"]) for row in rows]
    return np.interp(VISIBLE, nm, [float(row[column]) for row in rows])


def _weights(wavelengths, light):
    """Shares of light that is linear between the wavelengths, and constant beyond, in X, Y and Z."""
    shares = np.stack([np.interp(VISIBLE, wavelengths, unit) for unit in np.eye(len(wavelengths))])
    observer = [_curve("cie1931_2deg_1nm.csv", name) for name in ("xbar", "ybar", "zbar")]
    return shares @ np.stack([light * curve for curve in observer], -1)


def linear_srgb(radiance, wavelengths):
    """Linear sRGB, cd/m² at white, of radiance per solar irradiance (1/sr), the last axis over wavelengths (nm)."""
    sun = _curve("solar_irradiance_1nm.csv", "g173")
    return radiance @ (EFFICACY * _weights(wavelengths, sun)) @ SRGB.T


def filter_colour(transmittance, wavelengths):
    """Linear sRGB of what passes of white light; 1 passes all of it."""
    sun = _curve("solar_irradiance_1nm.csv", "g173")
    xyz = transmittance @ _weights(wavelengths, sun)
    return (xyz / _weights(wavelengths, sun).sum(0) * WHITE) @ SRGB.T


def luminance(rgb):
    return rgb @ LUMINANCE


def encode(rgb):
    """The transfer function of IEC 61966-2-1."""
    rgb = np.clip(rgb, 0, 1)
    return np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)


def develop(rgb, white):
    """Display values of light whose luminance `white` is white.

    Highlights roll off with their hue kept; colours that sRGB lacks get as much white as makes them possible.
    """
    rgb = np.nan_to_num(rgb) / white
    grey = luminance(rgb)[..., None]
    least = rgb.min(-1, keepdims=True)
    spare = np.where(least < 0, grey / np.maximum(grey - least, 1e-30), 1.0)
    rgb = np.maximum(grey + spare * (rgb - grey), 0)
    peak = rgb.max(-1, keepdims=True)
    over = (peak - 0.6) / 0.4
    rolled = 0.6 + 0.4 * over / (1 + over)
    return encode(rgb * np.where(peak > 0.6, rolled / np.maximum(peak, 1e-30), 1.0))


def geometric_mean(rgb):
    """Of the luminance of all pixels that see something."""
    values = luminance(rgb)
    values = values[np.isfinite(values) & (values > 0)]
    return float(np.exp(np.log(values).mean()))
