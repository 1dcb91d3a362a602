"""Arrays of numpy as meshes of Mitsuba, and lattices as meshes."""

import mitsuba as mi
import numpy as np


def mesh(name, vertices, faces, bsdf, normals=None, places=None):
    """A mesh of (n, 3) vertices and (m, 3) faces; `places` are texture coordinates, (n, 2)."""
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf) if isinstance(bsdf, dict) else bsdf
    made = mi.Mesh(name, len(vertices), len(faces), properties, normals is not None, places is not None)
    parameters = mi.traverse(made)
    flat = lambda values, kind: kind(np.ascontiguousarray(values).ravel())
    parameters["vertex_positions"] = flat(np.asarray(vertices, np.float32), mi.Float)
    parameters["faces"] = flat(np.asarray(faces, np.uint32), mi.UInt32)
    if normals is not None:
        parameters["vertex_normals"] = flat(np.asarray(normals, np.float32), mi.Float)
    if places is not None:
        parameters["vertex_texcoords"] = flat(np.asarray(places, np.float32), mi.Float)
    parameters.update()
    return made


def lattice_faces(rows, columns):
    """Two triangles for each cell of a lattice of vertices, seen counter-clockwise where rows × columns points up."""
    index = np.arange(rows * columns, dtype=np.uint32).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def lattice_normals(points):
    """Unit normals of a lattice of points (rows, columns, 3), on the side of rows × columns."""
    along, across = np.gradient(points, axis=0), np.gradient(points, axis=1)
    normal = np.cross(along, across)
    return normal / np.linalg.norm(normal, axis=-1, keepdims=True)
