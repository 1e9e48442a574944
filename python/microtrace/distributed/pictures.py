"""Renders the pixels of pictures on workers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from distributed import Client

from .._arrays import MOST, as_integer, as_size
from .._brief import Vector
from ..cameras import Camera
from ..errors import warn_caller
from ..lights import Environment
from ..pictures import (
    Picture,
    Quantity,
    _checked,
    _denoise,
    _denoiser,
    _ground_arguments,
    _layout,
    _shown,
    _with_features,
    is_ground_missing,
    missing_ground,
)
from ..pictures import render as render_here
from ..prepared import PreparedScene
from ..scene import Scene
from ._ranges import Outcome, RangeRun
from ._worker import Job, Stopwatch, attempt, broadcast, made_from, require_synchronous

#: Side of the squares of pixels that are not divided.
_TILE = 8

Rect = tuple[int, int, int, int]


@dataclass(frozen=True)
class _Pictures:
    """What all tasks of a run share, apart from the scene."""

    scene: str  #: digest of the scene
    cameras: list[Camera | None]
    size: tuple[int, int]
    options: dict[str, Any]


def _prepare(scene: Scene, folder: str) -> PreparedScene:
    return scene.prepare()


def _unchanged(content: _Pictures, folder: str) -> _Pictures:
    return content


def rects_of(first: int, last: int, width: int, height: int) -> list[Rect]:
    """Returns rectangles that cover the tiles first to last - 1, numbered row by row."""
    columns = -(-width // _TILE)
    rects: list[Rect] = []

    def add(row: int, rows: int, begin: int, end: int) -> None:
        if rows > 0 and begin < end:
            x1, y1 = min(width, end * _TILE), min(height, (row + rows) * _TILE)
            rects.append((begin * _TILE, row * _TILE, x1, y1))

    row, begin = divmod(first, columns)
    last_row, end = divmod(last, columns)
    if row == last_row:
        add(row, 1, begin, end)
        return rects
    if begin > 0:
        add(row, 1, begin, columns)
        row += 1
    add(row, last_row - row, 0, columns)
    add(last_row, 1, 0, end)
    return rects


def tiles_of(width: int, height: int) -> int:
    """Returns the number of tiles of a picture."""
    return -(-width // _TILE) * -(-height // _TILE)


def parts_of(
    first: int, last: int, width: int, height: int
) -> list[tuple[int, tuple[int, int, int, int]]]:
    """Returns pictures and rectangles that cover the tiles first to last - 1 of many pictures."""
    tiles = tiles_of(width, height)
    parts = []
    for picture in range(first // tiles, -(-last // tiles)):
        begin, end = max(first - picture * tiles, 0), min(last - picture * tiles, tiles)
        parts += [(picture, rect) for rect in rects_of(begin, end, width, height)]
    return parts


def render_tiles(job: Job, first: int, last: int) -> Outcome:
    """Renders tiles. This is the task."""

    def work() -> tuple[float, Any]:
        pictures: _Pictures = made_from(job.digest, _unchanged)
        scene: PreparedScene = made_from(pictures.scene, _prepare)
        watch = Stopwatch()
        arrays, displays = [], []
        for index, rect in parts_of(first, last, *pictures.size):
            options = dict(pictures.options)
            if (index, rect[:2]) != (0, (0, 0)):
                options["exposure"] = 0.0  # the first part's exposure is that of all pictures
            picture = render_here(
                scene, pictures.cameras[index], pictures.size, crop=rect, **options
            )
            displays.append((picture._exposure, picture._tone_map))
            arrays.append(dict(picture))
        is_missing = is_ground_missing(scene, pictures.options["ground"])
        return watch.seconds(), (arrays, displays[0], is_missing)

    return attempt(job, work)


def render(
    client: Client,
    scene: Scene | PreparedScene,
    camera: Camera | Sequence[Camera] | None = None,
    size: tuple[int, int] | None = None,
    *,
    spp: int | None = None,
    aovs: Iterable[Quantity] = ("color",),
    integrator: Literal["path", "flat"] | None = None,
    environment: Environment | None = None,
    background: Vector | None = None,
    transparent: bool = False,
    filter: Literal["box", "blackman-harris"] = "box",
    seed: int = 0,
    max_depth: int = 32,
    bsdf: Literal["conserving", "spec"] = "conserving",
    guiding: bool = False,
    ground: bool | float = False,
    denoise: bool = False,
    exposure: float | Literal["auto"] | None = None,
    threads: int = 1,
    retries: int = 3,
    progress: Callable[[float], bool | None] | bool = False,
) -> Picture:
    """Renders pictures on the workers of a Dask cluster. Returns the bytes of microtrace.render().

    The scene is sent once to each worker, where it is prepared once. Tasks render rectangles of
    pixels and take some seconds each. Their names begin with microtrace-render. Rectangles of slow
    tasks are divided and rendered again on idle workers. A rectangle that is rendered twice has the
    same bytes both times.

    Args:
        client: a synchronous client.
        scene: the scene.
        camera, size, spp, aovs: see microtrace.render().
        integrator, environment, background, transparent: see microtrace.render().
        filter, seed, max_depth, bsdf, ground: see microtrace.render().
        guiding: see microtrace.render(). Each task repeats the training.
        exposure: see microtrace.render().
        denoise: see microtrace.render(). The client denoises the finished pictures.
        threads: number of threads of each task; 0 means all processors of the worker's machine.
        retries: how often a part of a picture is rendered again after errors that another worker
            may not have, such as a lack of memory.
        progress: see microtrace.render().

    Returns:
        Arrays of shape (height, width) or (height, width, channels); for a sequence of cameras,
        with an additional first axis.

    Raises:
        ValueError: an argument is invalid, or a worker has another version of microtrace.
        TypeError: the client is asynchronous, or an argument has the wrong type.
        CanceledError: progress returned False.
        distributed.KilledWorker: workers died repeatedly while they rendered the same part.
        concurrent.futures.CancelledError: the cluster was restarted more often than `retries`.
        OSError, MemoryError: all retries failed.

    Warns:
        SceneWarning: see microtrace.render().
    """
    require_synchronous(client)
    retries = as_integer(retries, "retries", 0, MOST)
    wanted = _checked(aovs)
    names = _with_features(wanted) if denoise else wanted
    if not isinstance(scene, (Scene, PreparedScene)):
        raise TypeError(f"expected a Scene or a PreparedScene, not {type(scene).__name__}")
    if isinstance(scene, PreparedScene):
        scene = scene.scene
    denoiser = _denoiser(wanted, integrator or scene.integrator) if denoise else ""
    is_stack = isinstance(camera, Sequence)
    cameras: list[Camera | None] = list(camera) if isinstance(camera, Sequence) else [camera]
    width, height = as_size(scene.size if size is None else size)
    options: dict[str, Any] = {
        "spp": spp,
        "aovs": names,
        "integrator": integrator,
        "environment": environment,
        "background": background,
        "transparent": transparent,
        "filter": filter,
        "seed": seed,
        "max_depth": max_depth,
        "bsdf": bsdf,
        "guiding": guiding,
        "ground": ground,
        "exposure": exposure,
        "threads": threads,
    }
    arrays: dict[str, Any] = {}
    for name in names:
        channels, is_integer = _layout(name, transparent)
        shape = (len(cameras), height, width) + ((channels,) if channels > 1 else ())
        arrays[name] = np.zeros(shape, np.uint32 if is_integer else np.float32)
    display = (0.0, "none")

    def receive(first: int, last: int, value: Any) -> None:
        nonlocal display
        rendered, shown, lacks_ground = value
        if first == 0:
            display = shown
            if lacks_ground:
                warn_caller(missing_ground())
        parts = parts_of(first, last, width, height)
        for (index, (x0, y0, x1, y1)), part in zip(parts, rendered):
            for name, array in part.items():
                arrays[name][index, y0:y1, x0:x1] = array

    with broadcast(client, scene) as sent, _shown(progress, len(cameras)) as show:
        pictures = _Pictures(sent.digest, cameras, (width, height), options)
        with broadcast(client, pictures) as job:
            count = tiles_of(width, height) * len(cameras)
            RangeRun(
                client, "microtrace-render", render_tiles, job, count, receive, show, retries
            ).run()
    if denoise:
        first = scene.cameras[0] if scene.cameras else None
        has_ground = _ground_arguments(ground, "path") is not None
        _denoise(arrays, wanted, [each or first for each in cameras], has_ground, 0)
    if not is_stack:
        arrays = {name: array[0] for name, array in arrays.items()}
    part = (width, height, 0, 0)
    return Picture(arrays, *display, denoiser, is_stack=is_stack, part=part)
