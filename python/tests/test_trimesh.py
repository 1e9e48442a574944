"""Compares the ray engine for trimesh with trimesh's own."""

from __future__ import annotations

import copy
import itertools
import pickle
import subprocess
import sys
import warnings
from fractions import Fraction

import microtrace as mt
import numpy as np
import pytest
import trimesh
import trimesh.ray.ray_triangle
from microtrace.trimesh import RayMeshIntersector


@pytest.fixture
def rays(rng):
    origins = rng.normal(size=(400, 3)) * 3
    return origins, rng.uniform(-0.5, 0.5, size=(400, 3)) - origins


def engines(mesh):
    return RayMeshIntersector(mesh), trimesh.ray.ray_triangle.RayMeshIntersector(mesh)


@pytest.mark.parametrize("shift", [0, 1000.1])
def test_same_as_trimesh(rays, shift):
    mesh = trimesh.creation.icosphere(subdivisions=2)
    mesh.apply_translation([shift, -shift, shift])
    origins, directions = rays[0] + [shift, -shift, shift], rays[1]
    ours, theirs = engines(mesh)
    assert np.array_equal(
        ours.intersects_any(origins, directions), theirs.intersects_any(origins, directions)
    )
    assert np.array_equal(
        ours.intersects_first(origins, directions), theirs.intersects_first(origins, directions)
    )
    a, b = (set(zip(*e.intersects_id(origins, directions))) for e in (ours, theirs))
    assert a == b and len(a) > 400
    points, index_ray, index_tri = ours.intersects_location(origins, directions)
    their_points, their_ray, their_tri = theirs.intersects_location(origins, directions)
    assert len(points) == len(their_points)
    order, their_order = np.lexsort((index_tri, index_ray)), np.lexsort((their_tri, their_ray))
    assert np.allclose(points[order], their_points[their_order], rtol=0, atol=1e-9)
    # Ray by ray, nearest first.
    assert (np.diff(index_ray) >= 0).all()
    distance = np.linalg.norm(points - origins[index_ray], axis=1)
    same_ray = np.diff(index_ray) == 0
    assert (np.diff(distance)[same_ray] > 0).all()
    tri, ray, near = ours.intersects_id(
        origins, directions, multiple_hits=False, return_locations=True
    )
    assert len(np.unique(ray)) == len(ray) and len(near) == len(tri)
    assert np.array_equal(ours.intersects_first(origins, directions)[ray], tri)


def test_corners_and_edges_count_once():
    mesh = trimesh.creation.box()
    engine = RayMeshIntersector(mesh)
    targets = np.concatenate([mesh.vertices, mesh.vertices[mesh.edges_unique].mean(axis=1)])
    origins = np.zeros_like(targets)
    assert engine.intersects_any(origins, targets).all()
    _, index_ray, _ = engine.intersects_location(origins, targets)
    assert (np.bincount(index_ray, minlength=len(targets)) == 1).all()
    for more in ({}, {"max_hits": 1}, {"multiple_hits": False}):
        _, index_ray = engine.intersects_id(origins, targets, **more)
        assert np.array_equal(index_ray, np.arange(len(targets)))


def test_hits_at_one_point_count_once():
    """The rays of the grid hit edges and the centers of the caps of the cylinder."""
    mesh = trimesh.creation.cylinder(radius=1, height=4, sections=32)
    x = np.linspace(-0.6, 0.6, 17)
    origins = np.stack(np.meshgrid(x, x, [-5.0]), axis=-1).reshape(-1, 3)
    directions = np.tile([0.0, 0.0, 1.0], (len(origins), 1))
    _, ray = RayMeshIntersector(mesh).intersects_id(origins, directions)
    assert np.array_equal(np.bincount(ray, minlength=len(origins)), np.full(len(origins), 2))


def test_order_of_faces_makes_no_difference():
    small = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]])
    vertices = np.concatenate([small, 2 * small - [1, 1, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    for order in itertools.permutations(range(4)):
        mesh = trimesh.Trimesh(vertices, faces[list(order)], process=False)
        hits = RayMeshIntersector(mesh).intersects_location([[1, 1, 5]], [[0, 0, -1]])
        assert len(hits[0]) == 2, order


def test_rays_that_cut_off_an_edge_hit_both_sides():
    """The ray enters at t = 100 - 4/3 u and leaves at 100 - u, which both round to 100 - u."""
    box, u = trimesh.creation.box(), 2.0**-17
    origin, along = np.array([u - 99.5, u - 75.5, 0.1]), np.array([1, 0.75, 0])
    tri, ray = RayMeshIntersector(box).intersects_id([origin], [along])
    assert (box.face_normals[tri] @ along > 0).tolist() == [False, True]
    assert RayMeshIntersector(box).intersects_id([origin + [2 * u, 0, 0]], [along])[0].size == 0


def test_close_surfaces_count_twice():
    """Two squares whose distances from the origin round to the same t."""
    square = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float64)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    gap = [0, 0, 2.0**-30]
    mesh = trimesh.Trimesh(
        np.concatenate([square, square + gap]), np.concatenate([faces, faces + 4]), process=False
    )
    for x in (0.25, 0.5):
        tri, _, locations = RayMeshIntersector(mesh).intersects_id(
            [[x, 0.5, -3]], [[0, 0, 1]], return_locations=True
        )
        assert len(tri) == len(locations) == 2


def l_prism():
    """A closed mesh with saddles: the prism over an L."""
    base = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], float)
    vertices = np.concatenate([np.insert(base, 2, z, axis=1) for z in (0, 1)])
    caps = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
    sides = [[i, j, j + 6, i, j + 6, i + 6] for i, j in zip(range(6), [1, 2, 3, 4, 5, 0])]
    faces = np.concatenate([caps[:, ::-1], caps + 6, np.reshape(sides, (-1, 3))])
    return trimesh.Trimesh(vertices, faces, process=False)


def test_rays_through_saddles_enter_and_leave_once(rng):
    """Rays at vertices and edges of closed meshes: hits are where exact queries for points tell
    that the ray goes in or out."""
    torus = trimesh.creation.torus(2, 0.5, major_sections=12, minor_sections=8)
    torus = trimesh.Trimesh(np.round(torus.vertices * 1024) / 1024, torus.faces, process=False)
    for mesh in (l_prism(), torus):
        scene = mt.Scene()
        scene.add_mesh(mesh.vertices, mesh.faces)
        solid = scene.prepare()
        ends = mesh.vertices[mesh.faces[rng.integers(len(mesh.faces), size=800)]]
        targets = np.where(
            rng.integers(2, size=(800, 1)), ends[:, 0], (ends[:, 0] + ends[:, 1]) / 2
        )
        origins = rng.integers(-20, 21, (800, 3)) / 2.0
        along = (targets - origins) * 2
        # Whether rays in the planes of triangles are inside of the mesh isn't defined.
        in_plane = np.abs(mesh.triangles_cross @ along.T).min(axis=0) < 1e-9
        is_wanted = (np.abs(origins) > 3).any(axis=1) & ~in_plane
        origins, along = origins[is_wanted], along[is_wanted]
        assert len(origins) > 400
        _, ray, at = RayMeshIntersector(mesh).intersects_id(origins, along, return_locations=True)
        assert (np.bincount(ray, minlength=len(along)) % 2 == 0).all()
        for i in range(0, len(along), 8):
            t = ((at[ray == i] - origins[i]) @ along[i]) / (along[i] @ along[i])
            middle = origins[i] + along[i] * ((t[1:] + t[:-1]) / 2)[:, None]
            is_wide = t[1:] - t[:-1] > 1e-6
            assert (solid.locate(middle)[is_wide] == np.resize([1, -1], len(t) - 1)[is_wide]).all()


def test_folds_at_a_vertex_count_three_times():
    """Three triangles at a vertex, of which the first and the last face the same side. The ray hits
    them at 3, 3 + 2^-31 and 3 + 2^-30, which all round to 3."""
    fold = [[(0, 0, 0), (1, -1, k * 2.0**-30), (1, 1, k * 2.0**-30)] for k in range(3)]
    faces = np.array([[0, 1, 2], [3, 5, 4], [6, 7, 8]])
    mesh = trimesh.Trimesh(np.concatenate(fold), faces, process=False)
    engine = RayMeshIntersector(mesh)
    tri, ray = engine.intersects_id([[0.5, 0.1, -3]] * 2, [[0, 0, 1]] * 2)
    assert tri.tolist() == [0, 1, 2] * 2 and ray.tolist() == [0] * 3 + [1] * 3
    assert len(engine.intersects_location([[0.5, 0.1, -3]], [[0, 0, 1]])[0]) == 3
    # At the vertex itself, one hit counts for each side.
    assert engine.intersects_id([[0, 0, -3]], [[0, 0, 1]])[0].tolist() == [0, 1]


def hits_by_fractions(corners, origin):
    """Returns the triangles that count for a ray along z, by exact arithmetic."""
    found = []
    for k, (a, b, c) in enumerate(corners):
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area == 0:
            continue
        sides = [
            ((q[0] - p[0]) * (origin[1] - p[1]) - (q[1] - p[1]) * (origin[0] - p[0])) / area
            for p, q in ((b, c), (c, a), (a, b))
        ]
        t = sum(w * p[2] for w, p in zip(sides, (a, b, c))) - origin[2]
        if min(sides) >= 0 and t >= 0:
            zeros = sides.count(0)
            turn = 1.0 if zeros == 0 else 0.5
            if zeros == 2:
                at = next(i for i, w in enumerate(sides) if w != 0)
                p, q, r = (
                    np.array([float(x) for x in (a, b, c)[(at + k) % 3][:2]]) for k in range(3)
                )
                u, v = q - p, r - p
                turn = abs(np.arctan2(u[0] * v[1] - u[1] * v[0], u @ v)) / (2 * np.pi)
            found.append((t, k, area > 0, turn))
    found.sort(key=lambda hit: hit[:2])
    counting = []
    for t in sorted({hit[0] for hit in found}):
        here = [hit for hit in found if hit[0] == t]
        front, back = (sum(h[3] for h in here if h[2] == s and h[3] < 1) for s in (True, False))
        most = {True: np.ceil(front - 1e-6), False: np.ceil(back - 1e-6)}
        net = round(front - back)
        if abs(front - back - net) < 1e-6:
            most = {True: max(net, net == 0), False: max(-net, net == 0)}
        for _, k, is_front, turn in here:
            if turn < 1:
                most[is_front] -= 1
            if turn == 1 or most[is_front] >= 0:
                counting.append(k)
    return counting


def test_hits_of_thin_meshes_equal_those_of_fractions(rng):
    """The vertices are so close to a plane that all t round to the same number."""
    counts = []
    for _ in range(25):
        vertices = rng.integers(-2, 3, (9, 3)).astype(float)
        vertices[:, 2] = rng.integers(-3, 4, 9) * 2.0**-30
        vertices = np.concatenate([vertices, [[9, 9, 9], [-9, -9, -9]]])  # the center is 0
        faces = rng.integers(0, 9, (14, 3))
        mesh = trimesh.Trimesh(vertices, faces, process=False)
        origins = np.concatenate([rng.integers(-4, 5, (40, 2)) / 2, np.full((40, 1), -3.0)], 1)
        tri, ray = RayMeshIntersector(mesh).intersects_id(origins, np.tile([0, 0, 1.0], (40, 1)))
        points = [tuple(map(Fraction, p)) for p in vertices.tolist()]
        corners = [[points[i] for i in face] for face in faces.tolist()]
        for i, origin in enumerate(origins.tolist()):
            wanted = hits_by_fractions(corners, list(map(Fraction, origin)))
            assert tri[ray == i].tolist() == wanted
            counts.append(len(wanted))
    assert sum(count > 2 for count in counts) > 100


@pytest.mark.parametrize("scale", [1e-4, 0.1, 1, 10, 1e4, 1e8])
def test_hits_at_the_origin_count(scale):
    mesh = trimesh.creation.box().subdivide().subdivide()
    mesh.apply_scale(scale)
    engine = RayMeshIntersector(mesh)
    origins = np.array([[0, 0, scale / 2]])
    for z, hits in ((-1.0, 2), (1.0, 1)):
        tri, _ = engine.intersects_id(origins, [[0, 0, z]])
        assert len(tri) == hits
        assert engine.intersects_any(origins, [[0, 0, z]]).all()


def test_parallel_triangles_are_not_hit():
    corners = np.array([[0, 0, 0], [0.125, 0, 0], [0.125, 0.5, 0], [0, 0.5, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    flat = RayMeshIntersector(trimesh.Trimesh(corners, faces, process=False))
    ray = [[-0.5, 0.125, 0]], [[1, 0, 0]]
    locations, index_ray, index_tri = flat.intersects_location(*ray, multiple_hits=False)
    assert locations.shape == (0, 3) and len(index_ray) == len(index_tri) == 0
    assert not flat.intersects_any(*ray)[0]
    assert flat.intersects_first(*ray)[0] == -1
    # The least possible slope is a hit.
    assert flat.intersects_any([[-0.9375, 0.125, -(2.0**-149)]], [[1, 0, 2.0**-149]])[0]
    # A ray along a face of a box enters and leaves through the neighboring faces.
    box = RayMeshIntersector(trimesh.creation.box())
    tri, _, locations = box.intersects_id([[-3, 0.25, 0.5]], [[1, 0, 0]], return_locations=True)
    assert np.array_equal(np.sort(locations[:, 0]), [-0.5, 0.5])
    assert box.intersects_first([[-3, 0.25, 0.5]], [[1, 0, 0]])[0] == tri[0]
    assert (np.abs(box.mesh.face_normals[tri, 0]) == 1).all()


def test_contains():
    mesh = trimesh.creation.icosphere(subdivisions=3)
    mesh.ray = RayMeshIntersector(mesh)
    assert mesh.contains(mesh.vertices * 0.99).all()
    assert not mesh.contains(mesh.vertices * 1.01).any()
    assert mesh.ray.contains_points(mesh.vertices).all()
    assert mesh.contains([mesh.center_mass]).all()
    # trimesh itself uses the engine here.
    depth = trimesh.proximity.signed_distance(mesh, [[0, 0, 0.5], [0, 0, 2]])
    assert depth[0] > 0 > depth[1]
    assert (trimesh.proximity.thickness(mesh, mesh.triangles_center[:20], method="ray") > 1).all()
    with pytest.raises(ValueError, match=r"\(n,3\)"):
        mesh.ray.contains_points([[1, 2]])


def test_nothing_and_wrong_input():
    engine = RayMeshIntersector(trimesh.creation.box())
    empty = np.zeros((0, 3))
    assert [len(x) for x in engine.intersects_id(empty, empty, return_locations=True)] == [0, 0, 0]
    assert engine.intersects_location(empty, empty)[0].shape == (0, 3)
    assert engine.intersects_first([[9, 9, 9]], [[0, 0, 1]]).tolist() == [-1]
    assert engine.intersects_first([[9, 9, 9]], [[0, 0, 0]]).tolist() == [-1]
    with pytest.raises(ValueError, match="same|both"):
        engine.intersects_any([[0, 0, 0]], [[0, 0, 1]] * 2)


def test_changes_and_copies():
    mesh = trimesh.creation.box()
    mesh.ray = RayMeshIntersector(mesh)
    assert mesh.ray.intersects_any([[0.9, 0, 5]], [[0, 0, -1]]).tolist() == [False]
    mesh.apply_scale(2)
    assert mesh.ray.intersects_any([[0.9, 0, 5]], [[0, 0, -1]]).tolist() == [True]
    for other in (
        copy.deepcopy(mesh.ray),
        copy.copy(mesh.ray),
        pickle.loads(pickle.dumps(mesh.ray)),
    ):
        assert other.intersects_any([[0.9, 0, 5]], [[0, 0, -1]]).all()


def test_install():
    """Runs in another process, because install() changes trimesh."""
    code = """
import microtrace.trimesh, trimesh
microtrace.trimesh.install()
mesh = trimesh.creation.box()
assert isinstance(mesh.ray, microtrace.trimesh.RayMeshIntersector)
assert mesh.contains([[0, 0, 0]]).all()
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_scenes():
    scene = trimesh.Scene()
    move = np.eye(4)
    move[:3, 3] = 5, 0, 0
    ball = trimesh.creation.icosphere()
    ball.visual.vertex_colors = np.tile([255, 0, 0, 255], (len(ball.vertices), 1))
    scene.add_geometry(trimesh.creation.box(), node_name="box")
    scene.add_geometry(ball, node_name="ball", transform=move)
    ours = mt.scene_of(scene)
    assert [item.name for item in ours.objects] == ["box", "ball"]
    prepared = ours.prepare()
    assert prepared.intersect([5, 0, 9, 0, 0, -1], fields=("t", "object")).object == 1
    picture = mt.render(
        prepared, mt.look_at((5, 0, 9), (5, 0, 0)), (9, 9), aovs=["albedo", "object"]
    )
    assert picture.albedo[4, 4].tolist() == [1, 0, 0]
    assert mt.scene_of(trimesh.creation.box()).prepare().is_closed()
    red = trimesh.visual.material.PBRMaterial(baseColorFactor=[255, 0, 0, 255], metallicFactor=0.5)
    plain = trimesh.creation.box()
    plain.visual = trimesh.visual.TextureVisuals(uv=None, material=red)
    material = mt.scene_of(plain).objects[0].material
    assert material.base_color_factor == (1, 0, 0, 1) and material.metallic_factor == 0.5
    phong = trimesh.visual.material.SimpleMaterial(diffuse=[0, 255, 0, 255])
    plain.visual = trimesh.visual.TextureVisuals(uv=None, material=phong)
    material = mt.scene_of(plain).objects[0].material
    assert material.base_color_factor == (0, 1, 0, 1) and material.metallic_factor == 0
    with pytest.raises(TypeError, match="vertices and faces"):
        mt.scene_of("mesh")


def test_face_colors_are_not_blended():
    box = trimesh.creation.box()
    box.visual.face_colors = [[0, 0, 255, 255]] * 12
    box.visual.face_colors[box.face_normals[:, 2] > 0.5] = (255, 0, 0, 255)
    prepared = mt.scene_of(box).prepare()
    assert prepared.is_closed()
    for direction, color in [((0, 0, 1), [1, 0, 0]), ((1, 0, 0), [0, 0, 1])]:
        camera = mt.look_at(tuple(5 * x for x in direction), (0, 0, 0), vertical_fov_degrees=2)
        albedo = mt.render(prepared, camera, (9, 9), aovs=["albedo"]).albedo
        assert (albedo == np.float32(color)).all()
    rays = np.random.default_rng(2).normal(size=(100, 6))
    primitives = mt.scene_of(trimesh.creation.box()).prepare().intersect(rays).primitive
    assert np.array_equal(prepared.intersect(rays).primitive, primitives)


def normals_of(mesh):
    return mt.scene_of(mesh).objects[0].shape.normals


def test_only_loaded_normals_are_used():
    box = trimesh.creation.box()
    box.vertex_normals  # trimesh keeps what it computes  # noqa: B018
    assert normals_of(box) is None
    box.apply_transform(trimesh.transformations.rotation_matrix(0.3, (1, 2, 3), (4, 5, 6)))
    assert normals_of(box) is None
    ball = trimesh.creation.icosphere()
    smooth = np.float32(ball.vertices)
    loaded = trimesh.Trimesh(ball.vertices, ball.faces, vertex_normals=smooth, process=False)
    assert np.array_equal(normals_of(loaded), smooth)
    loaded.apply_transform(trimesh.transformations.rotation_matrix(0.3, (1, 2, 3)))
    assert normals_of(loaded) is not None
    loaded.vertices *= (1, 3, 1)  # these normals were those of the ball
    assert normals_of(loaded) is None


def test_infinite_directions_hit_nothing():
    mesh = trimesh.creation.box()
    engine = RayMeshIntersector(mesh)
    directions = [[np.inf, 0, 0], [-np.inf, np.inf, 1], [np.nan, 0, 0], [0, 0, -1]]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        first = engine.intersects_first([[0, 0, 9]] * 4, directions)
    assert (first[:3] == -1).all() and first[3] >= 0


def test_exact_directions_stay_exact():
    box = trimesh.creation.box()
    random = np.random.default_rng(1)
    origins = random.integers(-400, 400, (2000, 3)) / 32
    directions = box.vertices[random.integers(0, 8, 2000)] - origins
    assert RayMeshIntersector(box).intersects_any(origins, directions).all()
    assert (
        RayMeshIntersector(box)
        .intersects_any([[0, 0, 5]] * 2, [[0, 0, -1e300], [0, 0, -1e-310]])
        .all()
    )


@pytest.mark.parametrize("stray", [1e9, np.nan, np.inf])
def test_vertices_that_no_face_uses_have_no_effect(stray):
    ball = trimesh.creation.icosphere(subdivisions=3)
    offset = np.array([500000.3, 4000000.7, 12.1])
    mesh = trimesh.Trimesh(
        np.vstack([ball.vertices + offset, [[stray, 0, 0]]]), ball.faces, process=False
    )
    clean = trimesh.Trimesh(ball.vertices + offset, ball.faces, process=False)
    random = np.random.default_rng(2)
    origins, targets = random.uniform(-2, 2, (2, 300, 3))
    rays = origins + offset, targets - origins
    ours, others = (RayMeshIntersector(m).intersects_id(*rays, True) for m in (mesh, clean))
    for a, b in zip(ours, others):
        np.testing.assert_array_equal(a, b)


def test_the_order_of_arguments_is_that_of_trimesh():
    box = trimesh.creation.box()
    engines = RayMeshIntersector(box), trimesh.ray.ray_triangle.RayMeshIntersector(box)
    for more in ([], [True], [True, False], [False, False], [False, True]):
        ours, theirs = (e.intersects_id([[0.1, 0.2, 5]], [[0, 0, -1]], *more) for e in engines)
        assert len(ours) == len(theirs)
        assert len(ours[0]) == len(theirs[0])


def test_overlapping_triangles_that_share_a_vertex_are_all_hit():
    corners = [[-1, -1, 0], [1, -1, 0], [0, 1, 0], [-1, -1, -1], [1, -1, 1]]
    crossing = trimesh.Trimesh(corners, [[0, 1, 2], [3, 4, 2]], process=False)
    engine = RayMeshIntersector(crossing)
    assert engine.intersects_id([[0, 0, 5]], [[0, 0, -1]])[0].tolist() == [0, 1]
    assert len(engine.intersects_id([[0, 1, 5]], [[0, 0, -1]])[0]) == 1  # at the common vertex
    box = trimesh.creation.box()
    double = trimesh.Trimesh(box.vertices, np.vstack([box.faces, box.faces]), process=False)
    assert len(RayMeshIntersector(double).intersects_id([[0.1, 0.2, 5]], [[0, 0, -1]])[0]) == 4


def test_many_triangles_that_meet_at_a_vertex_count_once():
    cone = RayMeshIntersector(trimesh.creation.cone(1, 1, sections=20000))
    tri, ray = cone.intersects_id([[0, 0, 5]] * 3, [[0, 0, -1]] * 3)
    assert ray.tolist() == [0, 0, 1, 1, 2, 2]
    assert tri[:2].tolist() == tri[2:4].tolist() == tri[4:].tolist()


def test_rays_in_the_plane_of_many_triangles_miss_them():
    x, y = np.meshgrid(np.arange(201.0), np.arange(201.0))
    corners = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    low = (np.arange(200)[:, None] * 201 + np.arange(200)).ravel()
    squares = np.stack([low, low + 1, low + 202, low, low + 202, low + 201], axis=1)
    plane = RayMeshIntersector(trimesh.Trimesh(corners, squares.reshape(-1, 3), process=False))
    origins = np.stack([np.full(100, -1.0), np.linspace(0.1, 199.9, 100), np.zeros(100)], axis=1)
    assert not plane.intersects_any(origins, [[1, 0, 0]] * 100).any()


def test_arguments_in_the_order_of_the_engine_for_embree_are_refused():
    box = RayMeshIntersector(trimesh.creation.box())
    with pytest.raises(TypeError, match="return_locations, multiple_hits, max_hits"):
        box.intersects_id([[0.1, 0.2, 5]], [[0, 0, -1]], True, 20, True)
