"""The mountain landscape of Figs. 1, 2 and 3 as a scene."""

import numpy as np

from rendering import camera
from terrain import Terrain, landscape

# Place in the square (m) and heading (degrees): a view along a range, lowland on both sides.
PLACE, HEADING = (-5e3, 45e3), 225.0
ALBEDO = 0.15
# Of the light: altitudes and distances between which it is linear, m.
PLACES, DRAFT_PLACES = ((300.0, 4500.0), (0.0, 150e3)), ((1500.0,), (0.0,))


def description(altitude, pitch, field_of_view, size, draft):
    """Everything but the light: a camera above the landscape, in air."""
    terrain = Terrain(96 if draft else 512)
    rows, columns = (240, 200) if draft else (2000, 1500)
    below = float(terrain.height(np.array([PLACE[0]]), np.array([PLACE[1]]))[0])
    if below > altitude - 200.0:
        raise ValueError(f"the ground is at {below:.0f} m where the camera is at {altitude:.0f} m")
    target = [1000.0, 0.0, altitude + 1000.0 * float(np.tan(np.radians(pitch)))]
    return {
        "type": "scene",
        "integrator": {"type": "welkin_path", "max_depth": 3},
        "sensor": camera([0.0, 0.0, altitude], target, field_of_view, size),
        "land": landscape(terrain, PLACE, np.radians(HEADING), rows, columns),
    }


def light(elevation, azimuth, visibility):
    """The sky for `rendered_over_places` and the sun; degrees, m."""
    sky = {"visibility": visibility, "solar_elevation": elevation, "solar_azimuth": azimuth, "albedo": ALBEDO}
    return {**sky, "sun_scale": 0.0}, {"type": "placed_sun", **sky}
