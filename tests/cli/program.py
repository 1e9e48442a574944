"""Runs the program under test, whose path is the first argument of every script in this folder."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.path.abspath(sys.argv[1])


def environment(**variables):
    # Leaks are ignored, because libraries keep memory until the program ends.
    return dict(os.environ, ASAN_OPTIONS="detect_leaks=0", **variables)


class ProgramTest(unittest.TestCase):
    """Runs the program in an empty folder for each test."""

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def run_program(self, *arguments, **options):
        options = {"cwd": self.folder, "env": environment(), **options}
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, **options)

    def picture(self, *arguments):
        """Returns width, height and rows of pixels of the binary PPM that the program writes."""
        result = self.run_program(*arguments, "-o", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        magic, size, maximum, pixels = result.stdout.split(b"\n", 3)
        self.assertEqual((magic, maximum), (b"P6", b"255"))
        width, height = map(int, size.split())
        self.assertEqual(len(pixels), 3 * width * height)
        return width, height, [pixels[3 * width * y:3 * width * (y + 1)] for y in range(height)]
