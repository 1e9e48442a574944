"""Compares ray queries with exact fractions, and tests the handling of arrays."""

from __future__ import annotations

import copy
import pickle
import resource
import subprocess
import sys
import threading
from fractions import Fraction

import microtrace as mt
import numpy as np
import pytest
from conftest import icosphere, interrupted_after
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays


def exact_hit(ray: np.ndarray, corners: np.ndarray) -> Fraction | None:
    """The exact t of the hit with a triangle that is not degenerate and not seen edge-on."""
    o, d = ([Fraction(float(x)) for x in part] for part in (ray[:3], ray[3:]))
    a, b, c = ([Fraction(float(x)) for x in corner] for corner in corners)

    def sub(u, v):
        return [x - y for x, y in zip(u, v)]

    def cross(u, v):
        return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]

    def dot(u, v):
        return sum(x * y for x, y in zip(u, v))

    n = cross(sub(b, a), sub(c, a))
    slope = dot(n, d)
    if slope == 0:
        return None
    t = dot(n, sub(a, o)) / slope
    p = [x + t * y for x, y in zip(o, d)]
    sides = [dot(n, cross(sub(v, u), sub(p, u))) for u, v in ((a, b), (b, c), (c, a))]
    return t if t > 0 and min(sides) >= 0 else None


small = st.integers(-3, 3).map(np.float32)


@settings(max_examples=300, deadline=None)
@given(arrays(np.float32, (6, 3, 3), elements=small), arrays(np.float32, (20, 6), elements=small))
def test_nearest_hits_equal_fractions(triangles, rays):
    vertices = triangles.reshape(-1, 3)
    scene = mt.Scene()
    scene.add_mesh(vertices, np.arange(len(vertices)).reshape(-1, 3))
    hits = scene.prepare().intersect(rays, fields=("t", "primitive"))
    corners = vertices.reshape(-1, 3, 3)
    for i, ray in enumerate(rays):
        found = [(exact_hit(ray, c), k) for k, c in enumerate(corners)]
        certain = [f for f in found if f[0] is not None]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        if (normals @ ray[3:] == 0).any():
            continue  # edge-on or without area; C++ tests cover these cases
        if not certain or not ray[3:].any():
            assert hits.primitive[i] == -1 and np.isinf(hits.t[i])
        else:
            t, k = min(certain)
            assert hits.primitive[i] == k
            assert hits.t[i] == np.float32(float(t))


def test_no_ray_leaves_a_closed_mesh(rng):
    vertices, faces = icosphere(3)
    vertices = vertices.astype(np.float32)
    scene = mt.Scene()
    scene.add_mesh(vertices, faces)
    prepared = scene.prepare()
    targets = np.concatenate([vertices, (vertices[faces[:, 0]] + vertices[faces[:, 1]]) / 2])
    o = rng.normal(size=(len(targets), 3)).astype(np.float32) * np.float32(0.1)
    rays = np.concatenate([o, targets - o], axis=1)
    assert prepared.intersect(rays).hit.all()
    assert prepared.occluded(rays).all()
    assert (prepared.count_crossings(rays) >= 1).all()


@pytest.fixture(scope="module")
def ball() -> mt.PreparedScene:
    vertices, faces = icosphere(2)
    scene = mt.Scene()
    scene.add_mesh(vertices, faces, name="ball")
    scene.add_sphere((0, 0, -5), 1, name="far")
    return scene.prepare()


def test_layouts_give_the_same_hits(ball, rng):
    rays = rng.normal(size=(60, 6)).astype(np.float32)
    expected = ball.intersect(rays)

    wide = np.zeros((60, 14), np.float32)
    wide[:, 1:13:2] = rays
    odd = np.frombuffer(b"\0" + rays.tobytes(), np.uint8)[1:].view(np.float32).reshape(60, 6)
    structured = np.zeros(60, [("pad", "u1"), ("ray", "f4", 6)])
    structured["ray"] = rays
    read_only = rays.copy()
    read_only.flags.writeable = False
    for other in (
        wide[:, 1:13:2],
        np.asfortranarray(rays),
        rays[::-1][::-1],
        odd,
        structured["ray"],
        read_only,
        rays.astype(">f4"),
        rays.astype(np.float64),
        rays.tolist(),
    ):
        found = ball.intersect(other)
        for name in ("t", "object", "primitive", "normal", "barycentrics"):
            assert np.array_equal(getattr(found, name), getattr(expected, name)), name
    shaped = ball.intersect(rays.reshape(3, 4, 5, 6))
    assert shaped.t.shape == (3, 4, 5) and shaped.normal.shape == (3, 4, 5, 3)
    assert np.array_equal(shaped.t.ravel(), expected.t)
    assert ball.intersect(rays[0]).t.shape == ()
    assert ball.intersect(np.zeros((0, 6))).t.shape == ball.intersect([]).t.shape == (0,)


def test_float64_is_rounded_once():
    scene = mt.Scene(origin=(1e8, 0, 0))
    scene.add_sphere((0, 0, 0), 1)
    prepared = scene.prepare()
    # 1e8 + 0.25 is not a float32, but it is one relative to the origin.
    hits = prepared.intersect([1e8 + 0.25, 0, 5, 0, 0, -1], fields=("t", "position"))
    assert hits.t == np.float32(5 - (1 - 0.25**2) ** 0.5)
    assert hits.position[0] == 1e8 + 0.25


def test_fields(ball):
    hits = ball.intersect([[0.1, 0.2, 5, 0, 0, -2], [9, 9, 9, 1, 0, 0]], fields=mt.hits._LAYOUTS)
    assert hits.front.tolist() == [True, False]
    assert hits.object.tolist() == [0, -1]
    vertices, faces = (np.asarray(x) for x in _mesh_of(ball))
    corners = vertices[faces[hits.primitive[0]]]
    assert np.allclose(hits.barycentrics[0] @ corners, hits.position[0], atol=1e-6)
    assert np.allclose(hits.position[0], [0.1, 0.2, 5 - 2 * hits.t[0]], atol=1e-6)
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    assert np.allclose(hits.face_normal[0], normal / np.linalg.norm(normal), atol=1e-6)
    assert hits.normal[1].tolist() == [0, 0, 0]
    only = ball.intersect([[0.1, 0.2, 5, 0, 0, -1]], fields=["primitive"])
    assert only.primitive == hits.primitive[0] and only.hit.all()
    with pytest.raises(AttributeError, match="'t' was not requested; add 't' to fields"):
        _ = only.t
    with pytest.raises(AttributeError, match="no attribute 'tee'"):
        _ = only.tee
    with pytest.raises(AttributeError, match="needs one of the fields object, primitive and t"):
        _ = ball.intersect(np.zeros((1, 6)), fields="uv").hit
    for other in (copy.copy(only), pickle.loads(pickle.dumps(only))):
        assert other.primitive == only.primitive and not hasattr(other, "t")
    assert repr(only) == "Hits(primitive=<int32 (1,)>)"
    assert ball.intersect(np.zeros((1, 6)), fields="uv").uv.shape == (1, 2)


def _mesh_of(prepared):
    mesh = prepared.scene.objects[0].shape
    return mesh.vertices, mesh.faces


def test_intervals(ball):
    ray = [0.1, 0.2, 5, 0, 0, -1]
    all_hits = ball.intersect_all([ray])
    first, second, third = all_hits.t  # a sphere counts once
    below = np.nextafter(first, np.float32(0))
    assert ball.intersect(ray, t_min=below).t == first
    assert ball.intersect(ray, t_min=first + np.float32(0.1)).t == second
    above = np.nextafter(first, np.float32(9))  # t itself is rounded
    assert ball.intersect([ray, ray], t_max=[above, 3]).hit.tolist() == [True, False]
    assert ball.occluded([ray, ray], t_max=[above, 3]).tolist() == [True, False]
    assert ball.count_crossings([ray, ray], t_min=[0, third - 0.5]).tolist() == [3, 1]
    assert np.all(np.diff(all_hits.t) >= 0)


def test_float64_ends_exclude_what_is_beyond_them():
    """The ends of lines of sight between points on surfaces, which float32 can't tell from 1."""
    scene = mt.Scene()
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    prepared, ray = scene.prepare(), [0.25, 0.25, 1, 0, 0, -1]
    for off in (1e-8, 1e-9, 1e-15):
        assert not prepared.occluded(ray, t_max=1 - off)
        assert prepared.occluded(ray, t_max=1 + off)
        assert not prepared.occluded(ray, t_min=1 + off)
        assert prepared.occluded(ray, t_min=1 - off)
    assert prepared.occluded(ray, t_min=1, t_max=1)
    on_surface = [0.25, 0.25, 0, 0, 0, 1]
    assert not prepared.occluded(on_surface, t_min=1e-46)
    assert prepared.occluded(on_surface, t_min=0)
    assert prepared.occluded(ray, t_max=1e39) and not prepared.occluded(ray, t_min=1e39)


def test_queries_find_surfaces_that_pictures_leave_out():
    scene = mt.Scene()
    material = mt.Material(double_sided=False, alpha_mode="mask", base_color_factor=(1, 1, 1, 0))
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], material=material)
    prepared = scene.prepare()
    for z in (1, -1):
        assert prepared.intersect([0.25, 0.25, z, 0, 0, -z]).t == 1


def test_transforms_are_relative_to_the_scene():
    scene = mt.Scene(origin=(5e5, 4.5e6, 0))
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], transform=np.eye(4))
    assert scene.prepare().intersect([5e5 + 0.25, 4.5e6 + 0.25, 1, 0, 0, -1]).hit


def test_all_hits_repeat_intersect(ball, rng):
    rays = rng.normal(size=(200, 6))
    found = ball.intersect_all(rays, fields=("t", "object", "primitive", "normal"))
    counts = np.diff(found.offsets)
    assert np.array_equal(counts, ball.count_crossings(rays))
    assert np.array_equal(found.ray, np.repeat(np.arange(200), counts))
    nearest = ball.intersect(rays)
    has_hit = counts > 0
    first = found.offsets[:-1][has_hit]
    for name in ("t", "object", "primitive", "normal"):
        assert np.array_equal(getattr(found, name)[first], getattr(nearest, name)[has_hit])


@pytest.mark.parametrize(
    "rays, error, text",
    [
        (np.zeros((4, 5)), ValueError, "(..., 6)"),
        (np.float32(1), ValueError, "(..., 6)"),
        (["a"] * 6, TypeError, "real numbers"),
        (np.zeros((2, 6), complex), TypeError, "real numbers"),
        (np.zeros((2, 6), bool), TypeError, "real numbers"),
        (None, TypeError, "real numbers"),
    ],
)
def test_wrong_rays(ball, rays, error, text):
    for query in (ball.intersect, ball.occluded, ball.intersect_all, ball.count_crossings):
        with pytest.raises(error) as raised:
            query(rays)
        assert text in str(raised.value)


def test_wrong_arguments(ball):
    for t_min in (-1, -np.inf, [0, -0.5]):
        for query in (ball.intersect, ball.occluded, ball.intersect_all):
            with pytest.raises(ValueError, match="t_min must not be negative, is -"):
                query(np.ones((2, 6)), t_min=t_min)
    with pytest.raises(ValueError, match="unknown field 'tee'"):
        ball.intersect(np.zeros((1, 6)), fields=["tee"])
    with pytest.raises(ValueError):
        ball.intersect(np.zeros((2, 6)), t_max=[1, 2, 3])
    with pytest.raises(TypeError):
        ball.intersect(np.zeros((2, 6)), t_max="far")


def test_numbers_that_are_not_finite(ball):
    rays = np.array([[np.nan, 0, 0, 1, 0, 0], [0, 0, 0, np.inf, 0, 0], [0, 0, 0, 0, 0, 0]])
    assert not ball.intersect(rays).hit.any()
    assert not ball.occluded(rays).any()


def test_threads_give_the_same(ball, rng):
    rays = rng.normal(size=(20000, 6)).astype(np.float32)
    expected = ball.intersect(rays, threads=1)
    results: list[mt.Hits] = []
    workers = [
        threading.Thread(target=lambda: results.append(ball.intersect(rays, threads=3)))
        for _ in range(4)
    ]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(results) == 4
    for hits in results:
        assert np.array_equal(hits.t, expected.t)
        assert np.array_equal(hits.normal, expected.normal)


def test_interrupt(rng):
    vertices, faces = icosphere(5)
    scene = mt.Scene()
    scene.add_mesh(vertices, faces)
    prepared = scene.prepare()
    rays = np.tile(rng.normal(size=(100_000, 6)).astype(np.float32), (100, 1))
    with interrupted_after(0.3):
        for _ in range(1000):
            prepared.intersect(rays, threads=1)  # typically stops 0.1 s after the signal


SMALL_STACKS = """
import sys, threading
import microtrace as mt, numpy as np

def query():
    scene = mt.Scene()
    scene.add_sphere((0, 0, 0), 1)
    scene.add_mesh(np.eye(3), [[0, 1, 2]])
    prepared = scene.prepare()
    for count in (1, 100, 3000, 10000):
        rays = np.random.default_rng(1).normal(size=(count, 6))
        hits = prepared.intersect(rays)
        assert (prepared.occluded(rays) == np.isfinite(hits.t)).all()
        assert (prepared.count_crossings(rays) > 0).sum() == np.isfinite(hits.t).sum()
    prepared.explain(rays[0])
    mt.render(prepared, mt.look_at((0, 0, 9), (0, 0, 0)), (32, 32), spp=1)
    print("done")

threading.stack_size(int(sys.argv[1]))
thread = threading.Thread(target=query)
thread.start()
thread.join()
"""


@pytest.mark.parametrize("limit", [None, 1 << 18])
@pytest.mark.parametrize("size", [1 << 16, 1 << 18])
def test_small_stacks(limit: int | None, size: int) -> None:
    def set_limit() -> None:
        if limit is not None:
            hard = resource.getrlimit(resource.RLIMIT_STACK)[1]
            resource.setrlimit(resource.RLIMIT_STACK, (limit, hard))

    command = [sys.executable, "-c", SMALL_STACKS, str(size)]
    run = subprocess.run(command, capture_output=True, text=True, preexec_fn=set_limit)
    assert (run.returncode, run.stdout, run.stderr) == (0, "done\n", "")


def test_origins_of_scenes():
    scene = mt.Scene(origin=(1e6, 0, 0))
    scene.add_mesh([[0.1, 0, 0], [0.12, 0, 0], [0.11, 1, 0]], [[0, 1, 2]])
    prepared = scene.prepare()
    # In float32, world space has a spacing of 1/16 here.
    rays = np.zeros((100, 6))
    rays[:, 0] = 1e6 + np.linspace(0.09, 0.13, 100)
    rays[:, 1:3] = 0.3, 5
    rays[:, 5] = -1
    fields = ("t", "object", "position")
    hits = prepared.intersect(rays, fields=fields)
    found = hits.object >= 0
    assert 0 < found.sum() < 100
    every = prepared.intersect_all(rays, fields=fields)
    assert np.array_equal(every.ray, np.nonzero(found)[0])
    assert np.array_equal(every.t, hits.t[found])
    assert np.array_equal(every.position, hits.position[found])
    assert np.array_equal(prepared.count_crossings(rays), found)
    assert [len(prepared.explain(ray)["hits"]) for ray in rays] == found.tolist()


def test_explanations() -> None:
    scene = mt.Scene()
    scene.add_sphere([0, 0, 0], 1, name="ball")
    scene.add_plane([0, 0, -2], [0, 0, 1], name="wall")
    prepared = scene.prepare()
    explanation = prepared.explain([0, 0, 5, 0, 0, -2])
    assert [(hit["name"], hit["t"], hit["verdict"]) for hit in explanation["hits"]] == [
        ("ball", 2, "visible"),
        ("wall", 3.5, "hidden"),
    ]
    numbers = explanation["hits"][0]["numbers"]
    assert (numbers["a"], numbers["b"], numbers["c"]) == (4, -20, 24)
    assert numbers["roots"] == [2, 3]
    assert explanation["misses"] == []
    assert float(explanation["ray"]["t_max"]) == np.inf
    limited = prepared.explain([0, 0, 5, 0, 0, -2], t_min=2.5, t_max=3, max_misses=1)
    assert [hit["t"] for hit in limited["hits"]] == [3]
    assert [(c["name"], c["t"]) for c in limited["crossings"]] == [("ball", 2), ("wall", 3.5)]
    assert limited["misses"] is None
    for rays in (np.zeros((1, 6)), np.zeros((2, 6)), np.zeros(5)):
        with pytest.raises(ValueError):
            prepared.explain(rays)
    with pytest.raises(ValueError, match="max_hits must be at least 0, not -1"):
        prepared.explain([0, 0, 5, 0, 0, -2], max_hits=-1)
    assert not prepared.explain([0, 0, 5, 0, 0, 0])["ray"]["valid"]
    assert not prepared.explain([np.nan, 0, 5, 0, 0, 1])["ray"]["valid"]
