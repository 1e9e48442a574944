"""The program under test: the first argument of every script here."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.path.abspath(sys.argv[1])


def environment(**variables):
    # Of a sanitizer's findings leaks do not count: libraries keep memory to the end.
    return dict(os.environ, ASAN_OPTIONS="detect_leaks=0", **variables)


class ProgramTest(unittest.TestCase):
    """Has an empty folder for each test, in which the program runs."""

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def run_program(self, *arguments, **options):
        options = {"cwd": self.folder, "timeout": 60, "env": environment(), **options}
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, **options)
