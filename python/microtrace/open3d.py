"""A replacement for Open3D's RaycastingScene with exact results. Doesn't require Open3D.

To use it in a script, change the import to `from microtrace.open3d import RaycastingScene`. Results
are NumPy arrays with the additional methods numpy(), cpu(), to() and isfinite() of Open3D's
tensors.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import (
    as_array,
    as_float,
    as_float32,
    as_indices,
    as_integer,
    as_real,
    as_reals,
    as_rows,
    as_threads,
    as_vector,
)
from .prepared import PreparedScene
from .scene import Scene

Array = npt.NDArray[Any]


class Tensor(np.ndarray[Any, Any]):
    """A NumPy array with some methods of open3d.core.Tensor."""

    def __getitem__(self, index: Any) -> Any:
        return np.asarray(super().__getitem__(index)).view(Tensor)

    def numpy(self) -> Array:
        """Returns the tensor as a plain NumPy array."""
        return np.asarray(self)

    def cpu(self) -> Tensor:
        """Returns this array."""
        return self

    def to(self, *_: Any, **__: Any) -> Tensor:
        """Returns this array, because there is only one device. Doesn't convert types."""
        return self

    def isfinite(self) -> Tensor:
        """Returns True for each number that is finite."""
        return np.asarray(np.isfinite(self)).view(Tensor)


class RaycastingScene:
    """Casts rays against triangles. Rays are float32 arrays of shape (..., 6). Ids are uint32, and
    INVALID_ID for misses.

    Hits are exact: they are the results of real arithmetic on the float32 numbers. Hits at the
    rays' origins count. If a ray hits several triangles at the same t, the hit is the one that was
    added first.
    """

    INVALID_ID = 0xFFFFFFFF

    def __init__(self, nthreads: int = 0, device: Any = None) -> None:
        self._threads = as_threads(nthreads, "nthreads")
        self._scene = Scene()
        self._prepared_scene: PreparedScene | None = None

    def add_triangles(
        self,
        vertex_positions: Any = None,
        triangle_indices: Any = None,
        *,
        vertices: Any = None,
        triangles: Any = None,
        mesh: Any = None,
    ) -> int:
        """Adds a copy of triangles and returns the id of their geometry.

        Args:
            vertex_positions: (V, 3) numbers, or a mesh of Open3D.
            triangle_indices: (F, 3) integers.
            vertices: another name for vertex_positions.
            triangles: another name for triangle_indices.
            mesh: a mesh of Open3D or trimesh.

        Raises:
            ValueError: an array has a wrong shape, a vertex is not finite, or an index is out of
                range.
            TypeError: an array has a wrong type of numbers, or there is no mesh.
        """
        positions = vertex_positions if vertices is None else vertices
        indices = triangle_indices if triangles is None else triangles
        if mesh is not None or indices is None:
            positions, indices = _arrays_of(positions if mesh is None else mesh)
        corners = as_rows(_numbers(positions), "vertex_positions", 3)
        faces = as_indices(_numbers(indices), "triangle_indices", 3)
        # Queries would fail later, and all of them.
        if not np.isfinite(as_float32(corners)).all():
            raise ValueError("vertex_positions must be finite as float32 numbers")
        if faces.size and int(faces.max()) >= len(corners):
            raise ValueError(
                f"triangle_indices must be below the number of vertices, {len(corners)}; "
                f"found {int(faces.max())}"
            )
        # The scene reads arrays later, when the caller may have changed them.
        self._scene.add_mesh(np.array(corners), np.array(faces))
        self._prepared_scene = None
        return len(self._scene.objects) - 1

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Tensor]:
        """Returns the nearest hit of each ray: t_hit, geometry_ids, primitive_ids, primitive_uvs
        (the weights of the second and third corner), and primitive_normals (unit normals of the
        side from which the winding is counterclockwise)."""
        hits = self._prepared().intersect(
            _numbers(rays),
            t_min=0,
            fields=("t", "object", "primitive", "barycentrics", "face_normal"),
            threads=self._count(nthreads),
        )
        return {
            "t_hit": _tensor(hits.t),
            "geometry_ids": _ids(hits.object),
            "primitive_ids": _ids(hits.primitive),
            "primitive_uvs": _tensor(np.ascontiguousarray(hits.barycentrics[..., 1:])),
            "primitive_normals": _tensor(hits.face_normal),
        }

    def test_occlusions(
        self, rays: Any, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0
    ) -> Tensor:
        """Returns True for each ray that hits anything at t in [tnear, tfar]."""
        near, far = as_float(tnear, "tnear"), as_float(tfar, "tfar")
        return _tensor(
            self._prepared().occluded(
                _numbers(rays),
                t_min=max(near, 0),
                t_max=far,
                threads=self._count(nthreads),
            )
        )

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Tensor:
        """Returns the number of hits of each ray, int32. Triangles at exactly the same t count
        once."""
        numbers = _numbers(rays)
        found, is_new = self._all(numbers, nthreads, ("t",))
        counts = np.bincount(found.ray[is_new], minlength=numbers[..., 0].size)
        return _tensor(counts.astype(np.int32).reshape(numbers.shape[:-1]))

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Tensor]:
        """Returns all hits, ray by ray, nearest first: ray_splits (number of rays + 1), ray_ids,
        t_hit, geometry_ids, primitive_ids and primitive_uvs. Triangles at exactly the same t count
        once."""
        numbers = _numbers(rays)
        fields = ("t", "object", "primitive", "barycentrics")
        found, is_new = self._all(numbers, nthreads, fields)
        ids = found.ray[is_new]
        splits = np.zeros(numbers[..., 0].size + 1, np.int64)
        np.cumsum(np.bincount(ids, minlength=len(splits) - 1), out=splits[1:])
        return {
            "ray_splits": _tensor(splits.astype(np.uint32)),
            "ray_ids": _tensor(ids.astype(np.uint32)),
            "t_hit": _tensor(found.t[is_new]),
            "geometry_ids": _ids(found.object)[is_new],
            "primitive_ids": _ids(found.primitive)[is_new],
            "primitive_uvs": _tensor(np.ascontiguousarray(found.barycentrics[is_new][:, 1:])),
        }

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> dict[str, Tensor]:
        """Returns the point on the triangles that is nearest to each query point: points,
        geometry_ids, primitive_ids, primitive_uvs and primitive_normals."""
        at = self._prepared().closest_point(_numbers(query_points), threads=self._count(nthreads))
        return {
            "points": _tensor(as_float32(at.position)),
            "geometry_ids": _ids(at.object),
            "primitive_ids": _ids(at.primitive),
            "primitive_uvs": _tensor(at.barycentrics[..., 1:].astype(np.float32)),
            "primitive_normals": _tensor(self._normals(at.object, at.primitive)),
        }

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> Tensor:
        """Returns the distance of each point from the triangles, float32."""
        at = self._prepared().closest_point(_numbers(query_points), threads=self._count(nthreads))
        return _tensor(as_float32(at.distance))

    def compute_signed_distance(
        self, query_points: Any, nthreads: int = 0, nsamples: int = 1
    ) -> Tensor:
        """Returns the distance of each point from the triangles, negative inside, float32.
        `nsamples` has no effect, because one exact test is sufficient."""
        points, threads = _numbers(query_points), self._count(nthreads)
        prepared = self._prepared()
        distance = prepared.closest_point(points, threads=threads).distance
        inside = prepared._locate(points, None, threads) > 0
        return _tensor(as_float32(np.where(inside, -distance, distance)))

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Tensor:
        """Returns 1 for points inside the triangles or on them, and 0 for others, float32."""
        sides = self._prepared()._locate(_numbers(query_points), None, self._count(nthreads))
        return _tensor((sides >= 0).astype(np.float32))

    @staticmethod
    def create_rays_pinhole(*args: Any, **kwargs: Any) -> Tensor:
        """Returns the rays of a pinhole camera through pixel centers, (height, width, 6) float32.

        Takes either intrinsic_matrix (3, 3), extrinsic_matrix (4, 4), width_px and height_px; or
        fov_deg (horizontal), center, eye, up, width_px and height_px. The extrinsic matrix maps
        world space to camera space, with +z forward and +y down. Directions are scaled to depth 1.
        """
        is_matrix = "intrinsic_matrix" in kwargs or (bool(args) and np.ndim(_numbers(args[0])) == 2)
        return _rays_by_matrix(*args, **kwargs) if is_matrix else _rays_by_view(*args, **kwargs)

    def _count(self, nthreads: int) -> int:
        return as_threads(nthreads, "nthreads") or self._threads

    def _prepared(self) -> PreparedScene:
        if self._prepared_scene is None:
            self._prepared_scene = self._scene.prepare(threads=self._threads)
        return self._prepared_scene

    def _all(self, rays: Array, nthreads: int, fields: Any) -> tuple[Any, Array]:
        """Returns all hits, and for each hit whether it is the first of its ray at its t."""
        found, ties = self._prepared()._intersect_all(
            rays, 0, None, fields, self._count(nthreads), finds_ties=True
        )
        return found, ~ties

    def _normals(self, objects: Array, faces: Array) -> npt.NDArray[np.float32]:
        result = np.zeros((*objects.shape, 3), np.float32)
        for k, item in enumerate(self._scene.objects):
            at = objects == k
            if not at.any():
                continue
            mesh: Any = item.shape
            corners = np.asarray(mesh.vertices, np.float32)[np.asarray(mesh.faces)[faces[at]]]
            corners = corners.astype(np.float64)
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            lengths = np.sqrt((normals * normals).sum(1, keepdims=True))
            result[at] = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
        return result


def _rays_by_matrix(
    intrinsic_matrix: Any, extrinsic_matrix: Any, width_px: int, height_px: int
) -> Tensor:
    k = as_reals(_numbers(intrinsic_matrix), "intrinsic_matrix").astype(np.float64)
    t = as_reals(_numbers(extrinsic_matrix), "extrinsic_matrix").astype(np.float64)
    if k.shape != (3, 3) or t.shape != (4, 4):
        raise ValueError(f"matrices must be 3 x 3 and 4 x 4, not {k.shape} and {t.shape}")
    x, y = _centers(width_px, height_px)
    y = (y - k[1, 2]) / k[1, 1]
    x = (x - k[0, 2] - k[0, 1] * y) / k[0, 0]
    rotation = t[:3, :3]
    directions = x[..., None] * rotation[0] + y[..., None] * rotation[1] + rotation[2]
    eye = -(rotation * t[:3, 3:]).sum(0)
    return _rays_from(eye, directions)


def _rays_by_view(
    fov_deg: float, center: Any, eye: Any, up: Any, width_px: int, height_px: int
) -> Tensor:
    position = np.array(as_vector(_numbers(eye), "eye"))
    forward = np.array(as_vector(_numbers(center), "center")) - position
    forward /= np.sqrt((forward * forward).sum())
    # As in Open3D, rows are numbered upward and columns to the left.
    left = np.cross(as_vector(_numbers(up), "up"), forward)
    left /= np.sqrt((left * left).sum())
    upward = np.cross(forward, left)
    fov = np.radians(as_real(fov_deg, "fov_deg", 0, 180))
    x, y = _centers(width_px, height_px)
    focal = 0.5 * width_px / np.tan(0.5 * fov)
    x, y = (x - 0.5 * width_px) / focal, (y - 0.5 * height_px) / focal
    return _rays_from(position, x[..., None] * left + y[..., None] * upward + forward)


def _centers(width_px: Any, height_px: Any) -> list[Array]:
    """Returns x and y of the pixels' centers."""
    width = as_integer(width_px, "width_px", 0, 65536)
    height = as_integer(height_px, "height_px", 0, 65536)
    return list(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5))


def _rays_from(eye: Array, directions: Array) -> Tensor:
    result = np.empty((*directions.shape[:2], 6), np.float32)
    result[..., :3] = eye
    result[..., 3:] = directions
    return result.view(Tensor)


def _numbers(values: Any) -> Array:
    """Converts lists, arrays, and tensors of other libraries to arrays."""
    is_tensor = hasattr(values, "numpy") and not isinstance(values, np.ndarray)
    return as_array(values.numpy() if is_tensor else values, "values")


def _arrays_of(mesh: Any) -> tuple[Any, Any]:
    """Returns vertices and triangles of an open3d.t.geometry.TriangleMesh, an
    open3d.geometry.TriangleMesh, or a mesh of trimesh."""
    if hasattr(mesh, "vertex"):
        return mesh.vertex.positions, mesh.triangle.indices
    if not hasattr(mesh, "vertices"):
        raise TypeError(f"expected vertex positions and triangle indices, or a mesh, not {mesh!r}")
    return mesh.vertices, mesh.faces if hasattr(mesh, "faces") else mesh.triangles


def _tensor(array: Array) -> Tensor:
    return array.view(Tensor)


def _ids(indices: Array) -> Tensor:
    return indices.view(np.uint32).view(Tensor)  # -1 is INVALID_ID
