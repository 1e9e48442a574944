"""Ray queries on a prepared scene."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import as_numbers, as_threads, readable
from ._brief import Brief
from .errors import warn_caller

if TYPE_CHECKING:
    from .scene import Scene

Array = npt.NDArray[Any]
HitField = Literal[
    "t", "object", "primitive", "position", "normal", "face_normal", "barycentrics", "uv", "front"
]

#: Numbers per ray of each array of Hits; 0: no last axis.
_WIDTHS = {
    "t": 0,
    "object": 0,
    "primitive": 0,
    "position": 3,
    "normal": 3,
    "face_normal": 3,
    "barycentrics": 3,
    "uv": 2,
    "front": 0,
}
_TYPES: dict[str, Any] = {
    "object": np.int32,
    "primitive": np.int32,
    "front": np.bool_,
    "position": np.float64,
}


@dataclass(eq=False, repr=False)
class Hits(Brief):
    """Hits of rays, in arrays of the rays' leading shape. None: not asked for."""

    t: Array | None = None  #: float32, in multiples of the direction; infinite for misses
    object: Array | None = None  #: int32, index into Scene.objects; -1 for misses
    primitive: Array | None = None  #: int32, face of the mesh, else 0; -1 for misses
    position: Array | None = None  #: (..., 3) float64, world space; 0 for misses
    normal: Array | None = None  #: (..., 3) float32, shading normal of the front side; unit length
    face_normal: Array | None = None  #: (..., 3) float32, geometric normal of the front side
    barycentrics: Array | None = None  #: (..., 3) float32, weights of the triangle's corners
    uv: Array | None = None  #: (..., 2) float32, texture coordinates of set 0
    front: Array | None = None  #: bool, whether the ray arrives at the front side

    @property
    def hit(self) -> Array:
        """bool, whether the ray hits anything."""
        if self.object is not None:
            return np.asarray(self.object >= 0)
        if self.primitive is not None:
            return np.asarray(self.primitive >= 0)
        if self.t is None:
            raise ValueError("hit needs one of the fields t, object and primitive")
        return np.asarray(np.isfinite(self.t))


@dataclass(eq=False, repr=False)
class AllHits(Hits):
    """All hits of rays, one after the other. Those of ray i are [offsets[i] : offsets[i + 1]]."""

    offsets: Array = field(default_factory=lambda: np.zeros(1, np.int64))  #: int64, (rays + 1)
    ray: Array = field(default_factory=lambda: np.zeros(0, np.int64))  #: int64, the ray of each hit


@dataclass(eq=False, repr=False)
class ClosestPoints(Brief):
    """Nearest points of surfaces, in arrays of the points' leading shape."""

    position: Array  #: (..., 3) float64, world space; NaN if there is none
    distance: Array  #: float64; infinite if there is none
    object: Array  #: int32, index into Scene.objects; -1 if there is none
    primitive: Array  #: int32, face of the mesh
    barycentrics: Array  #: (..., 3) float64, weights of the triangle's corners
    sign: Array | None = None  #: int8: -1 inside, 0 on the surface, 1 outside

    @property
    def signed_distance(self) -> Array:
        """float64, negative inside."""
        if self.sign is None:
            raise ValueError("ask for it by closest_point(..., signed=True)")
        return np.asarray(np.where(self.sign < 0, -self.distance, self.distance))


class OpenMeshWarning(UserWarning):
    """Triangles don't enclose a solid, so that inside and outside depend on the ray."""


class PreparedScene:
    """A scene with its tree: immutable, and shared by any number of threads.

    Rays are arrays of shape (..., 6): origin and direction, world space. Directions have any
    nonzero length. float32 arrays are used as they are; float64 is rounded to float32, origins
    after Scene.origin is subtracted. Answers are those of real arithmetic on the float32 numbers
    of scene and rays. A ray with a number that is not finite hits nothing.
    """

    def __init__(
        self,
        scene: Scene,
        previous: PreparedScene | None = None,
        *,
        threads: int = 0,
        fast_build: bool = False,
    ) -> None:
        """See Scene.prepare()."""
        self._core: _core.Prepared = _core.Prepared(
            scene, None if previous is None else previous._core, as_threads(threads), fast_build
        )
        self._solids: dict[int | None, _core.Solid] = {}

    @property
    def scene(self) -> Scene:
        """A copy of the scene, as it was prepared. Its arrays are read-only and not copied."""
        from .scene import Scene

        return Scene(**self._core.scene())

    def __reduce__(self) -> Any:
        return (PreparedScene, (self.scene,))

    def intersect(
        self,
        rays: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        fields: Iterable[HitField] = (
            "t",
            "object",
            "primitive",
            "normal",
            "face_normal",
            "barycentrics",
            "uv",
        ),
        threads: int = 0,
    ) -> Hits:
        """The nearest hit of each ray; of several at the same t the lowest object and face.

        Args:
            rays: (..., 6) real numbers: origin and direction.
            t_min: least t that counts, broadcast to the leading shape; default: the least float32
                above 0.
            t_max: greatest t that counts, broadcast likewise; default: infinity.
            fields: the arrays to compute. Fewer are faster.
            threads: 0: all processors.

        Returns:
            Arrays of the leading shape; see Hits.

        Raises:
            ValueError: a wrong shape, or an unknown field.
            TypeError: not real numbers.
        """
        flat, shape, low, high = _rays(rays, t_min, t_max)
        outputs = _outputs(fields, len(flat))
        self._core.intersect(flat, low, high, outputs, as_threads(threads))
        return Hits(**{k: v.reshape(shape + v.shape[1:]) for k, v in outputs.items()})

    def occluded(
        self,
        rays: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int = 0,
    ) -> npt.NDArray[np.bool_]:
        """Whether each ray hits anything. Arguments as intersect(), but faster."""
        flat, shape, low, high = _rays(rays, t_min, t_max)
        result = np.empty(len(flat), np.bool_)
        self._core.occluded(flat, low, high, result, as_threads(threads))
        return result.reshape(shape)

    def intersect_all(
        self,
        rays: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        fields: Iterable[HitField] = ("t", "object", "primitive"),
        threads: int = 0,
    ) -> AllHits:
        """All hits of each ray in exact order: by t, then by object and face.

        Each primitive counts once: a ray through an edge hits both of its triangles, a ray through
        a sphere hits it once. Arguments as intersect(); the leading shape is flattened.
        """
        flat, _, low, high = _rays(rays, t_min, t_max)
        found = self._core.intersect_all(flat, low, high, as_threads(threads))
        outputs = _outputs(fields, len(found))
        offsets = np.empty(len(flat) + 1, np.int64)
        owners = np.empty(len(found), np.int64)
        self._core.fill_all(found, flat, outputs, offsets, owners, as_threads(threads))
        return AllHits(**outputs, offsets=offsets, ray=owners)

    def count_crossings(
        self,
        rays: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int = 0,
    ) -> npt.NDArray[np.uint32]:
        """The number of hits of each ray that intersect_all() finds. Arguments as intersect()."""
        flat, shape, low, high = _rays(rays, t_min, t_max)
        result = np.empty(len(flat), np.uint32)
        self._core.count_crossings(flat, low, high, result, as_threads(threads))
        return result.reshape(shape)

    def is_closed(self, object: int | None = None) -> bool:
        """Whether each edge belongs to an even number of triangles. Equal positions are one vertex.

        Args:
            object: index into Scene.objects; None: all triangles of the scene together.
        """
        return self._solid(object).is_closed()

    def open_edges(self, object: int | None = None) -> npt.NDArray[np.float64]:
        """The ends of edges that belong to an odd number of triangles, (n, 2, 3), world space."""
        return np.array(self._solid(object).open_edges(), np.float64).reshape(-1, 2, 3)

    def locate(
        self, points: npt.ArrayLike, *, object: int | None = None, threads: int = 0
    ) -> npt.NDArray[np.int8]:
        """Whether points are inside (1), on the surface (0) or outside (-1) of closed meshes.

        A point is inside if a ray from it crosses an odd number of triangles. The ray avoids all
        edges and vertices, decided exactly, so that the answer is never wrong for closed meshes.

        Args:
            points: (..., 3) real numbers, world space; float64 is rounded to float32. Points that
                are not finite are outside.
            object: index into Scene.objects; None: all triangles of the scene together.
            threads: 0: all processors.

        Warns:
            OpenMeshWarning: a mesh is not closed.
        """
        if not self._solid(object).is_closed():
            warn_caller(OpenMeshWarning("the triangles are not closed; see open_edges()"))
        return self._locate(points, object, threads)

    def _locate(
        self, points: npt.ArrayLike, object: int | None, threads: int
    ) -> npt.NDArray[np.int8]:
        flat, shape = _points(points)
        result = np.empty(len(flat), np.int8)
        self._solid(object).locate(flat, result, as_threads(threads))
        return result.reshape(shape)

    def contains(
        self, points: npt.ArrayLike, *, object: int | None = None, threads: int = 0
    ) -> npt.NDArray[np.bool_]:
        """Whether points are inside of closed meshes or on them. Arguments as locate()."""
        return np.asarray(self.locate(points, object=object, threads=threads) >= 0)

    def closest_point(
        self,
        points: npt.ArrayLike,
        *,
        signed: bool = False,
        object: int | None = None,
        threads: int = 0,
    ) -> ClosestPoints:
        """The nearest point of the triangles to each point; of several triangles the first.

        Args:
            points: (..., 3) real numbers, world space; float64 is rounded to float32.
            signed: whether to find the sign of the distance, as locate() does.
            object: index into Scene.objects; None: all triangles of the scene together.
            threads: 0: all processors.
        """
        flat, shape = _points(points)
        count = len(flat)
        position, barycentrics = np.empty((count, 3)), np.empty((count, 3))
        distance = np.empty(count)
        owner, face = np.empty(count, np.int32), np.empty(count, np.int32)
        solid = self._solid(object)
        solid.nearest(flat, position, distance, owner, face, barycentrics, as_threads(threads))
        sign: Array | None = None
        if signed:
            sign = -self.locate(flat, object=object, threads=threads).reshape(shape)
        return ClosestPoints(
            position.reshape(*shape, 3),
            distance.reshape(shape),
            owner.reshape(shape),
            face.reshape(shape),
            barycentrics.reshape(*shape, 3),
            sign,
        )

    def _solid(self, object: int | None) -> _core.Solid:
        if object not in self._solids:
            self._solids[object] = _core.Solid(self._core, object)
        return self._solids[object]


def _outputs(fields: Iterable[str], count: int) -> dict[str, Array]:
    result: dict[str, Array] = {}
    for name in fields:
        if name not in _WIDTHS:
            raise ValueError(f"unknown field {name!r}; use some of {', '.join(_WIDTHS)}")
        width = _WIDTHS[name]
        size = (count, width) if width else (count,)
        result[name] = np.empty(size, _TYPES.get(name, np.float32))
    return result


def _points(points: npt.ArrayLike) -> tuple[npt.NDArray[np.float32], tuple[int, ...]]:
    """Points as (n, 3) and their leading shape."""
    array = as_numbers(points, "points", 3)
    return np.ascontiguousarray(array, np.float32).reshape(-1, 3), array.shape[:-1]


def _rays(
    rays: npt.ArrayLike, t_min: npt.ArrayLike | None, t_max: npt.ArrayLike | None
) -> tuple[Array, tuple[int, ...], Array | None, Array | None]:
    """Rays as (n, 6), their leading shape, and the ends of their intervals."""
    array = as_numbers(rays, "rays", 6)
    shape = array.shape[:-1]
    flat = readable(array.reshape(-1, 6))

    def end(values: npt.ArrayLike | None, what: str) -> Array | None:
        if values is None:
            return None
        numbers = np.asarray(values)
        if numbers.dtype.kind not in "fiu":
            raise TypeError(f"{what} must contain real numbers, not {numbers.dtype}")
        return np.ascontiguousarray(np.broadcast_to(numbers, shape), np.float32).reshape(-1)

    return flat, shape, end(t_min, "t_min"), end(t_max, "t_max")
