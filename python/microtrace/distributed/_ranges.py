"""Divides a range of items into tasks for a Dask client.

Dask places the tasks, notices lost workers and repeats their tasks. This module chooses the size of
tasks from measured costs, divides the ranges of slow tasks further, and keeps away from workers
that report a full disk or a lack of memory.
"""

from __future__ import annotations

import asyncio
import concurrent.futures
import contextlib
import queue
import time
import uuid
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

from distributed import KilledWorker

from ..errors import failure

#: Seconds that a task should take.
_TARGET = 4.0
#: The least seconds worth a task, for the last tasks of a run.
_LEAST = 0.2
#: A task may have this many times the items of the largest finished task.
_GROWTH = 8
#: Errors that another attempt may not have: lost connections and workers, lost results.
_PASSING = (
    OSError,
    MemoryError,
    KilledWorker,
    asyncio.CancelledError,
    concurrent.futures.CancelledError,
)
#: Seconds between two looks at the cluster.
_INTERVAL = 0.25


@dataclass(frozen=True)
class Outcome:
    """What a task returns."""

    worker: str  #: address of the worker
    seconds: float = 0.0  #: time for the items, without preparing the scene
    value: Any = None
    #: A failure that another worker may not have, such as a full disk.
    error: Exception | None = None


#: task(job, first, last) handles the items first to last - 1 on a worker.
Task = Callable[..., Outcome]


@dataclass
class _Flight:
    """A submitted task."""

    first: int
    last: int
    future: Any  #: a distributed.Future
    begin: float
    attempts: int
    is_divided: bool = False


@dataclass
class RangeRun:
    """Runs a task for each part of range(count) until every item is done."""

    client: Any  #: a synchronous distributed.Client
    name: str  #: of the tasks on the dashboard
    task: Task
    job: Any  #: first argument of the tasks
    count: int
    receive: Callable[[int, int, Any], None]  #: takes first, last and Outcome.value
    progress: Callable[[float], bool | None] | None
    retries: int
    start: int = 1  #: items of the first tasks

    _flights: dict[Any, _Flight] = field(default_factory=dict)
    _arrived: queue.SimpleQueue[tuple[Any, Any]] = field(default_factory=queue.SimpleQueue)
    _costs: deque[tuple[int, float]] = field(default_factory=lambda: deque(maxlen=64))
    _delayed: list[tuple[float, tuple[int, int, int]]] = field(default_factory=list)
    _avoided: set[str] = field(default_factory=set)
    _workers: dict[str, int] = field(default_factory=dict)
    _looked: float = float("-inf")
    _next: int = 0
    _largest: int = 0
    _submitted: int = 0

    def __post_init__(self) -> None:
        self._token = uuid.uuid4().hex[:8]
        self._done = bytearray(self.count)
        self._left = self.count
        self._fetchers = ThreadPoolExecutor(8, thread_name_prefix="microtrace-fetch")

    def run(self) -> None:
        """Returns when all items are done. Raises the first error that no retry can help."""
        try:
            while self._left > 0:
                self._look()
                self._resume_delayed()
                while self._next < self.count and len(self._flights) < 2 * self._slots() + 1:
                    first, self._next = self._next, min(self.count, self._next + self._chunk())
                    self._submit(first, self._next, attempts=0)
                self._take(_INTERVAL)
                if self._next == self.count:
                    self._divide_slow()
        finally:
            self._fetchers.shutdown(wait=False, cancel_futures=True)
            futures = [flight.future for flight in self._flights.values()]
            with contextlib.suppress(Exception):  # a closed client has no tasks to cancel
                if futures:
                    self.client.cancel(futures)
            self._flights.clear()

    def _resume_delayed(self) -> None:
        now = time.monotonic()
        due = [again for when, again in self._delayed if when <= now]
        self._delayed = [entry for entry in self._delayed if entry[0] > now]
        for again in due:
            self._submit(*again)

    def _look(self) -> bool:
        """Looks at the cluster now and then. Returns False if no worker is free of failures."""
        now = time.monotonic()
        if now - self._looked >= 4 * _INTERVAL:
            self._workers = dict(self.client.nthreads())
            self._looked = now
            if not set(self._workers) - self._avoided:
                self._avoided.clear()
                return False
        return True

    def _slots(self) -> int:
        return max(1, sum(n for w, n in self._workers.items() if w not in self._avoided))

    def _seconds_per_item(self) -> float:
        items = sum(n for n, _ in self._costs)
        return max(sum(s for _, s in self._costs) / items, 1e-9) if items else 0.0

    def _chunk(self) -> int:
        """Returns the number of items of the next task."""
        if not self._costs:
            return self.start
        cost = self._seconds_per_item()
        # Shares of what is left let all workers finish at about the same time.
        share = (self.count - self._next) / (2 * self._slots())
        size = min(_TARGET / cost, max(share, _LEAST / cost), _GROWTH * self._largest)
        return max(1, int(size))

    def _submit(
        self, first: int, last: int, attempts: int, owner: frozenset[str] = frozenset()
    ) -> None:
        avoided = self._avoided | owner
        allowed = [w for w in self._workers if w not in avoided] if avoided else []
        key = (f"{self.name}-{self._token}", first, last, self._submitted)
        self._submitted += 1
        future = self.client.submit(
            self.task,
            self.job,
            first,
            last,
            key=key,
            workers=allowed or None,
            allow_other_workers=bool(allowed),
            pure=False,
        )
        self._flights[key] = _Flight(first, last, future, time.monotonic(), attempts)
        future.add_done_callback(lambda done: self._fetch_later(key, done))

    def _fetch_later(self, key: Any, future: Any) -> None:
        def fetch() -> None:
            try:
                result = future.result()
            except BaseException as error:  # includes both kinds of CancelledError
                result = error
            self._arrived.put((key, result))

        try:
            self._fetchers.submit(fetch)
        except RuntimeError:
            return  # the run has ended

    def _take(self, timeout: float) -> None:
        """Handles the results that have arrived."""
        try:
            key, result = self._arrived.get(timeout=timeout)
            while True:
                self._handle(key, result)
                key, result = self._arrived.get_nowait()
        except queue.Empty:
            return

    def _handle(self, key: Any, result: Any) -> None:
        flight = self._flights.pop(key, None)
        if flight is None:
            return  # another task was faster
        if isinstance(result, Outcome) and result.error is None:
            self._finish(flight, result)
            return
        error: BaseException
        if isinstance(result, Outcome):
            assert result.error is not None
            error = result.error
            self._avoided.add(result.worker)
        else:
            error = result
        if not isinstance(error, _PASSING):
            raise error
        first, last = self._left_by(flight)
        if first == last:
            return
        if flight.attempts >= self.retries:
            raise error
        again = (first, last, flight.attempts + 1)
        self._looked = float("-inf")
        if self._look():
            self._submit(*again)
        else:
            self._delayed.append((time.monotonic() + 2.0 ** (flight.attempts - 1), again))

    def _left_by(self, flight: _Flight) -> tuple[int, int]:
        """Returns the range of a failed task's items that are left to do."""
        done = self._done[flight.first : flight.last]
        # The parts of a slow task need not be repeated. If a part fails too often, the slow task
        # may still succeed.
        if flight.is_divided or flight.attempts >= self.retries:
            others = [(other.first, other.last) for other in self._flights.values()]
            others += [(first, last) for _, (first, last, _) in self._delayed]
            for first, last in others:
                begin, end = max(first, flight.first), min(last, flight.last)
                if begin < end:
                    done[begin - flight.first : end - flight.first] = b"\1" * (end - begin)
        first = done.find(0)
        return (flight.first + first, flight.first + done.rfind(0) + 1) if first >= 0 else (0, 0)

    def _finish(self, flight: _Flight, outcome: Outcome) -> None:
        items = flight.last - flight.first
        self._costs.append((items, outcome.seconds))
        self._largest = max(self._largest, items)
        fresh = self._done.count(0, flight.first, flight.last)
        if fresh == 0:
            return
        self.receive(flight.first, flight.last, outcome.value)
        self._done[flight.first : flight.last] = b"\1" * items
        self._left -= fresh
        for key, other in list(self._flights.items()):
            overlaps = other.first < flight.last and flight.first < other.last
            if overlaps and self._done.count(0, other.first, other.last) == 0:
                self.client.cancel([self._flights.pop(key).future])
        if self.progress is not None and self.progress(1 - self._left / self.count) is False:
            message = "canceled by the progress function"
            raise failure(7, message)

    def _divide_slow(self) -> None:
        """Submits the ranges of slow tasks again, in parts, while workers are idle."""
        now = time.monotonic()
        cost = self._seconds_per_item()
        slow = [
            (key, flight)
            for key, flight in self._flights.items()
            if not flight.is_divided
            and now - flight.begin > 1 + 3 * cost * (flight.last - flight.first)
        ]
        if not slow:
            return
        processing = self.client.processing()
        idle = sum(
            max(0, threads - len(processing.get(worker, ())))
            for worker, threads in self._workers.items()
            if worker not in self._avoided
        )
        if idle == 0:
            return
        owners = {key: worker for worker, keys in processing.items() for key in keys}
        for key, flight in slow:
            flight.is_divided = True
            owner = frozenset({owners[key]} if key in owners else ())
            missing = [i for i in range(flight.first, flight.last) if not self._done[i]]
            parts = min(len(missing), max(2, idle // len(slow)))
            for part in range(parts):
                mine = missing[len(missing) * part // parts : len(missing) * (part + 1) // parts]
                self._submit(mine[0], mine[-1] + 1, flight.attempts, owner)
