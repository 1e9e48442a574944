#!/usr/bin/env python3
"""Tests that several threads render the same pictures as one thread, for each integrator and kind of run. Under the thread
sanitizer, a data race ends the program with exit code 66. With MICROTRACE_ONLY_RACES, pictures are compared with those of
two threads, because renderings by one thread take a third of the time and have no races.

usage: threads_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import os
import sys
import unittest
from pathlib import Path

from program import PROGRAM, ProgramTest

SCENES = Path(sys.argv[2]).resolve() / "scenes"
JSON, GLTF = SCENES / "perspective1.json", SCENES / "gltf/materials.glb"
THREADS = (2, 7)
LEAST = 2 if "MICROTRACE_ONLY_RACES" in os.environ else 1
FLAT = ["--integrator", "flat", "--size", "160x120"]
LIT = ["--integrator", "path", "--env", "studio", "--size", "72x48", "--spp", "6"]


class Threads(ProgramTest):
    def draw(self, scene, *arguments, threads, output="a.ppm"):
        (self.folder / output).unlink(missing_ok=True)
        result = self.run_program(scene, *arguments, "-t", threads, "-o", output)
        self.assertEqual(result.returncode, 0, result.stderr.decode(errors="replace"))
        return (self.folder / output).read_bytes()

    def assert_same(self, scene, *arguments):
        whole = self.draw(scene, *arguments, threads=LEAST)
        for threads in THREADS[LEAST - 1:]:
            self.assertEqual(self.draw(scene, *arguments, threads=threads), whole, (scene, arguments, threads))
        return whole

    def test_flat(self):
        for scene in (JSON, GLTF, SCENES / "gltf/textures.glb", SCENES / "gltf/knot.glb"):
            self.assert_same(scene, *FLAT)
        self.assert_same(JSON, *FLAT, "--spp", "5", "--filter", "blackman-harris")
        self.assert_same(GLTF, *FLAT[2:], "--integrator", "normal")

    def test_path(self):
        for scene in (JSON, GLTF, SCENES / "gltf/knot.glb"):
            self.assert_same(scene, *LIT)

    def test_options_with_tables_of_their_own(self):
        small = [*LIT[:4], "--size", "40x30", "--spp", "3"]
        for scene, *options in ((GLTF, "--guiding"), (GLTF, "--ground"), (GLTF, "--view", "front", "--aperture", "0.1", "--focus", "3"),
                                (SCENES / "gltf/moving.glb", "--shutter", "0:0.5"), (GLTF, "--instances", "share"),
                                (SCENES / "gltf/lamps.glb", "--exposure", "auto")):
            self.assert_same(scene, *small, *options)

    def test_data_sets(self):
        sets = []
        for threads in dict.fromkeys((LEAST, *THREADS)):
            result = self.run_program("dataset", GLTF, "-o", f"set{threads}", "--views", "orbit:2", "--size", "40x30", "--spp", "2",
                                      "--formats", "png,coco", "--amodal", "-t", threads)
            self.assertEqual(result.returncode, 0, result.stderr)
            folder = self.folder / f"set{threads}"
            sets.append({path.name: path.read_bytes() for path in folder.rglob("*") if path.is_file()})
        self.assertIn("coco.json", sets[0])
        self.assertEqual(sets[1:], sets[:1] * (len(sets) - 1))

    def test_passes(self):
        whole = self.assert_same(GLTF, *LIT)
        for threads in THREADS:
            for options in (["--checkpoint", "c"], ["--progressive", "--save-every", "0"]):
                self.assertEqual(self.draw(GLTF, *LIT, *options, threads=threads), whole, (threads, options))
            (self.folder / "c").unlink()
        self.assert_same(GLTF, *LIT[:-1], "64", "--target-error", "0.1")

    def test_resuming_a_checkpoint(self):
        for threads in THREADS:
            self.draw(GLTF, *LIT[:-1], "2", "--checkpoint", "c", threads=threads)
            gone_on = self.draw(GLTF, *LIT, "--resume", "c", threads=threads)
            self.assertEqual(gone_on, self.draw(GLTF, *LIT, threads=threads), threads)
            (self.folder / "c").unlink()

    def test_shards(self):
        names = []
        for shard, threads in ((1, 2), (2, 7), (3, 2)):
            names.append(f"c{shard}")
            result = self.run_program(GLTF, *LIT, "--shard", f"{shard}/3", "--checkpoint", names[-1], "-t", threads)
            self.assertEqual(result.returncode, 0, result.stderr)
        result = self.run_program("merge", *names, "-o", "merged.ppm")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "merged.ppm").read_bytes(), self.draw(GLTF, *LIT, threads=LEAST))

    def test_frames(self):
        pictures = []
        for threads in dict.fromkeys((LEAST, *THREADS)):
            result = self.run_program(SCENES / "gltf/moving.glb", *LIT, "--frames", "0:2", "--fps", "2", "-t", threads,
                                      "-o", "%d.ppm")
            self.assertEqual(result.returncode, 0, result.stderr)
            pictures.append([(self.folder / f"{k}.ppm").read_bytes() for k in range(3)])
        self.assertEqual(pictures[1:], pictures[:1] * (len(pictures) - 1))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
