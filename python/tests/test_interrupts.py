"""Handlers of signals run during long calls, which end if a handler raises an exception."""

from __future__ import annotations

import signal
from collections.abc import Callable

import microtrace as mt
import numpy as np
import pytest


class Stop(Exception):
    """What the handler raises."""


def interrupt(work: Callable[[], object]) -> None:
    """Calls work() while signals arrive. The second call of their handler raises Stop. A call that
    handles no signals has a single one of them pending at its end."""
    count = 0

    def handle(*_: object) -> None:
        nonlocal count
        count += 1
        if count == 2:
            raise Stop

    before = signal.signal(signal.SIGALRM, handle)
    signal.setitimer(signal.ITIMER_REAL, 0.05, 0.05)
    try:
        work()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_explanations():
    scene = mt.Scene()
    corners = np.random.default_rng(1).random((60_000, 3))
    scene.add_mesh(corners, np.arange(60_000).reshape(-1, 3))
    prepared = scene.prepare()
    ray = np.array([[0.5, 0.5, 5, 0, 0, -1]])
    with pytest.raises(Stop):
        # Not through the Python function, which spends a long time on the text.
        interrupt(lambda: prepared._core.explain(ray, None, None, 1000, 60_000))


def test_automatic_exposures(monkeypatch):
    monkeypatch.setattr(mt.pictures._core, "render", None)  # only the exposure is interrupted
    white = mt.Material(base_color_factor=(1, 1, 1, 1), metallic_factor=0, double_sided=True)
    scene = mt.Scene(lights=[mt.PointLight((0, 0, 0))], cameras=[mt.PerspectiveCamera()])
    scene.add_sphere((0, 0, 0), 9, material=white)
    prepared = scene.prepare()
    with pytest.raises(Stop):
        interrupt(lambda: mt.render(prepared, spp=1, exposure="auto", threads=1))
