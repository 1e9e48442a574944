"""How the package is imported, in processes of their own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import microtrace as mt


def run(program: str, **environment: str) -> str:
    """Runs a program and returns its output."""
    paths = os.pathsep.join([str(Path(mt.__file__).parent.parent), *sys.path])
    env = {**os.environ, "PYTHONPATH": paths, **environment}
    result = subprocess.run([sys.executable, "-B", "-c", program], capture_output=True, env=env)
    assert (result.returncode, result.stderr) == (0, b""), result.stderr.decode(errors="replace")
    return result.stdout.decode()


def test_a_removed_module_is_not_imported_again():
    program = """
import sys, numpy
from unittest import mock
with mock.patch.dict("sys.modules"):
    import microtrace as first
try:
    import microtrace
except ImportError as error:
    print(error)
"""
    assert "can't be imported again" in run(program)


def test_paths_are_those_of_the_host():
    """The encoding of paths need not be UTF-8."""
    program = """
import os, microtrace as mt
for name in (b"\\xe4.json", b"\\xe6\\x97\\xa5.json"):
    try:
        mt.load(os.fsdecode(name))
    except mt.FileError as error:
        print(error.filename == os.fsdecode(name), os.fsencode(error.filename) == name)
"""
    for locale in ("C", "C.UTF-8"):
        assert (
            run(program, LC_ALL=locale, PYTHONUTF8="0", PYTHONCOERCECLOCALE="0")
            == "True True\n" * 2
        )
