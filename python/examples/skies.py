"""Plots of skies, cell by cell: the pictures of docs/python.

python skies.py [FOLDER]        # where the PNGs go, here if not given

Needs the extra `plot`. Editors that know `# %%` run it as a notebook.
"""

# %%
import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import welkin_sky

FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
FOLDER.mkdir(parents=True, exist_ok=True)
plt.rcParams.update({"figure.dpi": 80, "savefig.dpi": 80, "font.size": 9})

model = welkin_sky.default_model()


def save(figure, name):
    figure.savefig(FOLDER / f"{name}.png")
    plt.close(figure)


# %% A fish-eye of one sky: as a picture, and its radiance at three wavelengths.
# +x is to the right, where the sun stands, and +y is up.
sky = model.sky(solar_elevation=np.radians(25.0), visibility=60e3)
figure, axes = plt.subplots(2, 2, figsize=(9.5, 7.6), layout="constrained")
sky.plot(ax=axes[0, 0], size=512)
for ax, wavelength in zip(axes.flat[1:], (400.0, 550.0, 870.0)):
    sky.plot(wavelength, ax=ax, size=512, norm="log", cmap="viridis")
save(figure, "fish-eye")

# %% The spectrum of the zenith while the sun sets.
wavelengths = np.arange(300.0, 1001.0, 2.0)
elevations = np.array([20.0, 10.0, 5.0, 2.0, 0.0, -2.0, -4.0, -6.0, -8.0])
figure, ax = plt.subplots(figsize=(8, 5), layout="constrained")
colours = plt.colormaps["plasma"](np.linspace(0.85, 0.0, len(elevations)))
spectra = model.radiance_at([0, 0, 1], wavelengths, solar_elevation=np.radians(elevations))
for elevation, spectrum, colour in zip(elevations, spectra, colours):
    ax.semilogy(wavelengths, spectrum, color=colour, label=f"{elevation:.0f}°")
ax.legend(title="sun", ncols=3)
ax.set(xlabel="wavelength, nm", ylabel="radiance of the zenith, W m⁻² sr⁻¹ nm⁻¹")
ax.set(xlim=(300, 1000), ylim=(1e-9, 1))
ax.grid(alpha=0.3)
save(figure, "sunset")

# %% Degree of polarisation, and the lines along which light is polarised.
polarised = model.polarised_sky(solar_elevation=np.radians(10.0), visibility=100e3)
figure, axes = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained")
for ax, wavelength in zip(axes, (450.0, 650.0)):
    polarised.plot(wavelength, quantity="degree", ax=ax, size=512, vmin=0, vmax=0.7, cmap="magma")

grid = welkin_sky.fish_eye(15)
stokes = polarised.stokes_at(grid.visible, 450.0)
angle = welkin_sky.angle_of_polarisation(stokes)[:, 0]
# The frame is vertical: its axis points up, to the middle of this map, and what is right of up is counter-clockwise.
outwards = np.arctan2(grid.visible[:, 1], grid.visible[:, 0])
zenith_angle = np.degrees(np.arccos(grid.visible[:, 2]))
line = outwards + np.pi + angle
axes[0].quiver(
    zenith_angle * np.cos(outwards),
    zenith_angle * np.sin(outwards),
    np.cos(line),
    np.sin(line),
    pivot="middle",
    headwidth=0,
    headlength=0,
    headaxislength=0,
    scale=24,
    width=0.004,
    color="white",
)
save(figure, "polarisation")

# %% How far one sees: transmittance over distance at some visibilities, and over wavelength.
visibilities = np.array([20e3, 40e3, 80e3, 130e3])
distances = np.linspace(0.0, 60e3, 121)
figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for visibility in visibilities:
    air = model.transmittance(visibility)
    ends = [0.0, 0.0, 100.0] + distances[:, None] * [1.0, 0.0, 0.0]
    passed = air.between_at([0.0, 0.0, 100.0], ends, 550.0)
    axes[0].plot(distances / 1e3, passed, label=f"{visibility / 1e3:.0f} km")
    at = np.arange(320.0, 1001.0, 1.0)
    axes[1].plot(at, air.between_at([0, 0, 100.0], [10e3, 0, 100.0], at), label="_")
axes[0].legend(title="visibility")
axes[0].set(xlabel="distance, km", ylabel="transmittance at 550 nm", ylim=(0, 1), xlim=(0, 60))
axes[1].set(xlabel="wavelength, nm", ylabel="transmittance over 10 km", ylim=(0, 1), xlim=(320, 1000))
for ax in axes:
    ax.grid(alpha=0.3)
save(figure, "visibility")

# %% Skies of a day, each exposed for itself: the whole sphere above the horizon, the sun in the middle.
suns = [60.0, 20.0, 5.0, 0.0, -4.0, -8.0]
course = model.sun_course(np.radians((-8.5, 60.5)), visibility=80e3)
panorama = welkin_sky.lat_long(512)
above = panorama.directions[:256]
figure, axes = plt.subplots(3, 2, figsize=(10, 8), layout="constrained")
for ax, sun in zip(axes.flat, suns):
    baked = course.at(np.radians(sun))
    rgb = baked.rgb(above)
    ax.imshow(welkin_sky.expose(rgb), extent=(180, -180, 0, 90), aspect="auto")
    luminance = baked.xyz([0, 0, 1])[1]
    shown = np.format_float_positional(luminance, precision=2, fractional=False, trim="-")
    ax.set_title(f"sun at {sun:.0f}°, zenith {shown} cd m⁻²", fontsize="medium")
    ax.set_xticks([180, 90, 0, -90, -180])
    ax.set_yticks([0, 45, 90])
for ax in axes[-1]:
    ax.set_xlabel("azimuth from the sun, counter-clockwise from above, °")
for ax in axes[:, 0]:
    ax.set_ylabel("elevation, °")
save(figure, "exposure")
