"""Spectra of the sky in colour-science: XYZ from its colour matching functions, next to those of the library.

Needs the extra `colour`.
"""

import warnings

import numpy as np

import welkin_sky

with warnings.catch_warnings():
    # It tells of plots that it cannot make without matplotlib.
    warnings.simplefilter("ignore")
    import colour

TOLERANCE = 0.01
"""Of X, Y and Z relative to their sum: the library's weights stand for sums over a few wavelengths."""
LUMINOUS_EFFICACY = 683.002
"""lm W⁻¹."""
DIRECTIONS = {
    "zenith": [0.0, 0.0, 1.0],
    "beside the sun": [1.0, 0.1, 0.5],
    "horizon away from the sun": [-1.0, 0.0, 0.05],
}

model = welkin_sky.default_model()
observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
wavelengths = np.arange(360.0, 831.0, 1.0)

for sun in (40.0, 5.0, -3.0):
    sky = model.sky(solar_elevation=np.radians(sun))
    for name, direction in DIRECTIONS.items():
        radiance = sky.radiance_at(direction, wavelengths)  # W m⁻² sr⁻¹ nm⁻¹
        spectrum = colour.SpectralDistribution(radiance, wavelengths, name=name)
        expected = colour.sd_to_XYZ(spectrum, observer, k=LUMINOUS_EFFICACY, method="Integration")
        got = sky.xyz(direction)
        off = np.abs(got - expected).max() / expected.sum()
        x, y = colour.XYZ_to_xy(expected)
        temperature = colour.xy_to_CCT([x, y], method="Hernandez 1999")
        print(f"sun {sun:+3.0f}°, {name}: {got[1]:.4g} cd m⁻², {temperature:.0f} K, off by {100 * off:.2f} %")
        if off > TOLERANCE:
            raise SystemExit(f"XYZ {got} is not that of colour-science, {expected}")

# The matrix of linear sRGB is the same, but for the digits that are written down.
ours = np.array(welkin_sky.colour_space_matrix("srgb"))
theirs = np.linalg.inv(colour.RGB_COLOURSPACES["sRGB"].matrix_RGB_to_XYZ)
if not np.allclose(ours, theirs, atol=2e-3):
    raise SystemExit("the matrices of sRGB differ")
