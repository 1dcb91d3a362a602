"""Figure 6: OPAC's sharp inversion against the smoothed one, from 2 km."""

import numpy as np

from . import colour, panels, views
from .ask import WAVELENGTHS, Air, Scene

SCENE = Scene(np.radians(20.0), altitude=2000.0, visibility=20_000.0, albedo=0.0)
PROFILES = {"OPAC, sharp at 2 km": "sharp", "smoothed": "smooth"}
AZIMUTHS = np.radians([185.0, 175.0])
ELEVATIONS = np.radians([2.8, -2.8])


def make(commands, pick):
    size = pick((16, 56), (40, 80), (90, 168))
    view = views.strip(size, AZIMUTHS, ELEVATIONS)
    figure, axes = panels.sheet(1, 3, (3.0, 2.4), left=0.05)
    panels.titles(axes, PROFILES)
    elevations = np.degrees(np.arcsin(view.directions[:, 0, 2]))
    facts, white = {}, None
    for axis, (title, profile) in zip(axes[0], PROFILES.items()):
        air = Air(SCENE.visibility, aerosol_profile=profile)
        light = commands.trace(air, [SCENE], view.lines, WAVELENGTHS, pick(32, 64, 192))[0]
        picture = view.picture(colour.linear_srgb(light.radiance, WAVELENGTHS))
        white = white or 2 * colour.geometric_mean(picture)
        panels.show(axis, colour.develop(picture, white))
        curve = colour.luminance(picture.mean(1))
        axes[0, 2].plot(curve / 1e3, elevations, label=title, linewidth=1)
        facts[f"largest change of luminance over 0.2 degrees, %, {profile}"] = largest_step(curve, elevations)
    facts["white, cd/m²"] = white
    _label(axes[0, 2])
    return figure, facts


def largest_step(curve, elevations):
    """Of luminance averaged across the picture."""
    step = max(1, round(0.2 / (elevations[0] - elevations[1])))
    return float(100 * np.max(2 * np.abs(curve[step:] - curve[:-step]) / (curve[step:] + curve[:-step])))


def _label(axis):
    axis.set_axis_on()
    box = axis.get_position()
    axis.set_position([box.x0 + 0.05, box.y0 + 0.14, box.width - 0.06, box.height - 0.14])
    axis.set_xlabel("luminance, 1000 cd/m²", fontsize=7)
    axis.set_ylabel("elevation, degrees", fontsize=7, labelpad=0)
    axis.set_ylim(*np.degrees(ELEVATIONS[::-1]))
    axis.tick_params(labelsize=7)
    axis.legend(fontsize=7, frameon=False)


def check(facts):
    sharp, smooth = (facts[f"largest change of luminance over 0.2 degrees, %, {p}"] for p in ("sharp", "smooth"))
    assert sharp > 2 * smooth, f"the sharp inversion does not show: {sharp} against {smooth} %"
