#!/usr/bin/env python3
"""Tests --denoise by a library that stands for Open Image Denoise (tests/support/fake_oidn.cpp).

usage: denoise_test.py PROGRAM SOURCE_FOLDER LIBRARY [unittest arguments]
"""

import json
import os
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from animation_test import moving_square
from exr import Exr
from program import ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
LIBRARY = os.path.abspath(sys.argv[3])
SCENE = SOURCE / "scenes/perspective1.json"
LIGHT = ["--integrator", "path", "--env", "studio", "--size", "24x16", "--spp", "6"]
NAME = b"Open Image Denoise 2.0.7"


class Denoise(ProgramTest):
    def draw(self, *arguments, code=0, scene=SCENE, library=LIBRARY, mode=""):
        variables = environment(MICROTRACE_OIDN_PATH=library, FAKE_OIDN=mode)
        result = self.run_program(*([scene] if scene else []), *arguments, env=variables)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr.decode()

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def test_picture_and_metadata(self):
        self.draw(*LIGHT, "-o", "noisy.exr", "-q")
        self.draw(*LIGHT, "--denoise", "--aov", "noisy,emission", "--sidecar", "a.json", "-o", "a.exr", "-q")
        noisy, picture = Exr(self.folder / "noisy.exr"), Exr(self.folder / "a.exr")
        self.assertEqual(set(picture.types), {f"{before}{c}" for before in ("", "noisy.", "emission.") for c in "RGB"})
        for c in "RGB":
            self.assertEqual(picture.channels[f"noisy.{c}"], noisy.channels[c])
            self.assertNotEqual(picture.channels[c], noisy.channels[c])
        self.assertEqual(picture.attributes["microtrace:denoiser"], NAME)
        self.assertNotIn("microtrace:denoiser", noisy.attributes)
        self.assertEqual(json.loads(self.bytes_of("a.json"))["denoiser"], NAME.decode())
        self.draw(*LIGHT, "--denoise", "-o", "a.png", "-q")
        self.assertIn(b"microtrace:denoiser\0" + NAME, self.bytes_of("a.png"))
        self.draw(*LIGHT, "--sidecar", "b.json", "-o", "b.png", "-q")
        self.assertNotIn(b"denoiser", self.bytes_of("b.png") + self.bytes_of("b.json"))

    def test_all_ways_to_the_samples_give_the_same_picture(self):
        self.draw(*LIGHT, "--denoise", "-o", "whole.exr", "-q")
        whole = self.bytes_of("whole.exr")
        self.draw(*LIGHT, "--denoise", "-t", "1", "-o", "one.exr", "-q")
        self.assertEqual(self.bytes_of("one.exr"), whole)
        # A noisy picture with a checkpoint, which is then denoised without new samples.
        self.draw(*LIGHT, "--checkpoint", "c", "--progressive", "-o", "part.exr", "-q")
        self.assertNotEqual(self.bytes_of("part.exr"), whole)
        self.draw(*LIGHT, "--checkpoint", "c", "--progressive", "--denoise", "-o", "resumed.exr", "-q")
        self.assertEqual(self.bytes_of("resumed.exr"), whole)
        for shard in "12":
            # Needs no library, because only the merged picture is denoised.
            self.draw(*LIGHT, "--denoise", "--shard", f"{shard}/2", "--checkpoint", shard, library="/missing")
        self.draw("merge", "2", "1", "--denoise", "-o", "merged.exr", "-q", scene=None)
        self.assertEqual(self.bytes_of("merged.exr"), whole)
        self.draw("merge", "2", "1", "--denoise", "-o", "merged.png", "-q", scene=None)
        self.draw(*LIGHT, "--denoise", "-o", "whole.png", "-q")
        self.assertEqual(self.bytes_of("merged.png"), self.bytes_of("whole.png"))
        message = self.draw("merge", "c", "--denoise", "-o", "x.png", scene=None, code=2)
        self.assertIn("--shard", message)

    def test_shards_keep_the_channels_that_were_asked_for(self):
        asked = ["--aov", "depth,denoise_albedo,emission"]
        for shard in "12":
            self.draw(*LIGHT, *asked, "--denoise", "--shard", f"{shard}/2", "--checkpoint", shard)
            self.draw(*LIGHT, "--denoise", "--shard", f"{shard}/2", "--checkpoint", f"bare{shard}")
        self.draw("merge", "1", "--checkpoint", "a", "--partial", "-q", scene=None)
        for options in (["--denoise"], []):
            self.draw(*LIGHT, *asked, *options, "-o", "whole.exr", "-q")
            for parts in ("12", "2a", ["1", "bare2"]):
                self.draw("merge", *parts, *options, "-o", "merged.exr", "-q", scene=None)
                self.assertEqual(self.bytes_of("merged.exr"), self.bytes_of("whole.exr"))
            self.draw(*LIGHT, *options, "-o", "whole.png", "-q")
            self.draw("merge", "bare1", "bare2", *options, "-o", "merged.png", "-q", scene=None)
            self.assertEqual(self.bytes_of("merged.png"), self.bytes_of("whole.png"))

    def test_parts_with_other_channels_keep_the_order_of_colors(self):
        colored = ["--integrator", "path", "--env", "0.9,0.4,0.1", "--background", "env", "--size", "24x16", "--spp", "6"]
        self.draw(*colored, "--denoise", "-o", "whole.exr", "-q")
        whole = Exr(self.folder / "whole.exr")
        self.draw(*colored, "--denoise", "--shard", "1/2", "--checkpoint", "1")
        self.draw(*colored, "--denoise", "--aov", "depth", "--shard", "2/2", "--checkpoint", "2")
        self.draw(*colored, "--shard", "2/2", "--checkpoint", "plain2")
        for parts in ("12", "21", ["1", "plain2"], ["plain2", "1"]):
            self.draw("merge", *parts, "--denoise", "-o", "merged.exr", "-q", scene=None)
            self.draw("merge", *parts, "--checkpoint", "all", "-q", scene=None)
            self.draw("merge", "all", "--denoise", "-o", "again.exr", "-q", scene=None)
            self.assertEqual(self.bytes_of("again.exr"), self.bytes_of("merged.exr"), parts)
            (self.folder / "all").unlink()
            merged = Exr(self.folder / "merged.exr")
            for c in "RGB":
                self.assertEqual(merged.channels[c], whole.channels[c], parts)

    def test_noisy_features(self):
        # The library refuses features that were filtered for a picture whose features have no noise, and vice versa.
        for option in (["--aperture", "0.1", "--focus", "3"], ["--ground"]):
            self.draw(*LIGHT, *option, "--denoise", "-o", "whole.exr", "-q", mode="noisy")
            for shard in "12":
                self.draw(*LIGHT, *option, "--denoise", "--shard", f"{shard}/2", "--checkpoint", shard, library="/missing")
            self.draw("merge", "2", "1", "--denoise", "-o", "merged.exr", "-q", scene=None, mode="noisy")
            self.assertEqual(self.bytes_of("merged.exr"), self.bytes_of("whole.exr"))
            self.draw("merge", "2", "1", "--denoise", "-o", "x.exr", "-q", scene=None, code=1)
            for shard in "12":
                (self.folder / shard).unlink()

    def test_target_error(self):
        # The tiles of the lit object take more samples than those of the background.
        stops = ["--integrator", "path", "--env", "studio", "--size", "48x40", "--spp", "128", "--target-error", "0.1"]
        self.draw(*stops, "--denoise", "--aov", "emission,noisy,samples,denoise_normal", "-o", "a.exr", "-q")
        picture = Exr(self.folder / "a.exr").channels
        self.assertGreater(len({n for row in picture["samples.N"] for n in row}), 1)
        for y, row in enumerate(picture["noisy.R"]):
            for x, value in enumerate(row):
                # Exact, because both are means over the same samples.
                self.assertGreaterEqual(value, picture["emission.R"][y][x] * (1 - 1e-6))

    def test_crop_transparency_and_frames(self):
        self.draw(*LIGHT, "--denoise", "--background", "transparent", "--crop", "4,2,20,14", "-o", "a.exr", "-q")
        self.draw(*LIGHT, "--background", "transparent", "--crop", "4,2,20,14", "-o", "b.exr", "-q")
        a, b = Exr(self.folder / "a.exr"), Exr(self.folder / "b.exr")
        self.assertEqual(a.channels["A"], b.channels["A"])
        self.assertNotEqual(a.channels["R"], b.channels["R"])
        self.assertEqual(a.data_window, (4, 2, 20, 14))
        (self.folder / "moving.gltf").write_text(moving_square())
        self.draw(*LIGHT, "--denoise", "--frames", "0:1", "--fps", "2", "-o", "f%d.png", "-q", scene="moving.gltf")
        for frame in "01":
            self.assertIn(NAME, self.bytes_of(f"f{frame}.png"))

    def test_datasets(self):
        self.draw("dataset", SCENE, *LIGHT, "--denoise", "--views", "orbit:2", "-o", "set", "-q", scene=None)
        names = sorted(p.name for p in (self.folder / "set").glob("*.png"))
        self.assertEqual(len(names), 2)
        for name in names:
            self.assertIn(NAME, self.bytes_of(f"set/{name}"))
        self.assertIn(NAME, self.bytes_of("set/dataset.json"))
        self.draw("verify", "set", "-q", scene=None)
        message = self.draw("verify", "set", "-q", scene=None, library="/missing", code=4)
        self.assertIn("MICROTRACE_OIDN_PATH", message)

    def test_refusals_come_before_rendering(self):
        for integrator in ("flat", "depth"):
            message = self.draw("--integrator", integrator, "--denoise", "-o", "a.png", code=2)
            self.assertIn("--denoise needs path tracing", message)
            self.assertIn("--integrator path", message)
        long = ["--integrator", "path", "--size", "4000x4000", "--spp", "65536", "--denoise", "--max-time", "100", "-o", "a.png"]
        message = self.draw(*long, library="/missing/folder", code=4)
        self.assertIn("/missing/folder", message)
        self.assertIn("pip install --no-deps --target ~/oidn pyoidn", message)
        self.assertIn("MICROTRACE_OIDN_PATH=~/oidn/pyoidn/oidn/lib", message)
        self.assertEqual(os.listdir(self.folder), [])

    def test_failures_keep_the_samples(self):
        variables = environment(MICROTRACE_OIDN_PATH=LIBRARY, FAKE_OIDN="broken")
        result = self.run_program(SCENE, *LIGHT, "--denoise", "--checkpoint", "c", "-o", "a.png", env=variables)
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"made up for a test", result.stderr)
        self.assertEqual(os.listdir(self.folder), ["c"])
        self.draw(*LIGHT, "--denoise", "-o", "whole.png", "-q")
        self.draw(*LIGHT, "--denoise", "--checkpoint", "c", "-o", "a.png", "-q")
        self.assertEqual(self.bytes_of("a.png"), self.bytes_of("whole.png"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
