from collections.abc import Iterable, Sequence
from os import PathLike
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from .cameras import Camera, PerspectiveCamera
from .errors import Diagnostic

Array = npt.NDArray[Any]

version: str
quantities: tuple[tuple[str, int, bool], ...]

def linear_from_srgb(encoded: float) -> float: ...

class ImageData:
    def __init__(self, pixels: Array, name: str) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def pixels(self) -> Array: ...

class MapData:
    def __init__(self, pixels: Array) -> None: ...
    @property
    def pixels(self) -> npt.NDArray[np.float32]: ...

def load_map(path: str | PathLike[str]) -> tuple[MapData, list[Diagnostic]]: ...

class SceneFile:
    def __new__(
        cls,
        path: str | PathLike[str],
        detail: str,
        variant: str,
        animation: str,
        allowed_folders: Sequence[str],
    ) -> Self: ...
    def at(self, time: float | None) -> tuple[dict[str, Any], list[Diagnostic]]: ...

class AllHits:
    def __len__(self) -> int: ...

class Viewer:
    def __init__(
        self, prepared: Prepared, name: str, words: list[str], port: int, allowed_host: str
    ) -> None: ...
    def close(self) -> None: ...
    @property
    def address(self) -> str: ...
    @property
    def port(self) -> int: ...
    @property
    def is_closed(self) -> bool: ...

class Prepared:
    def __init__(
        self, scene: Any, previous: Prepared | None, threads: int, fast_build: bool
    ) -> None: ...
    @property
    def has_bounded_object(self) -> bool: ...
    @property
    def is_flat(self) -> bool: ...
    @property
    def has_lights(self) -> bool: ...
    @property
    def size(self) -> tuple[int, int]: ...
    def default_camera(self, size: tuple[int, int]) -> Camera: ...
    def scene(self) -> dict[str, Any]: ...
    def intersect(
        self,
        rays: Array,
        t_min: Array | None,
        t_max: Array | None,
        outputs: dict[str, Array],
        threads: int,
    ) -> None: ...
    def explain(
        self,
        ray: Array,
        t_min: Array | None,
        t_max: Array | None,
        max_hits: int,
        max_misses: int,
    ) -> str: ...
    def occluded(
        self, rays: Array, t_min: Array | None, t_max: Array | None, result: Array, threads: int
    ) -> None: ...
    def intersect_all(
        self, rays: Array, t_min: Array | None, t_max: Array | None, threads: int
    ) -> AllHits: ...
    def fill_all(
        self,
        hits: AllHits,
        rays: Array,
        t_min: Array | None,
        t_max: Array | None,
        outputs: dict[str, Array],
        offsets: Array,
        owners: Array,
        ties: Array,
        threads: int,
    ) -> None: ...
    def find_facing(
        self, rays: Array, faces: Array, facing: npt.NDArray[np.int8], threads: int
    ) -> None: ...
    def count_crossings(
        self, rays: Array, t_min: Array | None, t_max: Array | None, counts: Array, threads: int
    ) -> None: ...

class Solid:
    def __init__(self, scene: Prepared, object: int | None) -> None: ...
    def is_closed(self) -> bool: ...
    def open_edges(self) -> npt.NDArray[np.float64]: ...
    def locate(self, points: Array, sides: Array, threads: int, /) -> None: ...
    def nearest(
        self,
        points: Array,
        position: Array,
        distance: Array,
        object: Array,
        primitive: Array,
        barycentrics: Array,
        threads: int,
        /,
    ) -> None: ...

class Dataset:
    def __init__(
        self,
        words: Sequence[str],
        folder: str | PathLike[str],
        root: str | PathLike[str],
        threads: int,
        /,
    ) -> None: ...
    def order(self) -> list[int]: ...
    def content(self) -> tuple[str, int]: ...
    def create(self, path: str | PathLike[str], /) -> None: ...
    def render(self, path: str | PathLike[str], view: int, /) -> list[str]: ...
    def finish(self, path: str | PathLike[str], /) -> list[str]: ...
    def take_warnings(self) -> list[Diagnostic]: ...

def read_dataset(words: Sequence[str], /) -> tuple[Dataset, list[str]]: ...
def is_whole_view(path: str | PathLike[str], view: int, /) -> bool: ...
def picture_array(shape: tuple[int, ...], is_integer: bool, /) -> Array: ...
def render(
    scene: Prepared,
    camera: Camera,
    outputs: dict[str, Array],
    arguments: dict[str, Any],
) -> str: ...
def automatic_exposure(scene: Prepared, camera: Camera, arguments: dict[str, Any]) -> float: ...
def save(
    color: Array,
    exposure: float,
    tone_map: str,
    denoiser: str,
    channels: dict[str, Array],
    part: tuple[int, int, int, int],
    path: str | PathLike[str],
    /,
) -> None: ...
def denoiser_name() -> str: ...
def denoise(
    color: Array, features: dict[str, Array], has_lens: bool, has_ground: bool, threads: int, /
) -> None: ...
def encode(color: Array, exposure: float, tone_map: str, to: Array, /) -> None: ...
def frame(
    scene: Prepared, azimuth: float, elevation: float, fov: float, size: Iterable[int], /
) -> PerspectiveCamera: ...
