"""Tests queries of points inside and outside of meshes, and of nearest points."""

from __future__ import annotations

import microtrace as mt
import numpy as np
import pytest
from conftest import icosphere


@pytest.fixture(scope="module")
def ball() -> mt.PreparedScene:
    scene = mt.Scene()
    scene.add_mesh(*icosphere(3))
    return scene.prepare()


def test_objects_are_counted_from_0():
    scene = mt.Scene()
    scene.add_mesh(*icosphere(1))
    for object in (-1, 1):
        with pytest.raises(mt.UsageError):
            scene.prepare().closest_point([[0, 0, 0]], object=object)


def test_locate(ball, rng):
    vertices = np.asarray(ball.scene.objects[0].shape.vertices)
    assert (ball.locate(vertices) == 0).all()
    assert ball.contains(vertices).all()
    directions = rng.normal(size=(5000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    assert (ball.locate(directions * 0.9) == 1).all()
    assert (ball.locate(directions * 1.001) == -1).all()
    assert ball.locate(np.zeros((2, 3, 3))).shape == (2, 3)
    assert ball.is_closed() and len(ball.open_edges()) == 0


def test_closest_point(ball, rng):
    points = rng.uniform(-2, 2, (1000, 3)).astype(np.float32)
    at = ball.closest_point(points, signed=True)
    offset = np.linalg.norm(points - at.position, axis=1)
    assert np.allclose(at.distance, offset, rtol=1e-9)
    mesh = ball.scene.objects[0].shape
    corners = np.asarray(mesh.vertices, np.float64)[np.asarray(mesh.faces)[at.primitive]]
    assert np.allclose((at.barycentrics[..., None] * corners).sum(1), at.position, atol=1e-12)
    # No vertex or face center is nearer.
    samples = np.concatenate([mesh.vertices, np.asarray(mesh.vertices)[mesh.faces].mean(1)])
    nearest = np.min(np.linalg.norm(points[:, None] - samples[None], axis=2), axis=1)
    assert (at.distance <= nearest + 1e-6).all()
    assert np.array_equal(at.sign, -ball.locate(points))
    assert np.array_equal(at.signed_distance < 0, at.sign < 0)
    assert isinstance(ball.closest_point(points[0], signed=True).sign, np.ndarray)
    for name in ("sign", "signed_distance"):
        with pytest.raises(AttributeError, match=f"'{name}' was not requested.*signed=True"):
            getattr(ball.closest_point(points), name)


def test_far_from_the_origin(ball, rng):
    origin = np.array([6378137.25, -(2.0**25) + 0.125, 3.5])
    scene = mt.Scene(objects=ball.scene.objects, origin=tuple(origin))
    prepared = scene.prepare()
    points = np.round(rng.uniform(-1.5, 1.5, size=(500, 3)) * 1024) / 1024  # sums are exact
    assert np.array_equal(prepared.locate(points + origin), ball.locate(points))
    far = prepared.closest_point(points + origin, signed=True)
    near = ball.closest_point(points, signed=True)
    assert np.array_equal(far.signed_distance, near.signed_distance)
    assert np.array_equal(far.primitive, near.primitive)
    assert np.array_equal(far.position, near.position + origin)


def test_open_mesh():
    scene = mt.Scene()
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    prepared = scene.prepare()
    assert not prepared.is_closed()
    assert prepared.open_edges().shape == (3, 2, 3)
    with pytest.warns(mt.OpenMeshWarning) as warned:
        assert prepared.contains([[0.25, 0.25, 0], [0.25, 0.25, 1]]).tolist() == [True, False]
    assert warned[0].filename == __file__


def test_one_object_of_several():
    scene = mt.Scene()
    scene.add_mesh(*icosphere(1))
    scene.add_mesh(icosphere(1)[0] * 2, icosphere(1)[1])
    prepared = scene.prepare()
    assert prepared.locate([0, 0, 0]) == -1  # within an even number of shells
    assert prepared.locate([0, 0, 0], object=0) == 1
    assert prepared.closest_point([0, 0, 3], object=0).distance > 1.9
    with pytest.raises(ValueError):
        prepared.locate([0, 0, 0], object=2)


def test_nothing():
    prepared = mt.Scene().prepare()
    at = prepared.closest_point([[0, 0, 0]])
    assert np.isinf(at.distance).all() and at.object.tolist() == [-1]
    assert prepared.contains([[0, 0, 0]]).tolist() == [False]
    assert np.isnan(at.position).all()


@pytest.mark.filterwarnings("error")
def test_points_beyond_float32_are_outside(ball):
    assert ball.contains([[1e300, 0, 0]]).tolist() == [False]
    ball.closest_point([[1e300, 0, 0]])
