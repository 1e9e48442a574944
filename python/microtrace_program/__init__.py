"""The command `microtrace`. It runs the program, which is part of the package's extension module.

This is a separate package, so that the command doesn't import NumPy.
"""

import ctypes
import os
import signal
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from importlib.util import find_spec
from pathlib import Path


def _library() -> Path:
    package = find_spec("microtrace")
    for folder in (package.submodule_search_locations or []) if package else []:
        for suffix in EXTENSION_SUFFIXES:
            path = Path(folder) / f"_core{suffix}"
            if path.exists():
                return path
    sys.exit("microtrace: the package microtrace is not installed completely")


def find_denoiser() -> None:
    """Tells the library where the package pyoidn has Open Image Denoise, if it is installed."""
    if os.environ.get("MICROTRACE_OIDN_PATH"):
        return
    package = find_spec("pyoidn")
    for folder in (package.submodule_search_locations or []) if package else []:
        os.environ["MICROTRACE_OIDN_PATH"] = str(Path(folder) / "oidn" / "lib")


def main() -> None:
    """Runs the program with this process's arguments."""
    for number in (signal.SIGINT, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)  # the program has its own handlers
    if "--denoise" in sys.argv or sys.argv[1:2] == ["view"]:
        find_denoiser()
    arguments = [b"microtrace", *(os.fsencode(a) for a in sys.argv[1:])]
    program = ctypes.CDLL(str(_library())).microtrace_program
    code = program(len(arguments), (ctypes.c_char_p * (len(arguments) + 1))(*arguments))
    sys.exit(code)
