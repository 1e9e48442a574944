"""Code as users write it, with all types. mypy --strict must accept it, and it must run."""

from __future__ import annotations

from pathlib import Path

import microtrace as mt
import numpy as np
import numpy.typing as npt
from microtrace.open3d import RaycastingScene
from microtrace.trimesh import RayMeshIntersector


class Tetrahedron:
    """An object with vertices and faces, which is accepted as a mesh."""

    vertices: npt.NDArray[np.float64] = np.array(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float
    )
    faces: npt.NDArray[np.int64] = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


def lengths(points: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    return np.asarray(np.sqrt((points * points).sum(-1)))


def build() -> mt.Scene:
    scene = mt.scene_of(Tetrahedron())
    gold = mt.Material(base_color_factor=(1, 0.7, 0.3, 1), clearcoat=mt.Clearcoat(1.0))
    ball: mt.Object = scene.add_sphere((3, 0, 0), 1, gold, name="ball")
    if isinstance(ball.shape, mt.Sphere):
        ball.shape.radius = 0.5
    scene.lights.append(mt.PointLight(position=(0, 5, 0), intensity=50))
    scene.environment = mt.Environment("studio")
    return scene


def trace(prepared: mt.PreparedScene) -> int:
    rays = np.zeros((4, 6), np.float32)
    rays[:, 2], rays[:, 5] = 5, -1
    hits = prepared.intersect(rays, t_max=[1, 2, 3, np.inf], fields=["t", "object"])
    nearest: npt.NDArray[np.float32] = hits.t
    blocked: npt.NDArray[np.bool_] = prepared.occluded(rays)
    crossings: npt.NDArray[np.uint32] = prepared.count_crossings(rays)
    every = prepared.intersect_all(rays)
    assert len(every.offsets) == 5 and int(crossings.sum()) == len(every.ray)
    inside: npt.NDArray[np.int8] = prepared.locate([(0.1, 0.1, 0.1)], object=0)
    near = prepared.closest_point([(0.1, 0.1, -1.0)], signed=True, object=0)
    assert (
        inside.tolist() == [1]
        and near.signed_distance.tolist() == lengths(near.position - (0.1, 0.1, -1)).tolist()
    )
    assert nearest.shape == (4,)
    return int(blocked.sum()) - int(hits.hit.sum())


def render(prepared: mt.PreparedScene, path: Path) -> npt.NDArray[np.float32]:
    def report(share: float) -> None:
        assert 0 < share <= 1

    views: list[mt.Camera] = [
        mt.look_at((3, 2, 5), (0, 0, 0)),
        mt.OrthographicCamera(position=(0, 0, 5)),
    ]
    views += mt.cameras(np.diag([9.0, 9.0, 1.0]), np.eye(4), (8, 8), convention="opengl")
    data = mt.render(prepared, views, (8, 8), spp=1, aovs=["color", "depth"], progress=report)
    data.one(0).save(bytes(path))
    depth: npt.NDArray[np.float32] = data.depth
    return depth


def replaced() -> tuple[int, int]:
    mesh = Tetrahedron()
    tri, ray = RayMeshIntersector(mesh).intersects_id([(0.1, 0.1, 5)], [(0, 0, -1)])
    scene = RaycastingScene()
    scene.add_triangles(mesh.vertices, mesh.faces)
    counted = scene.count_intersections([(0.1, 0.1, 5, 0, 0, -1)])
    return len(tri), int(counted.numpy()[0])


def load(path: str | Path) -> mt.Scene | str:
    try:
        return mt.load(path, detail="shape")
    except mt.SceneError as error:
        return error.diagnostic.pointer
    except OSError as error:
        return str(error)
