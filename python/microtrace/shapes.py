"""Shapes, relative to Scene.origin. Numbers are rounded once to float32."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ._brief import Brief, Vector
from .materials import Material

FloatArray = npt.NDArray[np.floating[Any]]


@dataclass(eq=False, repr=False)
class Mesh(Brief):
    """Indexed triangles. Arrays are not read until the scene is prepared."""

    #: (V, 3), relative to Scene.origin, or in the mesh's own space if Object.placement is set.
    vertices: npt.ArrayLike
    faces: npt.ArrayLike  #: (F, 3) integers, counterclockwise as seen from the front
    normals: npt.ArrayLike | None = None  #: (V, 3), unit length or zero; None for flat shading
    #: (V, 4): unit tangent, and handedness 1 or -1. Default: prepare() generates them if the
    #: material has a normal map or anisotropy, and the mesh has its texture coordinates.
    tangents: npt.ArrayLike | None = None
    uv: Sequence[npt.ArrayLike] = ()  #: sets of (V, 2); (0, 0) is the upper left corner of an image
    #: (V, 4), linear Rec. 709 and alpha, in [0, 1]. Scene.add_mesh also takes 8-bit sRGB integers.
    colors: npt.ArrayLike | None = None
    #: (S, 2) integers; lines that are rendered one pixel wide.
    segments: npt.ArrayLike | None = None


@dataclass(eq=False, repr=False)
class Sphere(Brief):
    """The sphere with this center and radius. Its front is the outside."""

    center: Vector = (0.0, 0.0, 0.0)
    radius: float = 1.0


@dataclass(eq=False, repr=False)
class Plane(Brief):
    """The infinite plane through `point`. Its front is the side to which the normal points."""

    point: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 1.0, 0.0)  #: any length


@dataclass(eq=False, repr=False)
class Disc(Brief):
    """The part of a plane within `radius` of `center`. Its front is the side to which the normal
    points."""

    center: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 1.0, 0.0)  #: any length
    radius: float = 1.0


@dataclass(eq=False, repr=False)
class Triangle(Brief):
    """A single triangle. From its front, a, b and c are counterclockwise."""

    a: Vector
    b: Vector
    c: Vector


@dataclass(eq=False, repr=False)
class Quadric(Brief):
    """The surface a x^2 + b y^2 + c z^2 + d xy + e xz + f yz + g x + h y + i z + j = 0. Its front
    is the side where the polynomial is positive, so the inside of a body is negative.

    Every ray is tested against each quadric that isn't an ellipsoid, because it may be infinite.
    """

    coefficients: Sequence[float] = field(default=(0.0,) * 10)  #: a to j


Shape = Mesh | Sphere | Plane | Disc | Triangle | Quadric


@dataclass(eq=False, repr=False)
class Object(Brief):
    """A shape with one material.

    Objects may have the same Mesh and different placements. The mesh and its tree are then stored
    once, and all results have the bits of those with transformed copies. load() returns such
    objects for files that would have more than 2^20 triangles otherwise.
    """

    shape: Shape
    material: Material | None = None  #: None means Material()
    name: str = ""
    #: For meshes only: (3, 4) or (4, 4), an affine transform of the vertices to positions relative
    #: to Scene.origin.
    placement: npt.ArrayLike | None = None
