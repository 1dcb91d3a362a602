"""Figure 6: OPAC's sharp inversion against the smoothed one, from 2 km."""

import numpy as np

from . import colour, panels, views
from .ask import WAVELENGTHS, Air, Scene

ALTITUDE = 2000.0
SUN = 10.0
PROFILES = {"OPAC, sharp at 2 km": "sharp", "smoothed": "smooth"}
# Of the curves: a column of lines of sight to the left of the sun.
ELEVATIONS = np.radians(np.linspace(-12, 12, 97))


def make(commands, draft):
    view = views.sideways(40 if draft else 160)
    column = views.strip((1, len(ELEVATIONS)), (np.pi / 2, np.pi / 2), (ELEVATIONS[-1], ELEVATIONS[0]))
    figure, axes = panels.sheet(1, 3, (2.9, 2.9))
    panels.titles(axes, PROFILES)
    axes[0, 2].set_axis_on()
    box = axes[0, 2].get_position()
    axes[0, 2].set_position([box.x0 + 0.06, box.y0 + 0.13, box.width - 0.065, box.height - 0.15])
    scene = Scene(np.radians(SUN), ALTITUDE)
    facts, white = {}, None
    for axis, (title, profile) in zip(axes[0], PROFILES.items()):
        air = Air(aerosol_profile=profile)

        def traced(view, walks, air=air):
            light = commands.trace(air, scene, view.lines, WAVELENGTHS, walks)
            return view.picture(colour.linear_srgb(light.radiance, WAVELENGTHS))

        picture = traced(view, 32 if draft else 96)
        white = white or 2.5 * colour.geometric_mean(picture)
        panels.show(axis, colour.develop(picture, white), view.seen)
        curve = colour.luminance(traced(column, 32 if draft else 640))[:, 0]
        elevations = np.degrees(np.arcsin(column.directions[:, 0, 2]))
        axes[0, 2].plot(curve / 1e3, elevations, label=title, linewidth=1)
        facts[f"largest step in a quarter of a degree, {profile}"] = largest_step(curve)
    facts["white, cd/m²"] = white
    _label(axes[0, 2])
    return figure, facts


def largest_step(curve):
    """Relative to the mean of both sides."""
    return float(np.max(2 * np.abs(np.diff(curve)) / (curve[1:] + curve[:-1])))


def _label(axis):
    axis.set_xlabel("luminance 90° from the sun, 1000 cd/m²", fontsize=7)
    axis.set_ylabel("elevation, degrees", fontsize=7, labelpad=0)
    axis.tick_params(labelsize=7)
    axis.legend(fontsize=7, frameon=False)


def check(facts):
    step = lambda profile: facts[f"largest step in a quarter of a degree, {profile}"]  # noqa: E731
    assert step("sharp") > 1.5 * step("smooth"), f"the sharp inversion does not show: {facts}"
