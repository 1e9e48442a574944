"""Exact ray queries for trimesh: `mesh.ray = microtrace.trimesh.RayMeshIntersector(mesh)`.

`install()` makes this the engine of all meshes that are created afterwards.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .prepared import PreparedScene
from .scene import Scene

Array = npt.NDArray[Any]


class RayMeshIntersector:
    """A replacement for trimesh.ray.ray_triangle.RayMeshIntersector with exact results.

    The mesh's center is subtracted from vertices and ray origins in float64. Then they are rounded
    to float32, and so are directions. Hits are those of real arithmetic on these numbers, so rays
    never slip between triangles. Hits at a ray's origin don't count. If the mesh has changed, the
    next query prepares it again.
    """

    def __init__(self, mesh: Any, **_: Any) -> None:
        self.mesh = mesh
        self._key: Any = None
        self._prepared_scene: PreparedScene | None = None

    def intersects_id(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        multiple_hits: bool = True,
        max_hits: int | None = None,
        return_locations: bool = False,
        **_: Any,
    ) -> tuple[Array, ...]:
        """Returns the triangles that rays hit, ray by ray, nearest first.

        Args:
            ray_origins: (m, 3) real numbers.
            ray_directions: (m, 3) real numbers of any nonzero length.
            multiple_hits: False returns only the first hit of each ray.
            max_hits: maximum number of hits per ray; None means all hits.
            return_locations: also returns positions. Of several triangles that a ray hits at one
                point, such as those at an edge, returns only the first.

        Returns:
            index_tri (h,) int64, index_ray (h,) int64 and, if requested, locations (h, 3) float64.
        """
        rays = self._rays(ray_origins, ray_directions)
        prepared = self._prepared()
        if multiple_hits:
            found = prepared.intersect_all(rays)
            t, tri, ray = found.t, found.primitive, found.ray
            if return_locations:
                is_new = np.ones(len(t), bool)
                is_new[1:] = (ray[1:] != ray[:-1]) | (t[1:] != t[:-1])
                t, tri, ray = t[is_new], tri[is_new], ray[is_new]
            if max_hits is not None and len(ray):
                first = np.searchsorted(ray, ray)
                few = np.arange(len(ray)) - first < max_hits
                t, tri, ray = t[few], tri[few], ray[few]
        else:
            nearest = prepared.intersect(rays, fields=("t", "primitive"))
            ray = np.nonzero(nearest.primitive >= 0)[0]
            t, tri = nearest.t[ray], nearest.primitive[ray]
        index_tri, index_ray = tri.astype(np.int64), ray.astype(np.int64)
        if not return_locations:
            return index_tri, index_ray
        return index_tri, index_ray, self._locations(rays[index_ray], index_tri, t)

    def intersects_location(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        multiple_hits: bool = True,
        **_: Any,
    ) -> tuple[Array, Array, Array]:
        """Returns the points at which rays hit: locations (h, 3), index_ray (h,), index_tri
        (h,)."""
        tri, ray, locations = self.intersects_id(
            ray_origins, ray_directions, multiple_hits=multiple_hits, return_locations=True
        )
        return locations, ray, tri

    def intersects_first(
        self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, **_: Any
    ) -> Array:
        """Returns the first triangle that each ray hits, (m,) int64; -1 for misses."""
        rays = self._rays(ray_origins, ray_directions)
        hits = self._prepared().intersect(rays, fields=("primitive",))
        return hits.primitive.astype(np.int64)

    def intersects_any(
        self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, **_: Any
    ) -> npt.NDArray[np.bool_]:
        """Returns True for each ray that hits anything, (m,) bool."""
        return self._prepared().occluded(self._rays(ray_origins, ray_directions))

    def contains_points(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Returns True for points inside the mesh or on it, (n,) bool. Results for closed meshes
        are always correct."""
        array = np.asarray(points, np.float64)
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError("points must be (n,3)")
        prepared = self._prepared()
        return prepared._locate(array - self._center, None, 0) >= 0

    def __getstate__(self) -> Any:
        return {"mesh": self.mesh}

    def __setstate__(self, state: Any) -> None:
        RayMeshIntersector.__init__(self, state["mesh"])

    def __copy__(self) -> RayMeshIntersector:
        return RayMeshIntersector(self.mesh)

    def __deepcopy__(self, memo: Any) -> RayMeshIntersector:
        return RayMeshIntersector(self.mesh)

    def _prepared(self) -> PreparedScene:
        key = hash(self.mesh)
        if self._prepared_scene is None or key != self._key:
            vertices = np.asarray(self.mesh.vertices, np.float64).reshape(-1, 3)
            finite = vertices[np.isfinite(vertices).all(axis=1)]
            center = np.zeros(3) if len(finite) == 0 else (finite.min(0) + finite.max(0)) / 2
            self._center = center
            scene = Scene()
            scene.add_mesh(vertices - center, np.asarray(self.mesh.faces).reshape(-1, 3))
            self._prepared_scene = scene.prepare()
            self._key = key
        return self._prepared_scene

    def _rays(self, origins: npt.ArrayLike, directions: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Returns rays relative to the mesh's center. Scales directions so that their greatest
        component is 1."""
        self._prepared()
        o, d = np.asarray(origins, np.float64), np.asarray(directions, np.float64)
        if o.shape != d.shape or o.ndim != 2 or o.shape[1] != 3:
            raise ValueError(
                f"origins and directions must both have shape (m, 3), not {o.shape} and {d.shape}"
            )
        greatest = np.abs(d).max(axis=1, keepdims=True, initial=0)
        scaled = np.divide(d, greatest, out=np.zeros_like(d), where=greatest > 0)
        return np.concatenate([o - self._center, scaled], axis=1)

    def _locations(self, rays: Array, tri: Array, t: Array) -> npt.NDArray[np.float64]:
        """Computes hit points in float64 on the triangles' planes, or from t where a ray grazes a
        triangle."""
        corners = np.asarray(self.mesh.vertices, np.float64)[np.asarray(self.mesh.faces)[tri]]
        corners = corners - self._center
        o, d = rays[:, :3], rays[:, 3:]
        a = corners[:, 0]
        normals = np.cross(corners[:, 1] - a, corners[:, 2] - a)
        slopes, heights = (normals * d).sum(1), (normals * (a - o)).sum(1)
        with np.errstate(divide="ignore", invalid="ignore"):
            exact = heights / slopes
        rough = t.astype(np.float64)
        with np.errstate(invalid="ignore"):
            is_near = np.abs(exact - rough) <= 1e-5 * np.abs(rough)
        parameter = np.where(is_near, exact, rough)
        return np.asarray(o + parameter[:, None] * d + self._center)


def install() -> None:
    """Makes RayMeshIntersector the engine of all meshes that trimesh creates afterwards."""
    import trimesh.ray

    setattr(trimesh.ray.ray_triangle, "RayMeshIntersector", RayMeshIntersector)
    if getattr(trimesh.ray, "has_embree", False):
        setattr(trimesh.ray.ray_pyembree, "RayMeshIntersector", RayMeshIntersector)
