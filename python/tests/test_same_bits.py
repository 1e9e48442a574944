"""Tests that bytes are the same with every instruction set and number of threads, and unchanged."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from conftest import SCENES

CODE = """
import hashlib, sys
import numpy as np
import microtrace as mt

threads = int(sys.argv[2])
prepared = mt.load(sys.argv[1]).prepare(threads=threads)
# Computes rays from integers, because the bits of random generators could change.
k = np.arange(6 * 20000, dtype=np.int64).reshape(-1, 6)
rays = ((k * 7919 % 4001 - 2000) / 512).astype(np.float32)
rays[:, :3] *= np.float32(0.25)
digest = hashlib.sha256()
fields = ("t", "object", "primitive", "position", "normal", "face_normal", "barycentrics", "uv")
for hits in (
    prepared.intersect(rays, fields=fields, threads=threads),
    prepared.intersect_all(rays[:2000], fields=fields, threads=threads),
):
    for name in fields:
        digest.update(getattr(hits, name).tobytes())
digest.update(prepared.occluded(rays, threads=threads).tobytes())
digest.update(prepared.locate(rays[:5000, :3], threads=threads).tobytes())
nearest = prepared.closest_point(rays[:500, :3], threads=threads)
for array in (nearest.position, nearest.distance, nearest.primitive, nearest.barycentrics):
    digest.update(array.tobytes())
names = ["color", "depth", "position", "normal", "uv", "object", "variance", "denoise_normal"]
picture = mt.render(prepared, size=(48, 36), spp=3, aovs=names, threads=threads)
for name in names:
    digest.update(picture[name].tobytes())
print(digest.hexdigest())
"""

EXPECTED = "2d8ab762663b3c523c31eeb14751c1aba28339f459fc6d54d7528a537c324b9d"


@pytest.mark.parametrize("instruction_set", ["portable", "avx2", "avx512"])
@pytest.mark.parametrize("threads", [1, 3])
def test_same_bits(instruction_set, threads):
    """MICROTRACE_ISA limits the instruction set of the kernels. Processors without this set use the
    next lower one."""
    run = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", CODE, SCENES / "gltf" / "knot.glb", str(threads)],
        env={**os.environ, "MICROTRACE_ISA": instruction_set},
        capture_output=True,
        text=True,
        check=True,
    )
    assert run.stdout.strip() == EXPECTED
