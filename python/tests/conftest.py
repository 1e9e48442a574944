"""Paths of the test scenes and of the program."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).parents[2]
SCENES = REPOSITORY / "scenes"


@pytest.fixture
def program() -> str:
    """Returns the program of the same version, which pip installs beside Python."""
    installed = Path(sys.executable).parent / "microtrace"
    found = os.environ.get("MICROTRACE_PROGRAM") or str(installed)
    assert Path(found).exists(), "install the package or set MICROTRACE_PROGRAM"
    return found


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(1)


@contextmanager
def interrupted_after(seconds: float) -> Iterator[None]:
    """Interrupts the body as Ctrl+C does and checks that it ends soon. Background jobs of a shell
    ignore the signal unless they ask for it."""
    earlier = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            start = time.monotonic()
            threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT)).start()
            yield
        assert time.monotonic() - start < 30
    finally:
        signal.signal(signal.SIGINT, earlier)


def icosphere(levels: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns vertices and faces of a subdivided icosahedron, closed and facing outward."""
    g = (1 + 5**0.5) / 2
    corners = [(s, t, 0.0) for s in (-1.0, 1.0) for t in (-g, g)]
    vertices = [np.roll(corner, k) for k in range(3) for corner in corners]
    points = np.array(vertices) / np.sqrt(1 + g * g)
    edge = 2 / np.sqrt(1 + g * g) + 1e-9
    faces = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                a, b, c = points[[i, j, k]]
                if max(np.linalg.norm(a - b), np.linalg.norm(b - c), np.linalg.norm(c - a)) < edge:
                    outward = np.dot(np.cross(b - a, c - a), a) > 0
                    faces.append((i, j, k) if outward else (i, k, j))
    for _ in range(levels):
        places: dict[tuple[int, int], int] = {}
        new_points = list(points)

        def middle(i: int, j: int) -> int:
            key = (min(i, j), max(i, j))
            if key not in places:
                p = new_points[i] + new_points[j]
                places[key] = len(new_points)
                new_points.append(p / np.linalg.norm(p))
            return places[key]

        new_faces = []
        for i, j, k in faces:
            a, b, c = middle(i, j), middle(j, k), middle(k, i)
            new_faces += [(i, a, c), (a, j, b), (c, b, k), (a, b, c)]
        points, faces = np.array(new_points), new_faces
    return np.asarray(points), np.asarray(faces)
