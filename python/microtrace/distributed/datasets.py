"""Renders the views of a data set on workers."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from distributed import Client, get_worker
from microtrace_program import find_denoiser

from .. import _core
from .._arrays import MOST, as_integer, as_path, as_text
from ..errors import Diagnostic, failure, warn
from ..pictures import _shown
from ._ranges import Outcome, RangeRun
from ._store import Store
from ._worker import (
    Job,
    Stopwatch,
    attempt,
    broadcast,
    client_names,
    made_from,
    renamed,
    require_synchronous,
    temporary_folder,
)

#: Options of the command `microtrace dataset` that dataset() has parameters for.
_TAKEN = ("-o", "--output", "--shard", "--views", "--formats")
#: Options whose values are paths.
_PATHS = ("--env", "--views", "--allow-path")
_RECORD = re.compile(r"records/([0-9]{6,})\.json")


@dataclass(frozen=True)
class Summary:
    """What a call of dataset() did."""

    views: int  #: number of views of the data set
    rendered: int  #: number of views that were rendered
    kept: int  #: number of views that were finished before


@dataclass(frozen=True)
class _Content:
    """What all tasks share."""

    words: list[str]  #: arguments of `microtrace dataset`
    folder: str  #: to which the paths in `words` are relative
    order: npt.NDArray[np.uint32]  #: of the views
    files: dict[str, bytes]  #: by absolute path, all files that are read
    description: bytes  #: of the data set: dataset.json
    identity: tuple[str, int]  #: the program with its denoiser, and a digest of what was read
    store: Store
    is_new: bool  #: True if no view was finished at the beginning


def _record(view: int) -> str:
    return f"records/{view:06d}.json"


def recorded_views(store: Store, count: int) -> set[int]:
    """Returns those of the first `count` views that have records."""
    names = store.names("records")
    views = (int(digits[1]) for name in names if (digits := _RECORD.fullmatch(name)))
    return {view for view in views if view < count and _record(view) in names}


class _Views:
    """A data set on a worker. Its files are copies, in a folder of the worker."""

    def __init__(self, content: _Content, parent: str) -> None:
        self.folder = temporary_folder(parent)
        self.copies = Path(self.folder, "files")
        self.lock = threading.Lock()
        self._store = content.store
        self._is_new = content.is_new
        self._description = content.description
        try:
            for path, data in content.files.items():
                copy = Path(f"{self.copies}{path}")
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(data)
            words = _moved(content.words, content.folder, self.copies)
            find_denoiser()
            with client_names(self.copies):
                threads = get_worker().state.nthreads
                self._core = _core.Dataset(words, content.folder, self.copies, threads)
            _require_same(self._core.content(), content.identity)
        except BaseException:
            shutil.rmtree(self.folder, ignore_errors=True)
            raise
        self.order = content.order

    def render(self, view: int) -> bool:
        """Renders a view unless it is finished. Returns True if it was rendered."""
        if self._store.local is not None:
            if _core.is_whole_view(self._store.local, view):
                return False
            self._core.render(self._store.local, view)
            return True
        if not self._is_new and self._store.is_whole(_record(view)):
            return False
        with tempfile.TemporaryDirectory(dir=self.folder) as name:
            folder = Path(name)
            (folder / "dataset.json").write_bytes(self._description)
            (folder / "records").mkdir()
            names = self._core.render(folder, view)
            self._store.upload(folder, names)
            self._store.upload(folder, [_record(view)])
        return True

    def take_warnings(self) -> list[Diagnostic]:
        """Returns new warnings, with the names of the client's files."""
        return [renamed(warning, self.copies) for warning in self._core.take_warnings()]


def _require_same(own: tuple[str, int], client: tuple[str, int]) -> None:
    """Raises ValueError if this worker's pictures would differ from those of the client."""
    if own == client:
        return
    address = get_worker().address
    if own[0] != client[0]:
        message = f"the worker {address} has {own[0]}, the client {client[0]}; install the same"
    else:
        message = (
            f"the worker {address} decodes the scene's files differently from the client: one of "
            "them lacks a module of microtrace; install the same modules on both"
        )
    raise failure(2, message)


def _moved(words: Sequence[str], folder: str, root: Path) -> list[str]:
    """Returns arguments whose paths lead to the copies of files below `root`."""

    def move(path: str) -> str:
        copy = Path(f"{root}{os.path.normpath(os.path.join(folder, path))}")
        return str(copy) if copy.exists() else path

    moved, former = [move(words[0])], ""
    for word in words[1:]:
        name, equals, value = word.partition("=")
        if equals and name in _PATHS:
            word = f"{name}={move(value)}"
        elif former in _PATHS:
            word = move(word)
        moved.append(word)
        former = word
    return moved


def render_views(job: Job, first: int, last: int) -> Outcome:
    """Renders views. This is the task."""

    def work() -> tuple[float, Any]:
        views: _Views = made_from(job.digest, _Views)
        with views.lock:
            watch = Stopwatch()
            wanted = (int(views.order[i]) for i in range(first, last))
            with client_names(views.copies):
                rendered = [view for view in wanted if views.render(view)]
            return watch.seconds(), (rendered, views.take_warnings())

    return attempt(job, work)


def dataset(
    client: Client,
    scene: str | PathLike[str],
    url: str | PathLike[str],
    *,
    views: str | PathLike[str] | None = None,
    formats: Sequence[str] = ("png",),
    options: Sequence[str] = (),
    storage_options: Mapping[str, Any] | None = None,
    retries: int = 3,
    progress: Callable[[float], bool | None] | bool = False,
) -> Summary:
    """Renders many views of a scene on the workers of a Dask cluster, into the files of the command
    `microtrace dataset`, with the bytes of one run.

    The files of the scene are sent once to each worker, where the scene is prepared once for each
    of its poses. Tasks render some seconds of views. Their names begin with microtrace-dataset.
    Views of slow tasks are divided and rendered again on idle workers, with the same bytes. The
    same call continues a data set that was interrupted.

    Args:
        client: a synchronous client.
        scene: a scene file.
        url: the folder of the data set: a path or a URL of fsspec. A local folder must be the same
            folder for the client and all workers. Of others, object stores such as s3:// are
            suitable, because their files appear whole or not at all.
        views: a file or a generator such as "orbit:36"; see `microtrace dataset --help`.
        formats: the files of each view: "png", "exr", "npz", "coco", "bop".
        options: further options of `microtrace dataset`, such as ["--size=320x240", "--amodal"].
        storage_options: arguments for fsspec's file system. They are sent to the workers by way of
            the scheduler.
        retries: how often views are rendered again after errors that another worker may not have,
            such as a full disk.
        progress: see microtrace.render().

    Returns:
        The numbers of views.

    Raises:
        ValueError: an argument or the scene is invalid, the folder contains something else, or a
            worker has another version, other modules or another denoiser than the client.
        TypeError: the client is asynchronous, or an argument has the wrong type.
        CanceledError: progress returned False. Finished views remain.
        distributed.KilledWorker: workers died repeatedly while they rendered the same views.
        concurrent.futures.CancelledError: the cluster was restarted more often than `retries`.
        OSError, MemoryError: a file can't be read, or all retries failed.
    """
    require_synchronous(client)
    retries = as_integer(retries, "retries", 0, MOST)
    more = _words(options, "options")
    for option in more:
        if option.partition("=")[0] in _TAKEN:
            raise ValueError(f"{option}: use the arguments url, views and formats instead")
    kinds = _words(formats, "formats")
    if not kinds:
        raise ValueError("formats must not be empty")
    words = [_path(scene, "scene"), "--formats=" + ",".join(kinds)]
    words += [*more, "--output=."]
    if views is not None:
        words.append(f"--views={_path(views, 'views')}")
    folder = as_path(url, "url")
    if not isinstance(storage_options, (Mapping, type(None))):
        raise TypeError(f"storage_options must be a mapping, not {storage_options!r}")
    warned: set[tuple[int, int, str]] = set()

    def warn_once(warnings: Iterable[Diagnostic]) -> None:
        for each in warnings:
            # Of the warnings about pictures, which have no position, only the first counts.
            key = (each.line, each.column, each.message if each.line or each.pointer else "")
            if key not in warned:
                warned.add(key)
                warn([each])

    find_denoiser()
    core, names = _core.read_dataset(words)
    warn_once(core.take_warnings())
    store = Store(folder, storage_options or {})
    description, is_new = _create(core, store)
    files = {os.path.abspath(name): Path(name).read_bytes() for name in names}
    order = np.array(core.order(), np.uint32)
    content = _Content(words, os.getcwd(), order, files, description, core.content(), store, is_new)
    count = len(order)
    # The views that a task finished before it failed are in no result.
    kept = recorded_views(store, count)

    def receive(first: int, last: int, value: Any) -> None:
        kept.difference_update(value[0])
        warn_once(value[1])

    with broadcast(client, content) as job, _shown(progress, count, "view") as show:
        RangeRun(
            client, "microtrace-dataset", render_views, job, count, receive, show, retries
        ).run()
    _finish(core, store, description)
    return Summary(count, count - len(kept), len(kept))


def _words(values: Iterable[str], what: str) -> list[str]:
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise TypeError(f"{what} must be a sequence of strings, not {values!r}")
    return [as_text(value, f"a word of {what}") for value in values]


def _path(value: Any, what: str) -> str:
    return as_text(as_path(value, what), what)


def _create(core: _core.Dataset, store: Store) -> tuple[bytes, bool]:
    """Creates the folder or checks that it has this data set. Returns its description and whether
    it is new."""
    if store.local is not None:
        core.create(store.local)
        return (store.local / "dataset.json").read_bytes(), False
    with tempfile.TemporaryDirectory(prefix="microtrace-") as name:
        folder = Path(name)
        known = store.read("dataset.json")
        if known is not None:
            (folder / "dataset.json").write_bytes(known)
        elif not store.is_empty():
            message = f"{store.url}: contains files that are not a data set; name another folder"
            raise failure(2, message, store.url)
        with client_names(folder, store.url):
            core.create(folder)
        description = (folder / "dataset.json").read_bytes()
        if known is None and not store.create("dataset.json", description):
            return _create(core, store)  # another run has just created a data set
        return description, known is None


def _finish(core: _core.Dataset, store: Store, description: bytes) -> None:
    """Writes the files about all views."""
    if store.local is not None:
        core.finish(store.local)
        return
    with tempfile.TemporaryDirectory(prefix="microtrace-") as name:
        folder = Path(name)
        # Another run may have replaced the description, because not all stores can refuse that.
        (folder / "dataset.json").write_bytes(store.read("dataset.json") or description)
        with client_names(folder, store.url):
            core.create(folder)
        store.download("records", folder)
        store.download("annotations", folder)
        with client_names(folder, store.url):
            names = core.finish(folder)
        store.upload(folder, names)
