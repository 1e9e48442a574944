"""Tests the package of the sources, from which pip can build."""

from __future__ import annotations

import subprocess
import sys
import tarfile

from conftest import SCENES

ROOT = SCENES.parent


def test_it_has_all_sources(tmp_path):
    command = "import scikit_build_core.build as b, sys; print(b.build_sdist(sys.argv[1]))"
    words = [sys.executable, "-c", command, str(tmp_path)]
    output = subprocess.run(words, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    with tarfile.open(tmp_path / output.split()[-1]) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    folders = ("cmake", "include", "src", "third_party", "python/microtrace", "python/src")
    needed = {
        str(path.relative_to(ROOT))
        for folder in folders
        for path in (ROOT / folder).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    assert len(needed) > 1000
    assert needed <= names, sorted(needed - names)[:9]
    assert {"CMakeLists.txt", "CMakePresets.json", "LICENSE", "pyproject.toml"} <= names
