"""What workers keep between tasks: scenes by digest, prepared once for each process."""

from __future__ import annotations

import hashlib
import pickle
import shutil
import tempfile
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from distributed import Client, WorkerPlugin, get_worker

from .. import __version__
from ..errors import Diagnostic, Error, failure, set_diagnostic
from ._ranges import Outcome


@dataclass(frozen=True)
class Job:
    """What each task gets. The rest is broadcast."""

    digest: str  #: of the broadcast payload
    version: str = __version__  #: of microtrace on the client


@dataclass
class _Kept:
    """An object of this process, made on first use."""

    payload: bytes | None
    folder: str  #: the worker's folder for temporary files
    users: int = 0  #: number of runs that use it
    made: Any = None
    lock: threading.Lock = field(default_factory=threading.Lock)


#: Seconds that a task waits for the broadcast payload.
_PATIENCE = 60.0

_kept: dict[str, _Kept] = {}
_lock = threading.Lock()


@contextmanager
def broadcast(client: Client, content: Any) -> Iterator[Job]:
    """Sends the content to all workers, once to each, while the context lasts."""
    payload = pickle.dumps(content, protocol=5)
    digest = hashlib.sha256(payload).hexdigest()
    plugin = Broadcast(digest, payload, uuid.uuid4().hex[:8])

    def in_background(work: Callable[[], object], patience: float) -> None:
        # The scheduler waits for the answers of all workers, but some may be unresponsive.
        errors: list[Exception] = []

        def run() -> None:
            try:
                work()
            except Exception as error:
                errors.append(error)

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        thread.join(patience)
        if errors:
            raise errors[0]

    def register() -> None:
        # The scheduler keeps the plugin for new workers even if a worker dies during the broadcast.
        for pause in (0.1, 0.2, 0.5, 1.0, 2.0):
            try:
                client.register_plugin(plugin)
                return
            except OSError:
                time.sleep(pause)
        client.register_plugin(plugin)

    in_background(register, 5)
    try:
        yield Job(digest)
    finally:
        with suppress(Exception):
            unregister: Any = client.unregister_worker_plugin
            in_background(lambda: unregister(plugin.name), 1)


def require_synchronous(client: Client) -> None:
    """Raises TypeError for anything but a synchronous client, and ValueError for a closed one."""
    if not isinstance(client, Client) or client.asynchronous:
        raise TypeError(f"expected a synchronous distributed.Client, not {client!r}")
    if client.status in ("closing", "closed"):
        raise ValueError("the client is closed")


class Broadcast(WorkerPlugin):
    """Sends bytes to all workers, including those that join later."""

    def __init__(self, digest: str, payload: bytes, token: str) -> None:
        self.name = f"microtrace-{digest[:12]}-{token}"
        self.digest = digest
        self.payload = payload

    def setup(self, worker: Any) -> None:
        with _lock:
            # The object of an earlier run stays until another one is needed.
            for digest in [d for d, k in _kept.items() if k.users == 0 and d != self.digest]:
                discard(_kept.pop(digest).made)
            kept = _kept.setdefault(self.digest, _Kept(None, worker.local_directory))
            kept.users += 1
            if kept.made is None:
                kept.payload = self.payload

    def teardown(self, worker: Any) -> None:
        with _lock:
            if (kept := _kept.get(self.digest)) is not None:
                kept.users -= 1


def discard(made: Any) -> None:
    """Frees an object's files."""
    if isinstance(folder := getattr(made, "folder", None), str):
        shutil.rmtree(folder, ignore_errors=True)


def made_from(digest: str, make: Callable[[Any, str], Any]) -> Any:
    """Returns make(payload, folder) for the broadcast payload, made once for each process."""
    kept = _kept.get(digest)
    begin = time.monotonic()
    while kept is None:
        if time.monotonic() - begin > _PATIENCE:
            raise OSError("the scene has not arrived on this worker")
        time.sleep(0.02)
        kept = _kept.get(digest)
    with kept.lock:
        if kept.made is None:
            assert kept.payload is not None
            kept.made = make(pickle.loads(kept.payload), kept.folder)
            kept.payload = None
        return kept.made


def attempt(job: Job, work: Callable[[], tuple[float, Any]]) -> Outcome:
    """Runs work(), which returns its seconds and its value. Returns failures of this worker as
    values."""
    address = get_worker().address
    if job.version != __version__:
        message = (
            f"the worker {address} has microtrace {__version__}, the client {job.version}; "
            "install the same version"
        )
        raise failure(2, message)
    try:
        seconds, value = work()
    except (OSError, MemoryError) as error:
        return Outcome(address, error=error)
    return Outcome(address, seconds, value)


class Stopwatch:
    """Measures seconds since its construction."""

    def __init__(self) -> None:
        self._begin = time.perf_counter()

    def seconds(self) -> float:
        return time.perf_counter() - self._begin


def temporary_folder(parent: str) -> str:
    """Creates a folder for files of this process."""
    Path(parent).mkdir(parents=True, exist_ok=True)
    return tempfile.mkdtemp(prefix="microtrace-", dir=parent)


def renamed(diagnostic: Diagnostic, copies: Path, original: str = "") -> Diagnostic:
    """Names a file of the client, below the folder `original`, instead of its copy below the folder
    `copies`."""
    names = ("file", "message", "text")
    texts = {name: getattr(diagnostic, name).replace(str(copies), original) for name in names}
    return replace(diagnostic, **texts)


@contextmanager
def client_names(copies: Path, original: str = "") -> Iterator[None]:
    """Lets errors name the client's files, as renamed() does."""
    try:
        yield
    except Error as error:
        set_diagnostic(error, renamed(error.diagnostic, copies, original))
        raise
