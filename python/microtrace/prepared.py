"""Ray queries on a prepared scene."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import as_numbers, readable

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
_TYPES: dict[str, Any] = {"object": np.int32, "primitive": np.int32, "front": np.bool_}


@dataclass(eq=False)
class Hits:
    """Hits of rays, in arrays of the rays' leading shape. None: not asked for."""

    t: Array | None = None  #: float32, in multiples of the direction; infinite for misses
    object: Array | None = None  #: int32, index into Scene.objects; -1 for misses
    primitive: Array | None = None  #: int32, face of the mesh, else 0; -1 for misses
    position: Array | None = None  #: (..., 3) float32, world space; 0 for misses
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


HIT_FIELDS: tuple[str, ...] = tuple(f.name for f in fields(Hits))


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
        self._core = _core.Prepared(
            scene, None if previous is None else previous._core, threads, fast_build
        )

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
        wanted = list(fields)
        for name in wanted:
            if name not in _WIDTHS:
                raise ValueError(f"unknown field {name!r}; use some of {', '.join(_WIDTHS)}")
        flat, shape, low, high = _rays(rays, t_min, t_max)
        outputs: dict[str, Array] = {}
        for name in wanted:
            width = _WIDTHS[name]
            size = (len(flat), width) if width else (len(flat),)
            outputs[name] = np.empty(size, _TYPES.get(name, np.float32))
        self._core.intersect(flat, low, high, outputs, threads)
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
        self._core.occluded(flat, low, high, result, threads)
        return result.reshape(shape)


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
