"""Tests the division of ranges into tasks, with tasks on threads instead of a Dask cluster."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

pytest.importorskip("distributed")

from microtrace.distributed._ranges import Outcome, RangeRun


class Threads:
    """Has the functions of distributed.Client that RangeRun calls."""

    def __init__(self) -> None:
        self.pool = ThreadPoolExecutor(8)
        self.calls: list[tuple[int, int]] = []

    def nthreads(self) -> dict[str, int]:
        return {"a": 2, "b": 2, "c": 2}

    def processing(self) -> dict[str, list[Any]]:
        return {}

    def submit(self, task: Any, job: Any, first: int, last: int, **_: Any) -> Any:
        self.calls.append((first, last))
        return self.pool.submit(task, job, first, last)

    def cancel(self, futures: list[Any]) -> None:
        pass


def run(
    slow_item: Callable[[int], Outcome],
    retries: int,
    last_item: Callable[[], Outcome] = lambda: Outcome("a", 1e-3),
) -> tuple[Threads, list[int]]:
    """Runs a task for each of seven items. Attempt n of item 5 returns slow_item(n), all attempts
    of item 6 last_item(). Returns the client and the items that were received."""
    client, received = Threads(), []
    attempts = iter(range(100))

    def task(job: Any, first: int, last: int) -> Outcome:
        if first == 5:
            return slow_item(next(attempts))
        return last_item() if first == 6 else Outcome("a", 1e-3)

    def receive(first: int, last: int, value: Any) -> None:
        received.extend(range(first, last))

    RangeRun(client, "test", task, None, 7, receive, None, retries).run()
    return client, received


@pytest.fixture(autouse=True)
def tasks_of_one_item(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(RangeRun, "_chunk", lambda self: 1)


def test_a_slow_task_that_fails_is_not_repeated_beside_its_parts():
    began, failed = threading.Event(), threading.Event()

    def slow_item(attempt: int) -> Outcome:
        if attempt == 0:
            began.wait(20)
            failed.set()
            return Outcome("a", error=OSError("the disk is full"))
        began.set()
        failed.wait(20)
        threading.Event().wait(0.5)  # less than the second after which it would be slow itself
        return Outcome("b", 1.0)

    for retries in (0, 3):
        began.clear()
        failed.clear()
        client, received = run(slow_item, retries)
        assert sorted(received) == list(range(7))
        assert client.calls.count((5, 6)) == 2


def test_a_slow_task_may_finish_after_its_parts_have_failed():
    failed = threading.Event()

    def slow_item(attempt: int) -> Outcome:
        if attempt == 0:
            failed.wait(20)
            threading.Event().wait(1)
            return Outcome("a", 1.0)
        failed.set()
        return Outcome("b", error=OSError("the disk is full"))

    client, received = run(slow_item, retries=0)
    assert sorted(received) == list(range(7))
    assert client.calls.count((5, 6)) == 2


def test_a_run_ends_when_a_slow_task_and_its_parts_have_failed():
    failed = threading.Event()

    def slow_item(attempt: int) -> Outcome:
        if attempt == 0:
            failed.wait(20)
            threading.Event().wait(1)
        failed.set()
        return Outcome("ab"[attempt % 2], error=OSError(f"the disk is full at attempt {attempt}"))

    with pytest.raises(OSError, match="attempt 0"):
        run(slow_item, retries=0)


def test_other_tasks_of_items_that_are_done_are_canceled(monkeypatch):
    began, canceled, finished = threading.Event(), threading.Event(), threading.Event()
    monkeypatch.setattr(Threads, "cancel", lambda self, futures: canceled.set())
    in_time = []

    def slow_item(attempt: int) -> Outcome:
        if attempt == 0:
            began.wait(20)
            return Outcome("a", 1.0)
        began.set()
        finished.wait(20)
        return Outcome("b", 1.0)

    def last_item() -> Outcome:
        in_time.append(canceled.wait(10))
        finished.set()
        return Outcome("a", 1.0)

    run(slow_item, retries=0, last_item=last_item)
    assert all(in_time)
