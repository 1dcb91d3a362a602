"""Skies as a data set of xarray: a day of zenith and horizon luminance, and where the sky is most polarised.

Needs the extra `xarray`.
"""

import numpy as np
import xarray

import welkin_sky

model = welkin_sky.default_model()

# One data set for each elevation of the sun, with labels and units, joined along a new dimension.
suns = np.radians([0.0, 10.0, 30.0, 60.0])
skies = [model.sky(solar_elevation=sun).to_xarray(wavelengths=[450.0, 550.0, 650.0]) for sun in suns]
day = xarray.concat(skies, xarray.DataArray(suns, dims="sun", name="sun"), combine_attrs="drop_conflicts")
print(day)

luminance = day.xyz.sel(primary="Y")
print("\nluminance, cd m⁻²: zenith, mean of the horizon")
for sun, zenith, horizon in zip(
    np.degrees(suns),
    luminance.sel(elevation=np.pi / 2, azimuth=0.0).values,
    luminance.sel(elevation=0.0).mean("azimuth").values,
):
    print(f"sun {sun:2.0f}°: {zenith:7.0f} {horizon:7.0f}")

stokes = model.polarised_sky(solar_elevation=np.radians(10.0)).to_xarray(wavelengths=[550.0]).stokes
degree = np.hypot(stokes.sel(component="Q"), stokes.sel(component="U")) / stokes.sel(component="I")
best = degree.squeeze("wavelength").stack(place=("elevation", "azimuth")).idxmax("place").item()
elevation, azimuth = np.degrees(best)
print(f"\nmost polarised: {float(degree.max()):.2f} at elevation {elevation:.0f}°, azimuth {azimuth:.0f}° from the sun")
