"""A city on both sides of a river: blocks with yards, towers in the middle, hills beyond."""

import mitsuba as mi
import numpy as np

from meshes import lattice_faces, lattice_normals, mesh
from noise import fractal
from planet import on_planet

CENTRE = np.array([3600.0, -150.0])
PITCH, STREET = 110.0, 20.0
FLOOR, BAY = 3.4, 3.0
# Half of the river's width.
BANK = 110.0
# Wall and window, linear sRGB.
WALLS = {
    "brick": ((0.23, 0.115, 0.075), (0.05, 0.055, 0.06)), "stone": ((0.42, 0.37, 0.29), (0.06, 0.065, 0.07)),
    "concrete": ((0.33, 0.325, 0.31), (0.055, 0.06, 0.07)), "glass": ((0.12, 0.13, 0.14), (0.07, 0.085, 0.10)),
}
ROOF, TREES = (0.14, 0.125, 0.12), (0.035, 0.055, 0.02)


def river(x):
    """Where the middle of the river is, y, m."""
    return 620.0 * np.sin(x / 1900.0) + 0.03 * x


def river_distance(x, y):
    """Distance from the middle of the river, m, about."""
    return np.abs(y - river(x))


def _heights(x, y, random):
    """Height of the building at each place: low outside, towers about the centre, nothing in parks."""
    far = np.hypot(x - CENTRE[0], y - CENTRE[1])
    density = np.exp(-((far / 1500.0) ** 2)) + 0.45 * np.exp(-(((np.hypot(x - 6800.0, y + 1900.0)) / 900.0) ** 2))
    low = 14.0 + 12.0 * random.random(x.shape) + 10.0 * np.exp(-((far / 3500.0) ** 2))
    tall = density * 190.0 * random.random(x.shape) ** 2.5
    is_park = fractal(x / 900.0, y / 900.0, 2, 8) > 0.33
    return np.where(is_park | (river_distance(x, y) < BANK + 45.0), 0.0, np.maximum(low, tall))


def _buildings(radius, random):
    """(n, 6): middle, half sides and height of each, and a number from 0 to 1."""
    steps = np.arange(-radius, radius, PITCH)
    x, y = (v.ravel() for v in np.meshgrid(steps + CENTRE[0], steps + CENTRE[1]))
    kept = []
    # Four to a block.
    for dx, dy in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        u, v = x + dx * 0.25 * (PITCH - STREET), y + dy * 0.25 * (PITCH - STREET)
        height = _heights(u, v, random)
        side = 0.25 * (PITCH - STREET) * (0.70 + 0.28 * random.random((2, len(u))))
        some = (height > 0.0) & (u > 600.0) & (np.hypot(u - CENTRE[0], v - CENTRE[1]) < radius)
        some &= random.random(len(u)) < 0.93
        kept.append(np.stack([u, v, side[0], side[1], height, random.random(len(u))], -1)[some])
    return np.concatenate(kept)


def _boxes(buildings):
    """Walls (n, 4, 4, 3) and roofs (n, 4, 3) of buildings, and lengths of walls (n, 4)."""
    x, y, a, b, height = buildings.T[:5]
    base = on_planet(x, y, np.zeros_like(x))
    ring = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)])
    ring = base[:, None] + ring[None] * np.stack([a, b, 0 * a], -1)[:, None]
    bottom, top = ring - [0.0, 0.0, 2.0], ring + np.array([0.0, 0.0, 1.0]) * height[:, None, None]
    walls = np.stack([bottom, np.roll(bottom, -1, 1), np.roll(top, -1, 1), top], 2)
    return walls, top, 2.0 * np.stack([a, b, a, b], -1)


def _quads(name, quads, bsdf, places=None):
    faces = 4 * np.arange(len(quads))[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])
    flat = None if places is None else places.reshape(-1, 2)
    return mesh(name, quads.reshape(-1, 3), faces.reshape(-1, 3), bsdf, None, flat)


def _diffuse(reflectance):
    return {"type": "twosided", "nested": {"type": "diffuse", "reflectance": reflectance}}


def _colour(rgb):
    return {"type": "rgb", "value": list(rgb)}


def _storey(wall, window):
    """A texture of one bay of one floor."""
    tile = np.empty((16, 16, 3), np.float32)
    tile[:] = wall
    tile[4:12, 4:12] = window
    return {"type": "bitmap", "bitmap": mi.Bitmap(tile), "raw": False, "wrap_mode": "repeat"}


def _walls(buildings):
    made = {}
    kind = np.floor(buildings[:, 5] * 3.0).astype(int)
    kind[buildings[:, 4] > 75.0] = 3
    for k, (name, (wall, window)) in enumerate(WALLS.items()):
        walls, _, lengths = _boxes(buildings[kind == k])
        floors = np.ceil(buildings[kind == k, 4] / FLOOR)[:, None] + np.zeros((1, 4))
        bays = np.ceil(lengths / BAY)
        zero = np.zeros_like(bays)
        places = np.stack([np.stack([zero, zero], -1), np.stack([bays, zero], -1),
                           np.stack([bays, floors], -1), np.stack([zero, floors], -1)], 2)
        made[name] = _quads(name, walls.reshape(-1, 4, 3), _diffuse(_storey(wall, window)), places)
    return made


def _ground(rows, columns):
    """Land to the horizon, with hills beyond the city and a river in it."""
    distance = np.geomspace(60.0, 120e3, rows)[:, None]
    turn = np.radians(np.linspace(-75.0, 75.0, columns))[None, :]
    x, y = distance * np.cos(turn), distance * np.sin(turn)
    rise = np.clip((np.hypot(x, y) - 13e3) / 22e3, 0.0, 1.0)
    hills = 520.0 * np.clip(0.25 + fractal(x / 9e3, y / 9e3, 5, 21), 0.0, None) * rise**1.5
    # The camera's own hill.
    hills = hills + 150.0 * np.exp(-((np.hypot(x, y) / 300.0) ** 2))
    points = on_planet(x, y, hills - 8.0 * np.clip((BANK - river_distance(x, y)) / 10.0, 0.0, 1.0))
    patch = np.clip(0.5 + 1.5 * fractal(x / 420.0, y / 420.0, 4, 3), 0.0, 1.0)[..., None]
    is_city = (np.hypot(x - CENTRE[0], y - CENTRE[1]) < 9e3)[..., None] & (hills[..., None] < 40.0)
    colour = np.where(is_city, 0.10 + 0.0 * patch, 1.0) * np.where(
        is_city, np.ones(3), np.array(TREES) * (1.0 - patch) + np.array([0.10, 0.11, 0.05]) * patch)
    bitmap = {"type": "bitmap", "bitmap": mi.Bitmap(colour.astype(np.float32)), "raw": False, "wrap_mode": "clamp"}
    v, u = np.mgrid[0:rows, 0:columns]
    places = np.stack([(u + 0.5) / columns, (v + 0.5) / rows], -1).reshape(-1, 2)
    flat = lambda v: v.reshape(-1, 3)
    return mesh("ground", flat(points), lattice_faces(rows, columns), _diffuse(bitmap), flat(lattice_normals(points)),
                places)


def _river(rows=600):
    """A surface that covers the bed, with waves too small to be seen each."""
    x = np.linspace(300.0, 16e3, rows)[:, None]
    y = river(x) + np.array([[-BANK, BANK]])
    points = on_planet(x + 0.0 * y, y, -3.0 + 0.0 * y)
    water = {"type": "roughconductor", "distribution": "ggx", "alpha": 0.06,
             "eta": {"type": "spectrum", "value": 1.333}, "k": {"type": "spectrum", "value": 0.0}}
    return mesh("river", points.reshape(-1, 3), lattice_faces(rows, 2), {"type": "twosided", "nested": water})


def meshes(draft=False):
    """The scene for `mitsuba.load_dict`; the camera stands over the origin and looks along +x."""
    buildings = _buildings(3e3 if draft else 8.5e3, np.random.default_rng(2))
    roofs = _boxes(buildings)[1]
    size = (300, 200) if draft else (1600, 900)
    return {
        **_walls(buildings),
        "roofs": _quads("roofs", roofs, _diffuse(_colour(ROOF))),
        "ground": _ground(*size),
        "river": _river(),
    }
