"""Mountains: lifted by noise, cut by rivers, with rock, forest and snow by height and slope."""

import mitsuba as mi
import numpy as np
from scipy.ndimage import map_coordinates

from erosion import step
from meshes import lattice_faces, lattice_normals, mesh
from noise import fractal, ridged
from planet import on_planet, up_at

SIDE = 260e3
# Linear sRGB.
FOREST, MEADOW, ROCK, SNOW = (0.025, 0.05, 0.018), (0.09, 0.11, 0.04), (0.16, 0.14, 0.125), (0.78, 0.81, 0.84)


class Terrain:
    """Heights over a square of `SIDE`; `cells` on a side are eroded, what is finer is noise."""

    def __init__(self, cells, highest=4500.0, steps=45, seed=5):
        self.cell = SIDE / cells
        self.heights = self._eroded(cells, steps, seed)
        self.heights *= highest / np.quantile(self.heights, 0.9995)

    def _eroded(self, cells, steps, seed):
        y, x = np.mgrid[0:cells, 0:cells] * self.cell
        uplift = np.clip(0.38 + 0.9 * fractal(x / 75e3, y / 75e3, 4, seed), 0.03, 1.0)
        uplift[[0, -1], :] = uplift[:, [0, -1]] = 0.0
        heights = 300.0 * (1.0 + fractal(x / 20e3, y / 20e3, 6, seed + 50))
        heights[[0, -1], :] = heights[:, [0, -1]] = 0.0
        for _ in range(steps):
            heights = step(heights, self.cell, uplift, 1.5e-3, 150.0)
        return heights

    def height(self, x, y):
        """Height (m) at places from the middle of the square, m; lowland beyond its rim."""
        i, j = (y + 0.5 * SIDE) / self.cell, (x + 0.5 * SIDE) / self.cell
        coarse = map_coordinates(self.heights, [i, j], order=3, mode="constant", cval=0.0)
        relief = np.clip(coarse / 2200.0, 0.02, 1.0)
        warp_x, warp_y = (180.0 * fractal(x / 900.0, y / 900.0, 2, s) for s in (91, 97))
        detail = ridged((x + warp_x) / 1500.0, (y + warp_y) / 1500.0, 6, 11) - 0.35
        hills = 40.0 * fractal(x / 4000.0, y / 4000.0, 4, 77)
        return np.maximum(coarse + relief * 330.0 * detail + hills, 0.0)


def albedo(height, up, x, y):
    """Linear sRGB of the ground from its height, the z of its normal and its place."""
    patch = fractal(x / 700.0, y / 700.0, 4, 41)
    steep = np.clip((0.80 + 0.05 * patch - up) / 0.08, 0.0, 1.0)
    blend = lambda a, b, t: a + (b - a) * t[..., None]
    over = lambda level, width: np.clip((height + 350.0 * patch - level) / width, 0.0, 1.0)
    clearings = np.clip(0.5 + 1.4 * patch, 0.0, 1.0) * (1.0 - over(500.0, 500.0))
    ground = blend(np.array(FOREST), np.array(MEADOW), clearings)
    ground = blend(ground, np.array(MEADOW), over(1500.0, 300.0))
    ground = blend(ground, np.array(ROCK), np.maximum(over(1900.0, 400.0), steep))
    # Snow stays where it is not too steep.
    return blend(ground, np.array(SNOW), over(2350.0, 300.0) * (1.0 - steep))


def landscape(terrain, camera, heading, rows, columns, nearest=300.0, farthest=330e3, spread=np.radians(130.0)):
    """A mesh whose triangles are of about one size as `camera` (place in the square, m) sees them.

    In its frame the camera stands above the origin and looks along +x, which is `heading` (rad) in the square.
    """
    distance = np.geomspace(nearest, farthest, rows)[:, None]
    turn = np.linspace(-0.5 * spread, 0.5 * spread, columns)[None, :]
    x, y = distance * np.cos(turn), distance * np.sin(turn)
    c, s = np.cos(heading), np.sin(heading)
    east, north = camera[0] + c * x - s * y, camera[1] + s * x + c * y
    height = terrain.height(east, north)
    points = on_planet(x, y, height)
    normals = lattice_normals(points)
    upward = (normals * up_at(points)).sum(-1)
    colours = albedo(height, upward, east, north).astype(np.float32)
    bitmap = {"type": "bitmap", "bitmap": mi.Bitmap(colours), "raw": False, "wrap_mode": "clamp"}
    v, u = np.mgrid[0:rows, 0:columns]
    places = np.stack([(u + 0.5) / columns, (v + 0.5) / rows], -1)
    bsdf = {"type": "twosided", "nested": {"type": "diffuse", "reflectance": bitmap}}
    flat = lambda values: values.reshape(-1, values.shape[-1])
    return mesh("landscape", flat(points), lattice_faces(rows, columns), bsdf, flat(normals), flat(places))
