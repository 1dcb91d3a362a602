"""The test scene of Fig. 14: a planet with a red grid every 10 km, and towers 15 km high with a stripe for each km.

It is the same triangles for Mitsuba and, as Wavefront OBJ, for the path tracer of the air.
"""

import numpy as np

from planet import RADIUS, on_planet, up_at

# Ahead and to the left of the camera, width; km. Horizon: 319 km from a camera at 8 km.
TOWERS = [
    (22, 7, 2), (34, -11.5, 2.5), (52, 9, 3), (80, -18, 4), (120, 27, 5), (175, -28, 6), (250, 46, 8), (330, 2, 10),
]
HEIGHT = 15
# Linear sRGB.
ALBEDO = {"ground": (0.3, 0.3, 0.3), "line": (0.45, 0.03, 0.03), "light": (0.7, 0.7, 0.7), "dark": (0.15, 0.15, 0.15)}
GRID, LINE = 10e3, 700.0
AHEAD, ASIDE = (-50e3, 400e3), 260e3


def _quads(points):
    """Two triangles for each of (n, 4, 3) corners."""
    return np.concatenate([points[:, [0, 1, 2]], points[:, [0, 2, 3]]])


def _stations(first, last):
    """Edges of lines of the grid and middles between them, and whether what follows each is a line."""
    grid = np.arange(np.floor(first / GRID), np.ceil(last / GRID) + 1) * GRID
    offsets = np.array([-0.5 * LINE, 0.5 * LINE, 0.5 * GRID])
    stations = (grid[:, None] + offsets).ravel()
    return stations, (np.arange(len(stations) - 1) % 3) == 0


def _ground():
    x, is_line_x = _stations(*AHEAD)
    y, is_line_y = _stations(-ASIDE, ASIDE)
    # Chords sink below the sphere, by 2 m at most, which must not show through.
    points = on_planet(x[:, None], y[None, :], np.full((len(x), len(y)), 3.0))
    corners = np.stack([points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]], 2)
    is_line = is_line_x[:, None] | is_line_y[None, :]
    return {"ground": _quads(corners[~is_line]), "line": _quads(corners[is_line])}


def _tower(ahead, left, width):
    """Corners of the stripes, light and dark in turns, and of the roof."""
    base = on_planet(np.float64(ahead), np.float64(left), 0.0)
    up = up_at(base)
    forward = np.array([1.0, 0.0, 0.0]) - up[0] * up
    forward /= np.linalg.norm(forward)
    side = np.cross(up, forward)
    half = 0.5 * width
    ring = base + half * np.array([f * forward + s * side for f, s in [(-1, -1), (1, -1), (1, 1), (-1, 1)]])
    # The ground falls away from the middle.
    levels = 1e3 * np.arange(HEIGHT + 1.0)
    levels[0] = -1.0 - half**2 / RADIUS
    at = ring[None] + levels[:, None, None] * up
    following = np.roll(at, -1, 1)
    walls = np.stack([at[:-1], following[:-1], following[1:], at[1:]], 2)
    dark = np.concatenate([walls[1::2].reshape(-1, 4, 3), at[-1][None]])
    return _quads(walls[0::2].reshape(-1, 4, 3)), _quads(dark)


def triangles():
    """(n, 3, 3) corners in metres for each name of `ALBEDO`; x ahead, y to the left, z up."""
    towers = [_tower(*(1e3 * v for v in tower)) for tower in TOWERS]
    light, dark = (np.concatenate(parts) for parts in zip(*towers))
    return {**_ground(), "light": light, "dark": dark}


def obj():
    """The scene as (name, text) of an OBJ, whose y is up, and of its materials."""
    materials = [f"newmtl {n}\nKd {' '.join(map(str, rgb))}\n" for n, rgb in ALBEDO.items()]
    lines, count = ["mtllib towers.mtl\n"], 0
    for name, corners in triangles().items():
        points = corners.reshape(-1, 3)
        lines.append(f"o {name}\nusemtl {name}\n")
        lines += [f"v {-y:.3f} {z:.3f} {-x:.3f}\n" for x, y, z in points]
        first = count + 1 + np.arange(0, len(points), 3)
        lines += [f"f {a} {a + 1} {a + 2}\n" for a in first]
        count += len(points)
    return {"towers.mtl": "".join(materials), "towers.obj": "".join(lines)}


def meshes():
    """The scene for `mitsuba.load_dict`."""
    from meshes import mesh

    made = {}
    for name, corners in triangles().items():
        points = corners.reshape(-1, 3)
        diffuse = {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(ALBEDO[name])}}
        bsdf = {"type": "twosided", "nested": diffuse}
        made[name] = mesh(name, points, np.arange(len(points)).reshape(-1, 3), bsdf)
    return made
