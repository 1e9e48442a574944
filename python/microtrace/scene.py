"""Scenes: plain data that can be edited, pickled and prepared."""

from __future__ import annotations

import copy
import math
import operator
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from os import PathLike
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _core
from ._arrays import (
    as_array,
    as_float,
    as_indices,
    as_numbers,
    as_path,
    as_reals,
    as_rows,
    as_text,
)
from ._brief import Brief, Vector
from .cameras import Camera
from .errors import warn
from .lights import Environment, Light
from .materials import Material
from .prepared import PreparedScene
from .shapes import Disc, Mesh, Object, Plane, Quadric, Sphere
from .viewer import View


@dataclass(eq=False, repr=False)
class Scene(Brief):
    """Shapes, materials, lights and cameras.

    Everything is plain data. Change it as you like, then call prepare(). Arrays of files' meshes
    and images are read-only; replace them, or change a copy by copy.deepcopy(). Coordinates of
    shapes, lights and cameras are relative to `origin`, which is (0, 0, 0) unless a file's geometry
    is far from zero. Rays and points of queries are in world space.
    """

    objects: list[Object] = field(default_factory=list)
    #: In the order of the pictures' material ids. Materials that objects use but that are not in
    #: this list are appended.
    materials: list[Material] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    cameras: list[Camera] = field(default_factory=list)
    environment: Environment | None = None  #: None: the built-in studio if there are no lights
    background: Vector | None = None  #: linear Rec. 709; None: 0.25 gray if path traced, else black
    size: tuple[int, int] = (640, 480)  #: width and height of pictures, pixels
    origin: Vector = (0.0, 0.0, 0.0)  #: world-space position of the scene's (0, 0, 0)
    epsilon: float = 0.0  #: camera rays ignore hits up to this t
    #: The default integrator for pictures; "flat" for scenes from JSON files.
    integrator: Literal["path", "flat"] = "path"

    def add_mesh(
        self,
        vertices: npt.ArrayLike,
        faces: npt.ArrayLike,
        normals: npt.ArrayLike | None = None,
        uv: npt.ArrayLike | None = None,
        colors: npt.ArrayLike | None = None,
        material: Material | None = None,
        transform: npt.ArrayLike | None = None,
        name: str = "",
    ) -> Object:
        """Adds triangles and returns their object.

        Args:
            vertices: (V, 3) real numbers. Stored as float32; float64 is rounded once.
            faces: (F, 3) integers in [0, V), counterclockwise as seen from the front.
            normals: (V, 3) numbers, unit length.
            uv: (V, 2) numbers. (0, 0) is the upper left corner of a texture's image, and v points
                down.
            colors: (V, 3) or (V, 4), either linear Rec. 709 numbers in [0, 1] or sRGB integers of
                the type uint8.
            material: default: Material().
            transform: (4, 4) matrix from the mesh's space to that of the scene, relative to origin,
                applied in float64 with results rounded once. If it mirrors the mesh, the winding is
                reversed, so front faces stay front faces.
            name: any text.

        Raises:
            ValueError: an array has a wrong shape, an index is negative, or a color is not in
                [0, 1].
            TypeError: an array has a wrong type of numbers.
        """
        mesh = Mesh(
            vertices=as_rows(vertices, "vertices", 3),
            faces=as_indices(faces, "faces", 3),
            normals=None if normals is None else as_rows(normals, "normals", 3),
            uv=() if uv is None else (as_rows(uv, "uv", 2),),
            colors=None if colors is None else linear_colors(colors),
        )
        if transform is not None:
            _transform(mesh, as_reals(transform, "transform"))
        return self._add(mesh, material, name)

    def add_sphere(
        self,
        center: Vector = (0.0, 0.0, 0.0),
        radius: float = 1.0,
        material: Material | None = None,
        name: str = "",
    ) -> Object:
        """Adds a sphere and returns its object."""
        return self._add(Sphere(center, radius), material, name)

    def add_plane(
        self, point: Vector, normal: Vector, material: Material | None = None, name: str = ""
    ) -> Object:
        """Adds an infinite plane and returns its object."""
        return self._add(Plane(point, normal), material, name)

    def add_disc(
        self,
        center: Vector,
        normal: Vector,
        radius: float,
        material: Material | None = None,
        name: str = "",
    ) -> Object:
        """Adds a disc and returns its object."""
        return self._add(Disc(center, normal, radius), material, name)

    def add_quadric(
        self, coefficients: Sequence[float], material: Material | None = None, name: str = ""
    ) -> Object:
        """Adds a quadric by its ten coefficients (see Quadric) and returns its object."""
        return self._add(Quadric(coefficients), material, name)

    def prepare(
        self,
        previous: PreparedScene | None = None,
        *,
        threads: int = 0,
        fast_build: bool = False,
    ) -> PreparedScene:
        """Builds the data structures that ray queries and pictures need.

        Args:
            previous: the same scene with different lights, cameras, materials or vertex positions.
                Its tree and tables are reused where possible. Hits and pictures don't depend on it.
            threads: number of threads for the build; 0 means all processors.
            fast_build: builds the tree faster, but makes ray queries slower.

        Raises:
            SceneError: an index is out of range, arrays of a mesh differ in length, or a number is
                not finite.
            LimitError: there is not enough memory, or there are too many primitives.
        """
        return PreparedScene(self, previous, threads=threads, fast_build=fast_build)

    def view(
        self,
        options: str | Sequence[str] = "",
        *,
        height: int = 700,
        port: int = 0,
        name: str = "scene",
        allow_host: str = "",
    ) -> View:
        """Prepares the scene and serves a page that shows it; see PreparedScene.view()."""
        return self.prepare().view(
            options, height=height, port=port, name=name, allow_host=allow_host
        )

    def copy(self) -> Scene:
        """Returns a copy that shares only arrays, images and maps."""
        memo: dict[int, Any] = {}
        for shared in self._shared():
            memo[id(shared)] = shared
        return copy.deepcopy(self, memo)

    def _shared(self) -> list[Any]:
        result: list[Any] = []
        for item in self.objects:
            if isinstance(item.shape, Mesh):
                mesh = item.shape
                result += [mesh.vertices, mesh.faces, mesh.normals, mesh.tangents, *mesh.uv]
                result += [mesh.colors, mesh.segments]
        return [array for array in result if isinstance(array, np.ndarray)]

    def _add(self, shape: Any, material: Material | None, name: str) -> Object:
        result = Object(shape, material, name)
        self.objects.append(result)
        return result


def _rotated(columns: Any, vectors: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
    """Multiplies a matrix by vectors. Adds in a fixed order instead of using BLAS, whose results
    depend on the processor."""
    x, y, z = (vectors[:, k : k + 1].astype(np.float64) for k in range(3))
    return np.asarray(x * columns[0] + y * columns[1] + z * columns[2])


def _transform(mesh: Mesh, matrix: npt.NDArray[Any]) -> None:
    if matrix.shape != (4, 4):
        raise ValueError(f"transform must be a 4 x 4 matrix, not {matrix.shape}")
    m = matrix.astype(np.float64)
    if not np.array_equal(m[3], (0, 0, 0, 1)):
        raise ValueError("transform must be affine: its last row must be 0, 0, 0, 1")
    a, b, c = m[:3, 0], m[:3, 1], m[:3, 2]
    mesh.vertices = _rotated((a, b, c), np.asarray(mesh.vertices)) + m[:3, 3]
    cofactors = (_cross(b, c), _cross(c, a), _cross(a, b))
    volume = float((a * cofactors[0]).sum())
    # Below rotations, a scale of 0 gives a volume of either sign, by rounding.
    is_mirrored = volume < -1e-12 * math.prod(math.hypot(*v) for v in (a, b, c))
    if mesh.normals is not None:
        normals = _rotated(cofactors, np.asarray(mesh.normals)) * (-1 if is_mirrored else 1)
        squares = normals[:, 0] ** 2 + normals[:, 1] ** 2 + normals[:, 2] ** 2
        lengths = np.sqrt(squares)[:, None]
        mesh.normals = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    if is_mirrored:
        mesh.faces = np.ascontiguousarray(np.asarray(mesh.faces)[:, [0, 2, 1]])


def _cross(a: npt.NDArray[Any], b: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def linear_colors(colors: Any) -> npt.NDArray[Any]:
    """Returns (n, 4) linear colors from (n, 3) or (n, 4) linear numbers or 8-bit sRGB integers."""
    array = as_array(colors, "colors")
    if array.ndim != 2 or array.shape[1] not in (3, 4):
        raise ValueError(f"colors must have shape (n, 3) or (n, 4), not {array.shape}")
    if array.dtype == np.uint8:
        table = np.array([_core.linear_from_srgb(k / 255) for k in range(256)], np.float32)
        result = np.concatenate([table[array[:, :3]], array[:, 3:] / np.float32(255)], axis=1)
    else:
        result = as_numbers(array, "colors", array.shape[1])
        if not ((result >= 0) & (result <= 1)).all():
            raise ValueError("colors must be in [0, 1], or 8-bit sRGB integers of the type uint8")
    if result.shape[1] == 3:
        result = np.concatenate([result, np.ones((len(result), 1), result.dtype)], axis=1)
    return result


def scene_of(source: Any) -> Scene:
    """Makes a scene from a trimesh.Trimesh, a trimesh.Scene, or any object with `vertices` and
    `faces`.

    Ignores vertex normals that trimesh has computed itself, so that faces stay flat. Reads the
    attributes `vertices`, `faces`, `visual` (colors of vertices or faces, texture coordinates, a
    PBR material), `graph` and `geometry`. Doesn't import trimesh.
    """
    from ._from_trimesh import scene_from

    return scene_from(source)


def load(
    path: str | bytes | PathLike[str],
    *,
    detail: Literal["shape", "color", "shape_and_color", "all"] = "all",
    variant: str | int = "",
    time: float | None = None,
    animation: str | int = "",
    allowed_folders: Iterable[str | bytes | PathLike[str]] | str | bytes | PathLike[str] = (),
) -> Scene:
    """Reads a scene: glTF 2.0 (.gltf, .glb) or microtrace JSON (.json).

    Args:
        path: the file; "-" is standard input.
        detail: the attributes to load. "shape" suffices for rays and all AOVs except albedo, and
            decodes only images whose alpha affects visibility. "color" suffices for flat pictures,
            "shape_and_color" for both. "all" is needed for path tracing.
        variant: name or index of a material variant of a glTF asset.
        time: animation time in seconds; None means the pose without animation.
        animation: name or index of an animation, or "all"; "" means the first.
        allowed_folders: a folder, or several, from which a glTF asset may also load buffers and
            images.

    Warns:
        SceneWarning: for each oddity, ignored feature and repaired violation.

    Raises:
        SceneError: the file violates its format.
        UnsupportedError: the file requires an unsupported feature.
        FileError: the file can't be read.
    """
    return SceneFile(
        path,
        detail=detail,
        variant=variant,
        animation=animation,
        allowed_folders=allowed_folders,
    ).at(time)


class SceneFile:
    """A scene file that is read once, and whose scene can be made for many animation times. Takes
    the arguments of load()."""

    def __init__(
        self,
        path: str | bytes | PathLike[str],
        *,
        detail: Literal["shape", "color", "shape_and_color", "all"] = "all",
        variant: str | int = "",
        animation: str | int = "",
        allowed_folders: Iterable[str | bytes | PathLike[str]] | str | bytes | PathLike[str] = (),
    ) -> None:
        self._file = _core.SceneFile(
            as_path(path, "path"),
            as_text(detail, "detail"),
            _chosen(variant, "variant"),
            _chosen(animation, "animation"),
            [as_path(folder, "allowed_folders") for folder in _listed(allowed_folders)],
        )

    def at(self, time: float | None) -> Scene:
        """Returns the scene at a time in seconds, which is clamped to the animation's range; None
        means without animation.

        Warns and raises like load().
        """
        seconds = None if time is None else as_float(time, "time", "a number or None")
        fields, diagnostics = self._file.at(seconds)
        warn(diagnostics)
        return Scene(**fields)


def _chosen(value: Any, what: str) -> str:
    """Returns a name or an index as text."""
    if isinstance(value, str):
        return as_text(value, what)
    try:
        return str(operator.index(value))
    except TypeError:
        raise TypeError(f"{what} must be a name or an index, not {value!r}") from None


def _listed(folders: Any) -> list[Any]:
    """Returns a list of folders. A single path is not an iterable of letters."""
    if isinstance(folders, (str, bytes, PathLike)):
        return [folders]
    try:
        return list(folders)
    except TypeError:
        raise TypeError(f"allowed_folders must be paths, not {folders!r}") from None
