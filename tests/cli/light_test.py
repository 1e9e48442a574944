#!/usr/bin/env python3
"""Options for light: what is accepted, what is refused with which exit code.

usage: light_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import os
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from program import ProgramTest

SOURCE = Path(sys.argv[2]).resolve()
CUBE = SOURCE / "scenes/gltf/cube.glb"


class Environments(ProgramTest):
    def draw(self, *options):
        return self.run_program(CUBE, "--size", "40x30", "-o", "out.ppm", *options)

    def assert_refused(self, code, fragment, *options):
        result = self.draw(*options)
        self.assertEqual(result.returncode, code, (options, result.stderr))
        self.assertIn(fragment.encode(), result.stderr)
        self.assertFalse((self.folder / "out.ppm").exists())

    def test_flat_pictures_do_not_depend_on_them(self):
        (self.folder / "map.ppm").write_bytes(b"P6\n2 1\n255\n\x80\x01\xff\x02\x00\x7f")
        pictures = set()
        for options in ((), ("--env", "studio"), ("--env", "#ffe0c0"), ("--env", "0,2.5,1e3"),
                        ("--env", "map.ppm", "--env-rotation", "-90", "--env-intensity", "0.5")):
            result = self.draw(*options)
            self.assertEqual((result.returncode, result.stderr), (0, b""), options)
            pictures.add((self.folder / "out.ppm").read_bytes())
        self.assertEqual(len(pictures), 1)

    def test_usage(self):
        for light in ("", "#12345", "#12345g"):
            self.assert_refused(2, "--env", "--env", light)
        for turn in ("x", "nan", "inf", ""):
            self.assert_refused(2, "--env-rotation", "--env", "studio", "--env-rotation", turn)
        for factor in ("x", "nan", "-1", "2e9"):
            self.assert_refused(2, "--env-intensity", "--env", "studio", "--env-intensity", factor)
        for options in (("--env-rotation", "1"), ("--env-intensity", "1"), ("--background", "env")):
            self.assert_refused(2, "name one by --env", *options)

    def test_files(self):
        self.assert_refused(5, "missing.exr", "--env", "missing.exr")
        self.assert_refused(5, "1,2,x", "--env", "1,2,x")
        (self.folder / "text.hdr").write_text("no picture")
        self.assert_refused(5, "can't be decoded", "--env", "text.hdr")
        (self.folder / "wide.ppm").write_text("P6\n70000 1\n255\n")
        self.assert_refused(6, "70000 x 1", "--env", "wide.ppm")
        (self.folder / "square.ppm").write_bytes(b"P6\n1 1\n255\n\x80\x80\x80")
        self.assert_refused(3, "twice as wide as high", "--env", "square.ppm", "--strict")
        result = self.draw("--env", "square.ppm")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"warning: square.ppm: ", result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["out.ppm", "square.ppm", "text.hdr", "wide.ppm"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
