"""Makes the meshes and rays for compare.py."""

from __future__ import annotations

import numpy as np


def bumpy_sphere(columns, rows):
    """vertices, faces and texture coordinates of a bumpy sphere with about 2 * columns * rows
    triangles."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    phi, theta = 2 * np.pi * u, np.pi * v
    radius = 1 + 0.08 * np.sin(9 * phi) * np.sin(7 * theta) * np.sin(theta)
    vertices = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), np.sin(theta) * np.cos(phi)], -1)
    i = np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)[None]
    a, b, c, d = i, i + 1, i + columns + 1, i + columns + 2
    faces = np.concatenate([np.stack([a, c, d], -1).reshape(-1, 3), np.stack([a, d, b], -1).reshape(-1, 3)])
    return ((vertices * radius[..., None]).reshape(-1, 3).astype(np.float32), faces.astype(np.uint32),
            np.stack([u, v], -1).reshape(-1, 2).astype(np.float32))


def orbit(count):
    """Returns positions of cameras around the origin."""
    turn = 2 * np.pi * np.arange(count) / count
    return np.stack([3.2 * np.sin(turn), np.full(count, 1.0), 3.2 * np.cos(turn)], -1)


def random_rays(count):
    """Returns rays between uniformly distributed points in two cubes around the unit sphere."""
    rng = np.random.default_rng(1)
    origins = rng.uniform(-2, 2, (count, 3))
    return np.concatenate([origins, rng.uniform(-1, 1, (count, 3)) - origins], 1).astype(np.float32)


def icosphere(levels):
    """Returns a subdivided icosahedron with 20 * 4^levels faces."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=levels)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces, np.uint32)


def closed_meshes():
    """Returns {name: (vertices, faces, a point inside)}."""
    ball, faces = icosphere(5)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    box = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
                    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]], np.uint32)
    far = np.array([1000.0, 2000.0, 3000.0])
    shapes = {"icosphere": (ball, faces, np.zeros(3)), "moved": (ball + far, faces, far),
              "box": (corners, box, np.full(3, 0.5)), "squashed": (ball * (1, 1, 1e-3), faces, np.zeros(3))}
    return {name: (v.astype(np.float32), f, c) for name, (v, f, c) in shapes.items()}


def aimed_rays(vertices, faces, center, count):
    """rays from points near the center. One half is aimed at vertices, the other half at points on
    edges."""
    rng = np.random.default_rng(2)
    extent = vertices.max(0).astype(float) - vertices.min(0)
    origins = (center + rng.uniform(-0.2, 0.2, (count, 3)) * extent).astype(np.float32)
    face = faces[rng.integers(0, len(faces), count)]
    a, b = vertices[face[:, 0]].astype(float), vertices[face[:, 1]].astype(float)
    share = np.where(np.arange(count) % 2 == 0, 0, rng.uniform(0, 1, count))[:, None]
    return np.concatenate([origins, (a + share * (b - a) - origins).astype(np.float32)], 1)
