"""Results of ray queries."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from ._arrays import as_names
from ._brief import text

Array = npt.NDArray[Any]
HitField = Literal[
    "t", "object", "primitive", "position", "normal", "face_normal", "barycentrics", "uv", "front"
]

#: The type of each array of Hits, and the length of its last axis; 0 for arrays without this axis.
_LAYOUTS: dict[str, tuple[type[np.generic], int]] = {
    "t": (np.float32, 0),
    "object": (np.int32, 0),
    "primitive": (np.int32, 0),
    "position": (np.float64, 3),
    "normal": (np.float32, 3),
    "face_normal": (np.float32, 3),
    "barycentrics": (np.float32, 3),
    "uv": (np.float32, 2),
    "front": (np.bool_, 0),
}


class _Arrays:
    """Arrays as attributes. Those that were not requested don't exist."""

    _requests: dict[str, str] = {}  # how to request each array

    def __init__(self, **arrays: Array) -> None:
        vars(self).update(arrays)

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={text(array)}" for name, array in vars(self).items())
        return f"{type(self).__name__}({shown})"

    if not TYPE_CHECKING:  # type checkers know the annotated names only

        def __getattr__(self, name: str) -> Any:
            if name in self._requests:
                raise AttributeError(f"{name!r} was not requested; {self._requests[name]}")
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")


class Hits(_Arrays):
    """Hits of rays, in arrays of the rays' leading shape. Access to an array that was not requested
    raises AttributeError."""

    _requests = {name: f"add {name!r} to fields" for name in _LAYOUTS} | {
        "hit": "it needs one of the fields object, primitive and t"
    }

    t: npt.NDArray[np.float32]  #: in multiples of the direction's length; infinite for misses
    object: npt.NDArray[np.int32]  #: index into Scene.objects; -1 for misses
    primitive: npt.NDArray[np.int32]  #: index of the mesh's face, or 0; -1 for misses
    position: npt.NDArray[np.float64]  #: (..., 3), world space; 0 for misses
    normal: npt.NDArray[np.float32]  #: (..., 3), unit shading normal of the front
    face_normal: npt.NDArray[np.float32]  #: (..., 3), unit geometric normal of the front
    barycentrics: npt.NDArray[np.float32]  #: (..., 3), weights of the triangle's corners
    uv: npt.NDArray[np.float32]  #: (..., 2), texture coordinates of set 0
    front: npt.NDArray[np.bool_]  #: True if the ray arrives at the front side

    @property
    def hit(self) -> npt.NDArray[np.bool_]:
        """A bool array; True for each ray that hits anything.

        Needs one of the fields object, primitive and t. With t alone, a hit whose t is greater than
        float32 numbers looks like a miss.
        """
        arrays = vars(self)
        if "object" in arrays:
            return np.asarray(self.object >= 0)
        if "primitive" in arrays:
            return np.asarray(self.primitive >= 0)
        return np.asarray(np.isfinite(self.t))


class AllHits(Hits):
    """All hits of rays, ray by ray.

    The hits of ray i are in the slice [offsets[i] : offsets[i + 1]] of each array.
    """

    offsets: npt.NDArray[np.int64]  #: (number of rays + 1)
    ray: npt.NDArray[np.int64]  #: index of each hit's ray


class ClosestPoints(_Arrays):
    """Nearest points on surfaces, in arrays of the query points' leading shape."""

    _requests = dict.fromkeys(
        ("sign", "signed_distance"), "ask for it by closest_point(..., signed=True)"
    )

    position: npt.NDArray[np.float64]  #: (..., 3), world space; NaN if there is none
    distance: npt.NDArray[np.float64]  #: infinite if there is none
    object: npt.NDArray[np.int32]  #: index into Scene.objects; -1 if there is none
    primitive: npt.NDArray[np.int32]  #: index of the mesh's face
    barycentrics: npt.NDArray[np.float64]  #: (..., 3), weights of the triangle's corners
    sign: npt.NDArray[np.int8]  #: -1 inside, 0 on the surface, 1 outside; only if signed

    @property
    def signed_distance(self) -> npt.NDArray[np.float64]:
        """The distance, negative inside; only if signed."""
        return np.asarray(np.where(self.sign < 0, -self.distance, self.distance))


def output_arrays(fields: Iterable[str], count: int) -> dict[str, Array]:
    """Returns uninitialized arrays for these fields of `count` hits."""
    result: dict[str, Array] = {}
    for name in as_names(fields, "fields"):
        if name not in _LAYOUTS:
            raise ValueError(f"unknown field {name!r} in fields; use {', '.join(_LAYOUTS)}")
        kind, width = _LAYOUTS[name]
        result[name] = np.empty((count, width) if width else (count,), kind)
    return result
