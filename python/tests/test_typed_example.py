"""Runs the example that mypy checks."""

from __future__ import annotations

import microtrace as mt
import typed_example
from conftest import SCENES


def test_typed_example(tmp_path):
    prepared = typed_example.build().prepare()
    assert typed_example.trace(prepared) == 3
    assert typed_example.render(prepared, tmp_path / "view.png").shape == (3, 8, 8)
    assert (tmp_path / "view.png").exists()
    assert typed_example.replaced() == (2, 2)
    assert isinstance(typed_example.load(SCENES / "sphere.json"), mt.Scene)
    assert isinstance(typed_example.load(tmp_path / "none.glb"), str)
