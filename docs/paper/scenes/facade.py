"""Glass fronts around a pool, after the idea of the test scene of Wilkie et al. 2004.

Glass and water reflect as dielectrics do, with full Mueller matrices; what enters them is lost: rooms and pool are
dark.
"""

import numpy as np

from meshes import lattice_faces, lattice_normals, mesh

# Refractive indices: clear glass, glass with a coating of oxide against the sun, water.
CLEAR, COATED, WATER = 1.52, 2.1, 1.333
# Middle of the ground plan, its size, height; m. The camera stands near the origin and looks along +x.
BUILDINGS = [
    ((62, 34), (34, 34), 118, COATED), ((66, -36), (40, 30), 84, CLEAR), ((128, 8), (44, 40), 172, CLEAR),
    ((122, -66), (44, 40), 136, COATED), ((126, 76), (46, 38), 92, CLEAR), ((205, 44), (46, 46), 210, COATED),
    ((212, -34), (50, 50), 152, CLEAR),
]
PANE, GAP, TILT = (1.6, 3.5), 0.14, np.radians(0.12)
POOL = ((-84.0, 34.0), (-17.0, 15.0))


def reflector(index):
    """A surface that reflects as a smooth dielectric and swallows the rest: a conductor without absorption."""
    return {"type": "conductor", "eta": {"type": "spectrum", "value": index}, "k": {"type": "spectrum", "value": 0.0}}


def diffuse(value):
    nested = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [value * c for c in (1.0, 0.97, 0.92)]}}
    return {"type": "twosided", "nested": nested}


def _front(corner, along, width, height, random):
    """Panes (n, 4, 3) of a front that is `width` wide along a unit vector; each is turned by a bit, as panes are."""
    outward = np.cross(along, [0.0, 0.0, 1.0])
    columns, rows = (max(1, round(size / pane)) for size, pane in zip((width, height), PANE))
    u, v = np.meshgrid((np.arange(columns) + 0.5) * width / columns, (np.arange(rows) + 0.5) * height / rows)
    half = 0.5 * np.array([width / columns - GAP, height / rows - GAP])
    middle = corner + u.reshape(-1, 1) * along + v.reshape(-1, 1) * np.array([0.0, 0.0, 1.0])
    tilt = TILT * random.standard_normal((2, len(middle), 1))
    right = half[0] * (along + tilt[0] * outward)
    up = half[1] * (np.array([0.0, 0.0, 1.0]) + tilt[1] * outward)
    quad = [middle + a * right + b * up for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    # A millimetre or two of tilt must not sink into the frame.
    return np.stack(quad, 1) + 0.06 * outward


def _building(place, size, height, random):
    (x, y), (depth, breadth) = place, size
    ring = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * 0.5 * np.array([depth, breadth]) + [x, y]
    corners = np.concatenate([ring, np.zeros((4, 1))], 1)
    panes, frame = [], []
    top = np.array([0.0, 0.0, height + 1.2])
    for start, end in zip(corners, np.roll(corners, -1, 0)):
        width = np.linalg.norm(end - start)
        panes.append(_front(start, (end - start) / width, width, height, random))
        frame.append([start, end, end + top, start + top])
    frame.append(corners + top)
    return np.concatenate(panes), np.array(frame)


def _quad_mesh(name, quads, bsdf):
    faces = 4 * np.arange(len(quads))[:, None, None] + np.array([[0, 1, 2], [0, 2, 3]])
    return mesh(name, quads.reshape(-1, 3), faces.reshape(-1, 3), bsdf)


def _water(rows, columns, random):
    """A lattice over the pool with ripples of a light breeze, slopes of about a degree."""
    (x0, x1), (y0, y1) = POOL
    # Dense near the camera.
    x = (x0 + (x1 - x0) * np.linspace(0.0, 1.0, rows) ** 1.6)[:, None]
    y = np.linspace(y0, y1, columns)[None, :]
    height = np.zeros((rows, columns))
    for length in np.geomspace(0.35, 3.0, 24):
        turn, phase = random.normal(0.5, 0.7), random.uniform(0.0, 2.0 * np.pi)
        number = 2.0 * np.pi / length
        height += 0.0035 / number * np.sin(number * (np.cos(turn) * x + np.sin(turn) * y) + phase)
    points = np.stack(np.broadcast_arrays(x, y, height), -1)
    flat = lambda v: v.reshape(-1, 3)
    return mesh("water", flat(points), lattice_faces(rows, columns), reflector(WATER), flat(lattice_normals(points)))


def _plaza():
    """Paving around the pool."""
    (x0, x1), (y0, y1) = POOL
    far, rim = 6e3, 0.25
    boxes = [(-far, x0, -far, far), (x1, far, -far, far), (x0, x1, -far, y0), (x0, x1, y1, far)]
    quads = [[(a, c, rim), (b, c, rim), (b, d, rim), (a, d, rim)] for a, b, c, d in boxes]
    walls = [((x0, y0), (x1, y0)), ((x1, y0), (x1, y1)), ((x1, y1), (x0, y1)), ((x0, y1), (x0, y0))]
    quads += [[(*p, rim), (*q, rim), (*q, -0.5), (*p, -0.5)] for p, q in walls]
    return np.array(quads)


def meshes(detail=1.0):
    """The scene for `mitsuba.load_dict`."""
    random = np.random.default_rng(4)
    panes, frames = {CLEAR: [], COATED: []}, []
    for place, size, height, glass in BUILDINGS:
        some, frame = _building(place, size, height, random)
        panes[glass].append(some)
        frames.append(frame)
    return {
        "clear": _quad_mesh("clear", np.concatenate(panes[CLEAR]), reflector(CLEAR)),
        "coated": _quad_mesh("coated", np.concatenate(panes[COATED]), reflector(COATED)),
        "frames": _quad_mesh("frames", np.concatenate(frames), diffuse(0.16)),
        "plaza": _quad_mesh("plaza", _plaza(), diffuse(0.32)),
        "water": _water(int(900 * detail), int(400 * detail), random),
    }
