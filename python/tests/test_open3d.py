"""Tests the ray engine with Open3D's interface. Expected numbers follow from the shapes."""

from __future__ import annotations

import microtrace as mt
import numpy as np
import pytest
from conftest import icosphere
from microtrace.open3d import RaycastingScene

BOX = (
    np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32),
    np.array(
        [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
        + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]],
        np.uint32,
    ),
)


def test_close_surfaces_count_twice():
    """Two squares whose distances from the origin round to the same t."""
    square = np.float32([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    scene = RaycastingScene()
    for z in (0, 2.0**-30):
        scene.add_triangles(square + np.float32([0, 0, z]), [[0, 1, 2], [0, 2, 3]])
    # The ray at x = 0.5 passes through both diagonals.
    rays = np.float32([[x, 0.5, -3, 0, 0, 1] for x in (0.25, 0.5)])
    assert scene.count_intersections(rays).tolist() == [2, 2]
    answer = scene.list_intersections(rays)
    assert answer["t_hit"].tolist() == [3] * 4
    assert answer["geometry_ids"].tolist() == [0, 1, 0, 1]
    assert answer["ray_splits"].tolist() == [0, 2, 4]


def test_wrong_triangles_are_not_added(box):
    for vertices, triangles, error, words in [
        (np.eye(3), [[0, 1, 3]], ValueError, "triangle_indices must be below .* 3; found 3"),
        (np.eye(3), [[0, 1, -1]], ValueError, "triangle_indices must not be negative"),
        (np.eye(3), np.eye(3), TypeError, "triangle_indices must contain integers"),
        (np.eye(4), [[0, 1, 2]], ValueError, "vertex_positions must have shape"),
        (np.diag([1, 1, np.nan]), [[0, 1, 2]], ValueError, "vertex_positions must be finite"),
        (np.diag([1, 1, 1e39]), [[0, 1, 2]], ValueError, "vertex_positions must be finite"),
        (np.eye(3), None, TypeError, "expected vertex positions and triangle indices, or a mesh"),
        (None, None, TypeError, "expected vertex positions and triangle indices, or a mesh"),
    ]:
        with pytest.raises(error, match=words):
            box.add_triangles(vertices, triangles)
    with pytest.raises(ValueError, match="must not have masked values"):
        box.cast_rays(np.ma.masked_array(RAYS, mask=RAYS == 10))
    assert box.count_intersections(RAYS).tolist() == [2, 1, 0]
    assert box.add_triangles(np.zeros((0, 3)), np.zeros((0, 3), int)) == 1


@pytest.fixture
def box():
    scene = RaycastingScene()
    assert scene.add_triangles(*BOX) == 0
    return scene


RAYS = np.array(
    [[0.5, 0.5, -1, 0, 0, 1], [0.5, 0.5, 0.5, 0, 0, 1], [10, 10, 10, 1, 0, 0]], np.float32
)


def test_cast_rays():
    scene = RaycastingScene()
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0]], np.float32)
    first = scene.add_triangles(corners + np.float32(9), np.array([[0, 1, 2]], np.uint32))
    second = scene.add_triangles(corners, np.array([[0, 1, 2]], np.uint32))
    assert (first, second) == (0, 1)
    answer = scene.cast_rays([[0.5, 0.25, 1, 0, 0, -1], [10, 10, 10, 1, 0, 0]])
    assert answer["t_hit"].numpy().tolist() == [1, np.inf]
    assert answer["t_hit"].isfinite().tolist() == [True, False]
    assert answer["geometry_ids"].numpy().tolist() == [1, RaycastingScene.INVALID_ID]
    assert answer["geometry_ids"][0].cpu() == second and answer["t_hit"][0].item() == 1
    assert answer["primitive_ids"].tolist() == [0, RaycastingScene.INVALID_ID]
    assert answer["primitive_uvs"][0].tolist() == [0.25, 0.25]
    assert answer["primitive_normals"][0].tolist() == [0, 0, 1]


def test_crossings(box):
    # The rays pass through the diagonals of faces, which count once.
    assert box.count_intersections(RAYS).numpy().tolist() == [2, 1, 0]
    answer = box.list_intersections(RAYS)
    assert answer["t_hit"].tolist() == [1, 2, 0.5]
    assert answer["ray_ids"].tolist() == [0, 0, 1]
    assert answer["ray_splits"].tolist() == [0, 2, 3, 3]
    assert box.test_occlusions(RAYS).tolist() == [True, True, False]
    assert box.test_occlusions(RAYS, tfar=0.25).tolist() == [False] * 3
    assert box.test_occlusions(RAYS, tnear=1.5).tolist() == [True, False, False]


def test_hits_at_origins_count(box):
    rays = np.float32([[0.25, 0.5, 0, 0, 0, 1], [0.25, 0.5, 1, 0, 0, 1]])
    answer = box.cast_rays(rays)
    assert answer["t_hit"].tolist() == [0, 0]
    assert answer["primitive_normals"].tolist() == [[0, 0, -1], [0, 0, 1]]
    for interval in ({}, {"tnear": -1, "tfar": 0}):
        assert box.test_occlusions(rays, **interval).tolist() == [True, True]
    assert box.test_occlusions(rays, tnear=2.0**-149).tolist() == [True, False]
    assert box.count_intersections(rays).tolist() == [2, 1]
    assert box.list_intersections(rays)["t_hit"].tolist() == [0, 1, 0]


def test_points(box):
    points = np.array([[0.5, 0.5, 0.5], [-0.5, -0.5, -0.5], [0, 0, 0]], np.float32)
    assert np.allclose(box.compute_distance(points), [0.5, 0.75**0.5, 0])
    assert np.allclose(box.compute_signed_distance(points, nsamples=3), [-0.5, 0.75**0.5, 0])
    assert box.compute_occupancy(points[:2]).numpy().tolist() == [1, 0]
    answer = box.compute_closest_points(points[1:])
    assert answer["points"].tolist() == [[0, 0, 0], [0, 0, 0]]
    assert answer["primitive_normals"].shape == (2, 3)


@pytest.mark.parametrize("shape", [(11,), (1, 2, 3), (32, 14)])
def test_shapes(box, rng, shape):
    rays, points = rng.uniform(size=(*shape, 6)), rng.uniform(size=(*shape, 3))
    for name, array in box.cast_rays(rays).items():
        tail = {"primitive_uvs": (2,), "primitive_normals": (3,)}.get(name, ())
        assert array.shape == shape + tail
    assert box.count_intersections(rays).shape == shape
    assert box.compute_signed_distance(points).shape == shape
    assert box.compute_closest_points(points)["points"].shape == (*shape, 3)


def test_pinhole_rays():
    k, t = np.array([[500.0, 0, 4], [0, 400, 3], [0, 0, 1]]), np.eye(4)
    t[:3, 3] = 1, 2, 3
    rays = RaycastingScene.create_rays_pinhole(k, t, 8, 6)
    assert rays.shape == (6, 8, 6) and rays.dtype == np.float32
    assert np.allclose(rays[2, 3], [-1, -2, -3, -0.5 / 500, -0.5 / 400, 1])
    view = RaycastingScene.create_rays_pinhole(
        fov_deg=90, center=[0, 0, 0], eye=[0, 0, 4], up=[0, 1, 0], width_px=2, height_px=2
    )
    # As in Open3D, the first row is at the bottom and the first column to the right.
    assert np.allclose(view[0, 0], [0, 0, 4, 0.5, -0.5, -1])
    with pytest.raises(ValueError, match="3 x 3"):
        RaycastingScene.create_rays_pinhole(np.eye(4), np.eye(4), 8, 6)


def test_tensors_of_others():
    class Foreign:
        def __init__(self, values):
            self.values = np.asarray(values)

        def numpy(self):
            return self.values

    class Mesh:
        class vertex:
            positions = Foreign(BOX[0])

        class triangle:
            indices = Foreign(BOX[1].astype(np.int64))

    scene = RaycastingScene(nthreads=1)
    scene.add_triangles(Mesh())
    assert scene.count_intersections(Foreign(RAYS)).tolist() == [2, 1, 0]


def test_added_triangles_are_copies():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    faces = np.array([[0, 1, 2]], np.uint32)
    scene = RaycastingScene()
    for _ in range(3):
        scene.add_triangles(corners, faces)
        corners += np.float32([2, 0, 0])
    faces[:] = 0
    rays = [[x + 0.25, 0.25, 1, 0, 0, -1] for x in (0, 2, 4, 6)]
    ids = scene.cast_rays(rays)["geometry_ids"].tolist()
    assert ids == [0, 1, 2, RaycastingScene.INVALID_ID]
    corners[:] = 0
    normals = scene.compute_closest_points([[0.25, 0.25, 1]])["primitive_normals"]
    assert normals.tolist() == [[0, 0, 1]]


def test_same_as_the_scene():
    vertices, faces = icosphere(3)
    scene = RaycastingScene()
    scene.add_triangles(vertices, faces)
    other = mt.Scene()
    other.add_mesh(vertices, faces)
    rays = np.random.default_rng(0).normal(size=(1000, 6))
    assert np.array_equal(scene.cast_rays(rays)["t_hit"], other.prepare().intersect(rays).t)
