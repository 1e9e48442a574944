"""Exact ray queries for trimesh: `mesh.ray = microtrace.trimesh.RayMeshIntersector(mesh)`.

`install()` makes this the engine of all meshes that are created afterwards.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import MOST, as_float32, as_integer, as_reals
from .prepared import PreparedScene
from .scene import Scene

Array = npt.NDArray[Any]

#: Sums of turns around rays that differ less are equal.
_ANGLE_ERROR = 1e-6


class RayMeshIntersector:
    """A replacement for trimesh.ray.ray_triangle.RayMeshIntersector with exact results.

    The center of the mesh's bounds is subtracted from vertices and ray origins in float64. Then
    they are rounded to float32, and so are directions, which powers of two scale exactly. Hits are
    those of real arithmetic on these numbers, so rays never slip between triangles. As in trimesh,
    hits at a ray's origin count, and triangles in whose plane the ray lies are not hit; rays still
    hit their neighbors at the common edges. Of the triangles at a vertex or edge where a ray enters
    or leaves a closed mesh, only one counts; where it only touches the mesh, two count, one of each
    side. Hits at different points count, however close they are. If the mesh has changed, the next
    query prepares it again.
    """

    def __init__(self, mesh: Any, **_: Any) -> None:
        self.mesh = mesh
        self._key: Any = None
        self._prepared_scene: PreparedScene | None = None

    def intersects_id(
        self,
        ray_origins: npt.ArrayLike,
        ray_directions: npt.ArrayLike,
        return_locations: bool = False,
        multiple_hits: bool = True,
        max_hits: int | None = None,
        **_: Any,
    ) -> tuple[Array, ...]:
        """Returns the triangles that rays hit, ray by ray, nearest first.

        Args:
            ray_origins: (m, 3) real numbers.
            ray_directions: (m, 3) real numbers of any nonzero length.
            return_locations: also returns positions.
            multiple_hits: False returns only the first hit of each ray.
            max_hits: maximum number of hits per ray; None means all hits.

        Returns:
            index_tri (h,) int64, index_ray (h,) int64 and, if requested, locations (h, 3) float64.
        """
        if isinstance(max_hits, (bool, np.bool_)) or not isinstance(
            multiple_hits, (bool, np.bool_)
        ):
            # The engine for Embree has other parameters in these places.
            raise TypeError(
                "the order of the arguments is that of trimesh.ray.ray_triangle: return_locations, "
                "multiple_hits, max_hits; pass them by name"
            )
        rays = self._rays(ray_origins, ray_directions)
        most = None if max_hits is None else as_integer(max_hits, "max_hits", 0, MOST)
        t, tri, ray = self._all(rays) if multiple_hits else self._nearest(rays)
        if multiple_hits and most is not None and len(ray):
            few: Array = np.arange(len(ray)) - np.searchsorted(ray, ray) < most
            t, tri, ray = t[few], tri[few], ray[few]
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
        tri, ray = self._nearest(rays)[1:]
        first = np.full(len(rays), -1, np.int64)
        first[ray] = tri
        return first

    def intersects_any(
        self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, **_: Any
    ) -> npt.NDArray[np.bool_]:
        """Returns True for each ray that hits anything, (m,) bool."""
        return self.intersects_first(ray_origins, ray_directions) >= 0

    def contains_points(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Returns True for points inside the mesh or on it, (n,) bool. Results for closed meshes
        are always correct."""
        array = as_reals(points, "points").astype(np.float64)
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
        return self.__copy__()

    def _prepared(self) -> PreparedScene:
        key = hash(self.mesh)
        if self._prepared_scene is None or key != self._key:
            vertices = np.asarray(self.mesh.vertices, np.float64).reshape(-1, 3)
            faces = np.asarray(self.mesh.faces).reshape(-1, 3)
            # Vertices that no face uses may be anywhere.
            is_used = np.isin(np.arange(len(vertices)), faces)
            finite = vertices[is_used & np.isfinite(vertices).all(axis=1)]
            center = np.zeros(3) if len(finite) == 0 else (finite.min(0) + finite.max(0)) / 2
            self._center = center
            with np.errstate(over="ignore"):
                moved = np.where(is_used[:, None], vertices - center, 0)
            self._vertices = as_float32(moved)
            scene = Scene()
            scene.add_mesh(self._vertices, faces)
            self._prepared_scene = scene.prepare()
            self._key = key
        return self._prepared_scene

    def _all(self, rays: Array) -> tuple[Array, Array, Array]:
        """Returns t, triangles and rays of all hits."""
        found, ties = self._prepared()._intersect_all(
            rays, 0, None, ("t", "primitive"), 0, finds_ties=True
        )
        facing = self._facing(rays[found.ray], found.primitive)
        counts = facing != 0
        t, tri, ray = found.t[counts], found.primitive[counts], found.ray[counts]
        # The hits of a ray at one point have the same place.
        place = np.cumsum(~ties)[counts]
        is_new = np.ones(len(t), bool)
        is_tie = place[1:] == place[:-1]
        at = np.nonzero(np.append(is_tie, False) | np.insert(is_tie, 0, False))[0]
        if len(at) > 0:
            corners = self._vertices[np.asarray(self.mesh.faces)[tri[at]]]
            is_new[at] = _counts_at_point(place[at], facing[counts][at], corners, rays[ray[at]])
        return t[is_new], tri[is_new], ray[is_new]

    def _nearest(self, rays: Array) -> tuple[Array, Array, Array]:
        """Returns t, triangles and rays of the nearest hits."""
        hits = self._prepared().intersect(rays, t_min=0, fields=("t", "primitive"))
        ray = np.nonzero(hits.primitive >= 0)[0]
        t, tri = hits.t[ray], hits.primitive[ray]
        edge_on = self._facing(rays[ray], tri) == 0
        if not edge_on.any():
            return t, tri, ray
        asked = ray[edge_on]
        more_t, more_tri, of = self._all(rays[asked])
        of, first = np.unique(of, return_index=True)
        ray = np.concatenate([ray[~edge_on], asked[of]])
        order = np.argsort(ray)
        t = np.concatenate([t[~edge_on], more_t[first]])
        tri = np.concatenate([tri[~edge_on], more_tri[first]])
        return t[order], tri[order], ray[order]

    def _facing(self, rays: Array, tri: npt.NDArray[np.int32]) -> npt.NDArray[np.int8]:
        """Returns the sign of the normal of each ray's triangle along the ray; 0 for triangles that
        are exactly parallel to the ray."""
        facing = np.empty(len(tri), np.int8)
        self._prepared()._core.find_facing(rays, tri, facing, 0)
        return facing

    def _rays(self, origins: npt.ArrayLike, directions: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """Returns rays relative to the mesh's center. Scales directions by powers of two, so that
        their greatest component is in [1, 2)."""
        self._prepared()
        o = as_reals(origins, "ray_origins").astype(np.float64)
        d = as_reals(directions, "ray_directions").astype(np.float64)
        if o.shape != d.shape or o.ndim != 2 or o.shape[1] != 3:
            raise ValueError(
                f"origins and directions must both have shape (m, 3), not {o.shape} and {d.shape}"
            )
        exponents = np.frexp(np.abs(d).max(axis=1, keepdims=True, initial=0))[1]
        return np.concatenate([o - self._center, np.ldexp(d, 1 - exponents)], axis=1)

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


def _counts_at_point(group: Array, facing: Array, corners: Array, rays: Array) -> Array:
    """Returns which hits of rays at the same point count.

    All hits inside of triangles do. Those at edges and vertices count as often as the surface goes
    around the ray there. A ray that enters or leaves a closed mesh hits one triangle, and a ray
    that only touches it two, one of each side.

    Args:
        group: (n,) ascending integers, equal for hits of the same ray at the same point.
        facing: (n,) nonzero, its sign tells at which side the ray arrives.
        corners: (n, 3, 3), of the triangles.
        rays: (n, 6).
    """
    turns = _turns(corners, rays)
    starts = np.insert(np.diff(group) != 0, 0, True)
    of = np.cumsum(starts) - 1
    is_part = turns < 1
    parts = np.where(is_part, turns, 0)
    # The turns around the ray of triangles of one side and of the other.
    around = [np.bincount(of, np.where(facing * side > 0, parts, 0)) for side in (1, -1)]
    net = around[0] - around[1]
    # Around the boundary of an open mesh, the turns are no integer.
    is_whole = np.abs(net - np.round(net)) < _ANGLE_ERROR
    touches = is_whole & (np.round(net) == 0)
    result = ~is_part
    for side, turn in zip((1, -1), around):
        most = np.where(
            is_whole, np.maximum(np.round(side * net), touches), np.ceil(turn - _ANGLE_ERROR)
        )
        mine = is_part & (facing * side > 0)
        earlier: Array = np.cumsum(mine) - mine
        result |= mine & (earlier - earlier[starts][of] < most[of])
    return result


def _turns(corners: Array, rays: Array) -> Array:
    """Returns the parts of a turn around each ray that its triangle, which it hits, takes: 1 inside
    of the triangle, 1/2 at an edge. Edges and vertices are found by float64 numbers."""
    o, d = as_float32(rays).astype(np.float64).reshape(-1, 2, 3).transpose(1, 0, 2)
    to = corners - o[:, None]

    def products(a: Array, b: Array) -> tuple[Array, Array]:
        """Returns the products of whose differences the components of a x b consist."""
        return np.roll(a, -1, 1) * np.roll(b, -2, 1), np.roll(a, -2, 1) * np.roll(b, -1, 1)

    turns = np.ones(len(rays))
    for i in range(3):
        left, right = products(to[:, i], to[:, (i + 1) % 3])
        volume = ((left - right) * d).sum(axis=1)
        size = ((np.abs(left) + np.abs(right)) * np.abs(d)).sum(axis=1)
        turns[np.abs(volume) <= 1e-14 * size] = 0.5
    for i in range(3):
        left, right = products(to[:, i], d)
        meets = (np.abs(left - right) <= 1e-14 * (np.abs(left) + np.abs(right))).all(axis=1)
        # The angle between the triangle's sides, seen along the ray.
        a, b = (
            np.cross(d, corners[:, (i + k) % 3] - corners[:, i]).astype(np.float64) for k in (1, 2)
        )
        sine, cosine = np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)
        turns[meets] = (np.arctan2(sine, cosine) / (2 * np.pi))[meets]
    return turns


def install() -> None:
    """Makes RayMeshIntersector the engine of all meshes that trimesh creates afterwards."""
    import trimesh.ray

    setattr(trimesh.ray.ray_triangle, "RayMeshIntersector", RayMeshIntersector)
    if getattr(trimesh.ray, "has_embree", False):
        setattr(trimesh.ray.ray_pyembree, "RayMeshIntersector", RayMeshIntersector)
