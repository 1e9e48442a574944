#!/usr/bin/env python3
"""Tests the script ci/check_pictures.

usage: check_pictures_test.py PROGRAM SOURCE_FOLDER
"""

import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).absolute()


class CheckPictures(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "assets/a folder").mkdir(parents=True)
        shutil.copy(SOURCE / "scenes/gltf/cube.glb", self.folder / "assets/a folder/it's a \"cube\".glb")
        shutil.copy(SOURCE / "scenes/gltf/materials.glb", self.folder / "assets/materials.glb")

    def check(self, result, *options, code, threshold="0"):
        """Returns the lines of the report."""
        script = [SOURCE / "ci/check_pictures", "assets", "expected", result, "--size", "32x24", "--spp", "2", *options]
        done = subprocess.run(script, cwd=self.folder, capture_output=True, text=True,
                              env={**environment(), "MICROTRACE": PROGRAM, "THRESHOLD": threshold})
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout.splitlines()

    def accept(self, result):
        shutil.copytree(self.folder / result / "pictures", self.folder / "expected", dirs_exist_ok=True)

    def files(self, result):
        return sorted(str(path.relative_to(self.folder / result)) for path in (self.folder / result).rglob("*") if path.is_file())

    def test_pictures_are_new_then_equal_then_different(self):
        names = ["a folder/it's a \"cube\".glb", "materials.glb"]
        self.assertEqual(self.check("new", code=1), [f"is new: {name}" for name in names])
        self.accept("new")
        self.assertEqual(self.check("equal", code=0), ["2 pictures are as expected"])
        self.assertEqual(self.files("equal"), ["report.txt"])
        self.assertEqual(self.check("other", "--seed", "3", code=1), [f"differs: {name}" for name in names])
        self.assertEqual(self.files("other"), sorted([f"{folder}/{name}.png" for folder in ("pictures", "differences") for name in names]
                                                     + [f"differences/{name}.png.txt" for name in names] + ["report.txt"]))
        self.check("tolerant", "--seed", "3", threshold="1", code=0)
        self.accept("other")
        self.check("accepted", "--seed", "3", code=0)

    def test_what_is_missing_or_fails_is_reported(self):
        self.check("new", code=1)
        self.accept("new")
        (self.folder / "assets/materials.glb").rename(self.folder / "assets/renamed.glb")
        (self.folder / "assets/broken.gltf").write_text("{")
        (self.folder / "expected/a folder/it's a \"cube\".glb.png").write_bytes(b"no picture")
        self.assertEqual(self.check("changed", code=1),
                         ["can't be compared, exit code 5: a folder/it's a \"cube\".glb", "fails with exit code 3: broken.gltf",
                          "is new: renamed.glb", "has no asset: materials.glb.png"])

    def test_bad_use(self):
        self.check("one", code=1)
        self.check("one", code=1)  # results are not mixed
        shutil.rmtree(self.folder / "assets")
        self.check("two", code=2)
        (self.folder / "assets").mkdir()
        self.assertEqual(self.check("three", code=1), ["assets has no .gltf and .glb files"])
        self.assertEqual(subprocess.run([SOURCE / "ci/check_pictures"], capture_output=True).returncode, 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
