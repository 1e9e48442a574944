"""Runs the snippets of README.md one after the other."""

from __future__ import annotations

import re
import shutil

import microtrace as mt
import numpy as np
import pytest
from conftest import REPOSITORY, SCENES


def test_readme_runs(tmp_path, monkeypatch):
    trimesh = pytest.importorskip("trimesh")
    text = (REPOSITORY / "python" / "README.md").read_text()
    snippets = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert len(snippets) > 8
    shutil.copytree(SCENES, tmp_path / "scenes")
    monkeypatch.chdir(tmp_path)
    # install() replaces the engines for the whole process, so they are restored after the test.
    engines = [trimesh.ray.ray_triangle]
    if trimesh.ray.has_embree:
        engines.append(trimesh.ray.ray_pyembree)
    for engine in engines:
        monkeypatch.setattr(engine, "RayMeshIntersector", engine.RayMeshIntersector)
    names: dict[str, object] = {}
    for k, snippet in enumerate(snippets):
        exec(compile(snippet, f"README.md, snippet {k + 1}", "exec"), names)
    for name in ("sphere.png", "knot.png", "knot.exr", "knot.npz"):
        assert (tmp_path / name).stat().st_size > 0


def test_readme_shows_its_picture(tmp_path, monkeypatch):
    """The picture in the repository has the bytes that the first snippet writes."""
    text = (REPOSITORY / "python" / "README.md").read_text()
    first = re.search(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert first
    monkeypatch.chdir(tmp_path)
    exec(first.group(1), {})
    shown = REPOSITORY / "docs" / "pictures" / "python.png"
    assert (tmp_path / "sphere.png").read_bytes() == shown.read_bytes()


def test_counting_of_ids_is_as_described():
    """Pictures count objects from 1, rays from 0."""
    scene = mt.Scene()
    scene.add_sphere()
    prepared = scene.prepare()
    picture = mt.render(prepared, mt.look_at((0, 0, 5), (0, 0, 0)), (9, 9), aovs=["object"])
    hits = prepared.intersect(np.float32([0, 0, 5, 0, 0, -1]))
    assert (picture.object[4, 4], picture.object[0, 0]) == (1, 0)
    assert hits.object == 0
