"""Subinterpreters can't import the package, and don't disturb the main interpreter."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import sys
if sys.version_info >= (3, 13):
    import _interpreters as interpreters
    first = interpreters.create(sys.argv[1])
else:
    import _xxsubinterpreters as interpreters
    first = interpreters.create(isolated=sys.argv[1] == "isolated")

ATTEMPT = '''
try:
    import microtrace
except ImportError as error:
    assert "subinterpreter" in str(error), error
    assert "numpy" not in __import__("sys").modules
else:
    raise AssertionError("was imported")
'''

def query():
    import microtrace as mt
    scene = mt.Scene()
    scene.add_sphere((0, 0, 0), 1)
    assert scene.prepare().occluded([[0, 0, 9, 0, 0, -1]])[0]
    try:
        mt.load("none.glb")
    except FileNotFoundError:
        return
    raise AssertionError("was found")

if sys.argv[2] == "used":
    query()
failure = interpreters.run_string(first, ATTEMPT)
assert failure is None, failure.formatted
query()
interpreters.destroy(first)
query()
print("done")
"""


@pytest.mark.parametrize("use", ["used", "unused"])
@pytest.mark.parametrize("kind", ["legacy", "isolated"])
def test_subinterpreters(kind: str, use: str) -> None:
    command = [sys.executable, "-c", PROGRAM, kind, use]
    run = subprocess.run(command, capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (0, "done\n"), run.stderr
