"""Ray queries on a prepared scene."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import (
    MOST,
    as_float32_toward,
    as_instance,
    as_integer,
    as_numbers,
    as_reals,
    as_text,
    as_threads,
    readable,
)
from .errors import warn_caller
from .hits import AllHits, ClosestPoints, HitField, Hits, output_arrays
from .viewer import View, words_of

if TYPE_CHECKING:
    from .scene import Scene

Array = npt.NDArray[Any]


class OpenMeshWarning(UserWarning):
    """Triangles don't enclose a solid, so whether a point is inside depends on the test ray."""


class PreparedScene:
    """A scene with its bounding volume hierarchy. Immutable; any number of threads may use it.

    Rays are arrays of shape (..., 6): origin and direction in world space. Directions may have any
    length from about 1e-45 to 3e38, the range of float32. Scene.origin is subtracted from origins
    in float64, and the results are rounded to float32. float32 rays remain unchanged if
    Scene.origin is zero. Results are those of real arithmetic on the float32 numbers of scene and
    rays. A ray that contains a number that is not finite in float32, or whose direction is zero
    there, hits nothing.

    Queries find all surfaces. Materials have no effect on them: the backs of one-sided surfaces and
    transparent parts, which pictures and their AOVs leave out, are hit too.
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
        from .scene import Scene

        as_instance(scene, "scene", Scene)
        if previous is not None:
            as_instance(previous, "previous", PreparedScene)
        self._core: _core.Prepared = _core.Prepared(
            scene,
            None if previous is None else previous._core,
            as_threads(threads),
            bool(fast_build),
        )
        self._solids: dict[int | None, _core.Solid] = {}

    @property
    def scene(self) -> Scene:
        """A copy of the scene as it was prepared. Its arrays are read-only views."""
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
        """Returns the nearest hit of each ray. Of several hits at the same t, returns the one with
        the lowest object index, then the lowest face index.

        Args:
            rays: (..., 6) real numbers: origin and direction.
            t_min: least t of hits, at least 0, broadcast to the leading shape. Rounded up to
                float32. Default: the least float32 above 0.
            t_max: greatest t of hits, broadcast to the leading shape. Rounded down to float32.
                Default: infinity.
            fields: the arrays to compute. Computing fewer arrays is faster.
            threads: number of threads; 0 means all processors.

        Returns:
            Arrays of the leading shape; see Hits.

        Raises:
            ValueError: an array has a wrong shape, a t_min is negative, or a field is unknown.
            TypeError: an array contains anything but real numbers.
        """
        flat, shape, low, high = _rays(rays, t_min, t_max)
        outputs = output_arrays(fields, len(flat))
        self._core.intersect(flat, low, high, outputs, as_threads(threads))
        return Hits(**{k: v.reshape(shape + v.shape[1:]) for k, v in outputs.items()})

    def explain(
        self,
        ray: npt.ArrayLike,
        *,
        t_min: float | None = None,
        t_max: float | None = None,
        max_hits: int = 1000,
        max_misses: int = 64,
    ) -> dict[str, Any]:
        """Explains what a single ray meets: all hits in exact order, the numbers that decide each
        of them, the stage that decided, and why a hit is visible or not.

        Returns the JSON of `microtrace explain --json` as a dict; docs/explain.md describes the
        members. Infinite numbers are the strings "Infinity" and "-Infinity", which float()
        converts. "pixel" and "depth" are None.

        Args:
            ray: six real numbers: origin and direction.
            t_min: least t of hits. Default: the least float32 above 0.
            t_max: greatest t of hits. Default: infinity.
            max_hits: maximum number of hits, and of crossings before and after them.
            max_misses: misses are explained in scenes of at most this many primitives.
        """
        flat, shape, low, high = _rays(ray, t_min, t_max)
        if shape != ():
            raise ValueError(f"explain() takes one ray of shape (6,), not {(*shape, 6)}")
        hits = as_integer(max_hits, "max_hits", 0, MOST)
        misses = as_integer(max_misses, "max_misses", 0, MOST)
        explanation: dict[str, Any] = json.loads(self._core.explain(flat, low, high, hits, misses))
        return explanation

    def view(
        self,
        options: str | Sequence[str] = "",
        *,
        height: int = 700,
        port: int = 0,
        name: str = "scene",
        allow_host: str = "",
    ) -> View:
        """Serves a page that shows the scene, as `microtrace view` does; docs/view.md describes it.

        Notebooks show the page if this is the last expression of a cell. Elsewhere, call
        View.open(), or open View.url.

        Args:
            options: options of `microtrace view` with which the page starts, such as
                "--spp 256 --view front"; either a text or a list of words.
            height: height of the page in notebooks, in CSS pixels.
            port: port of 127.0.0.1; 0 means any free port.
            name: name of the scene on the page.
            allow_host: a host name that addresses may have besides localhost and 127.0.0.1, for a
                proxy in front of the page; with the port, as in hub.example.org:8443, if the
                address has one.

        Raises:
            UsageError: an option is unknown or has a wrong value.
            FileError: the port is in use.
            UnsupportedError: the module microtrace_http is not installed.
            ValueError: the port is not in [0, 65535].
        """
        return View(
            self._core,
            as_text(name, "name"),
            words_of(options),
            as_integer(port, "port", 0, 65535),
            as_text(allow_host, "allow_host"),
            as_integer(height, "height", 1, MOST),
        )

    def occluded(
        self,
        rays: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int = 0,
    ) -> npt.NDArray[np.bool_]:
        """Returns True for each ray that hits anything. Takes the arguments of intersect(), and is
        faster than it with its default fields."""
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
        """Returns all hits of each ray in exact order: by t, then by object and face.

        Each primitive counts once per ray. A ray through an edge hits both of the edge's triangles,
        and a ray through a sphere hits the sphere once. Takes the arguments of intersect(). The
        leading shape is flattened.
        """
        return self._intersect_all(rays, t_min, t_max, fields, threads)[0]

    def _intersect_all(
        self,
        rays: npt.ArrayLike,
        t_min: npt.ArrayLike | None,
        t_max: npt.ArrayLike | None,
        fields: Iterable[HitField],
        threads: int,
        *,
        finds_ties: bool = False,
    ) -> tuple[AllHits, npt.NDArray[np.bool_]]:
        """Returns the hits of intersect_all() and, with finds_ties, True for each hit whose exact t
        equals that of the ray's previous hit."""
        flat, _, low, high = _rays(rays, t_min, t_max)
        found = self._core.intersect_all(flat, low, high, as_threads(threads))
        outputs = output_arrays(fields, len(found))
        offsets = np.empty(len(flat) + 1, np.int64)
        owners = np.empty(len(found), np.int64)
        ties = np.empty(len(found) if finds_ties else 0, np.bool_)
        self._core.fill_all(
            found, flat, low, high, outputs, offsets, owners, ties, as_threads(threads)
        )
        return AllHits(**outputs, offsets=offsets, ray=owners), ties

    def count_crossings(
        self,
        rays: npt.ArrayLike,
        *,
        t_min: npt.ArrayLike | None = None,
        t_max: npt.ArrayLike | None = None,
        threads: int = 0,
    ) -> npt.NDArray[np.uint32]:
        """Returns the number of hits that intersect_all() would find for each ray. Takes the
        arguments of intersect()."""
        flat, shape, low, high = _rays(rays, t_min, t_max)
        result = np.empty(len(flat), np.uint32)
        self._core.count_crossings(flat, low, high, result, as_threads(threads))
        return result.reshape(shape)

    def is_closed(self, object: int | None = None) -> bool:
        """Returns True if each edge belongs to an even number of triangles. Vertices with equal
        positions are merged.

        Args:
            object: index into Scene.objects; None means all triangles of the scene together.
        """
        return self._solid(object).is_closed()

    def open_edges(self, object: int | None = None) -> npt.NDArray[np.float64]:
        """Returns the ends of edges that belong to an odd number of triangles, (n, 2, 3) float64,
        in world space."""
        return self._solid(object).open_edges().copy()

    def locate(
        self, points: npt.ArrayLike, *, object: int | None = None, threads: int = 0
    ) -> npt.NDArray[np.int8]:
        """Returns 1 for points inside closed meshes, 0 for points on them, and -1 for points
        outside.

        Only triangles count, so points within spheres and other shapes are outside. A point is
        inside if a ray from it crosses an odd number of triangles. The ray is chosen by exact tests
        to avoid all edges and vertices, so results for closed meshes are always correct.

        Args:
            points: (..., 3) real numbers, world space. Scene.origin is subtracted in float64, and
                the results are rounded to float32. Points with coordinates that are not finite are
                outside.
            object: index into Scene.objects; None means all triangles of the scene together.
            threads: number of threads; 0 means all processors.

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
        """Returns True for points inside closed meshes or on them. Takes the arguments of
        locate()."""
        return np.asarray(self.locate(points, object=object, threads=threads) >= 0)

    def closest_point(
        self,
        points: npt.ArrayLike,
        *,
        signed: bool = False,
        object: int | None = None,
        threads: int = 0,
    ) -> ClosestPoints:
        """Returns the point on the triangles that is nearest to each query point. Of several
        nearest triangles, the first counts.

        Args:
            points: (..., 3) real numbers, world space, treated as those of locate().
            signed: also computes the sign of the distance, as locate() does.
            object: index into Scene.objects; None means all triangles of the scene together.
            threads: number of threads; 0 means all processors.
        """
        flat, shape = _points(points)
        count = len(flat)
        position, barycentrics = np.empty((count, 3)), np.empty((count, 3))
        distance = np.empty(count)
        owner, face = np.empty(count, np.int32), np.empty(count, np.int32)
        solid = self._solid(object)
        solid.nearest(flat, position, distance, owner, face, barycentrics, as_threads(threads))
        result = ClosestPoints(
            position=position.reshape(*shape, 3),
            distance=distance.reshape(shape),
            object=owner.reshape(shape),
            primitive=face.reshape(shape),
            barycentrics=barycentrics.reshape(*shape, 3),
        )
        if signed:
            sides = self.locate(flat, object=object, threads=threads).reshape(shape)
            result.sign = np.asarray(-sides)  # not a scalar, also for a single point
        return result

    def _solid(self, object: int | None) -> _core.Solid:
        index = None if object is None else as_integer(object, "object", -MOST, MOST)
        if index not in self._solids:
            self._solids[index] = _core.Solid(self._core, index)
        return self._solids[index]


def _points(points: npt.ArrayLike) -> tuple[npt.NDArray[np.float64], tuple[int, ...]]:
    """Returns points as (n, 3), and their leading shape."""
    array = as_numbers(points, "points", 3)
    return np.ascontiguousarray(array, np.float64).reshape(-1, 3), array.shape[:-1]


def _rays(
    rays: npt.ArrayLike, t_min: npt.ArrayLike | None, t_max: npt.ArrayLike | None
) -> tuple[Array, tuple[int, ...], Array | None, Array | None]:
    """Returns rays as (n, 6), their leading shape, and the ends of their intervals."""
    array = as_numbers(rays, "rays", 6)
    shape = array.shape[:-1]
    flat = readable(array.reshape(-1, 6))

    def end(values: npt.ArrayLike | None, what: str, limit: float) -> Array | None:
        if values is None:
            return None
        numbers = as_reals(values, what)
        try:
            each = np.broadcast_to(numbers, shape)
        except ValueError:
            raise ValueError(f"{what} must broadcast to {shape}, not {numbers.shape}") from None
        return as_float32_toward(each, limit).reshape(-1)

    low, high = end(t_min, "t_min", inf), end(t_max, "t_max", -inf)
    if low is not None and (low < 0).any():
        raise ValueError(f"t_min must not be negative, is {low.min()}")
    return flat, shape, low, high
