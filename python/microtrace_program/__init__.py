"""The command `microtrace`: replaces this process with the program of the package microtrace.

A package of its own, so that the command does not import NumPy.
"""

import os
import sys
from importlib.util import find_spec
from pathlib import Path


def main() -> None:
    """Runs the program with this process's arguments."""
    package = find_spec("microtrace")
    if package is None or package.origin is None:
        sys.exit("microtrace: the package microtrace is not installed")
    program = Path(package.origin).parent / "bin" / "microtrace"
    os.execv(program, ["microtrace", *sys.argv[1:]])
