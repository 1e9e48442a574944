#!/usr/bin/env python3
"""Tests that shards of pictures with channels and of sequences join to the bytes of one run.

usage: shards_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import itertools
import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path
from random import Random

sys.dont_write_bytecode = True
from animation_test import moving_square
from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
SCENE = SOURCE / "scenes/perspective1.json"
LIGHT = ["--integrator", "path", "--env", "studio", "--size", "32x20"]
CHANNELS = ["--aov", "normal,id,depth,samples,variance,denoise_albedo"]


class Shards(ProgramTest):
    def run_with(self, *arguments, code=0):
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, code, (arguments, result.stderr))
        return result.stderr.decode(errors="replace")

    def render(self, *arguments, code=0, scene=SCENE):
        return self.run_with(scene, *LIGHT, *arguments, code=code)

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def merge(self, parts, name):
        """Merges parts that are names of checkpoints, or lists of parts. Returns the name of the checkpoint."""
        names = [self.merge(part, f"{name}{i}") if isinstance(part, list) else part for i, part in enumerate(parts)]
        self.run_with("merge", *names, "--checkpoint", name, "--partial", "-q")
        return name

    def shards(self, count, *arguments):
        for shard in range(1, count + 1):
            self.render("--shard", f"{shard}/{count}", "--checkpoint", "abc"[shard - 1], *arguments)

    def test_channels_are_those_of_one_run(self):
        self.render("--spp", "20", *CHANNELS, "-o", "whole.exr")
        self.shards(3, "--spp", "20", *CHANNELS)
        self.assertFalse((self.folder / ".json").exists())
        self.run_with("merge", "c", "a", "b", "-o", "merged.exr")
        self.assertEqual(self.bytes_of("merged.exr"), self.bytes_of("whole.exr"))
        message = self.run_with("merge", "a", "b", "c", "-o", "merged.png", code=2)
        self.assertIn("merged.png: ", message)
        # Two of three parts, with the channels that depend on their samples.
        self.run_with("merge", "a", "b", "-o", "part.exr", "--partial")
        self.assertNotEqual(self.bytes_of("part.exr"), self.bytes_of("whole.exr"))

    def test_merging_is_associative_and_commutative(self):
        def check(count):
            self.merge(["a", "b", "c"], "all")
            groupings = [list(order) for order in itertools.permutations("abc")]
            groupings += [[[x, y], z] for x, y, z in groupings] + [[x, [y, z]] for x, y, z in groupings]
            self.assertEqual(len(groupings), count)
            for number, grouping in enumerate(groupings):
                self.merge(grouping, f"m{number}-")
                self.assertEqual(self.bytes_of(f"m{number}-"), self.bytes_of("all"), grouping)

        self.shards(3, "--spp", "10", *CHANNELS)
        check(18)
        # Differences that don't change samples.
        (self.folder / "a").unlink()
        self.render("--spp", "10", "--shard", "1/3", "--checkpoint", "a", "--exposure", "1", "--aov", "depth,normal")
        (self.folder / "c").unlink()
        self.render("--spp", "10", "--shard", "3/3", "--checkpoint", "c", "--exposure", "2")
        check(18)
        self.render("--spp", "10", "--exposure", "1", "--aov", "denoise_albedo,depth,id,normal,samples,variance", "-o", "one.exr")
        self.run_with("merge", "c", "b", "a", "-o", "merged.exr")
        self.assertEqual(self.bytes_of("merged.exr"), self.bytes_of("one.exr"))

    def test_channels_are_those_of_the_most_samples(self):
        self.render("--spp", "8", "--shard", "1/1", "--checkpoint", "few", "--aov", "denoise_albedo")
        self.render("--spp", "16", "--shard", "2/2", "--checkpoint", "more", "--aov", "denoise_albedo")
        self.render("--spp", "16", "--aov", "denoise_albedo", "-o", "whole.exr")
        for names in (["few", "more"], ["more", "few"]):
            self.run_with("merge", *names, "-o", "merged.exr")
            self.assertEqual(self.bytes_of("merged.exr"), self.bytes_of("whole.exr"))

    def frames(self, *arguments, code=0):
        (self.folder / "moving.gltf").write_text(moving_square())
        return self.run_with("moving.gltf", *LIGHT, "--frames", "0:3", "--fps", "2", "--spp", "6", *arguments, code=code)

    def whole_frames(self, *arguments):
        self.frames(*arguments, "-o", "whole%d.exr")
        return [self.bytes_of(f"whole{frame}.exr") for frame in range(4)]

    def test_shards_of_sequences(self):
        whole = self.whole_frames(*CHANNELS)
        self.assertEqual(len(set(whole)), 4)
        for shard in (1, 2):
            self.frames("--shard", f"{shard}/2", "--checkpoint", f"{shard}_%02d", *CHANNELS)
        self.assertTrue((self.folder / "2_03").exists())
        self.run_with("merge", "2_%02d", "1_%02d", "--frames", "0:3", "-o", "merged%d.exr", "--checkpoint", "m%d")
        self.run_with("merge", "m3", "-o", "again3.exr")
        self.frames("--resume", "2_%02d", "--resume", "1_%02d", *CHANNELS, "-o", "resumed%d.exr")
        for frame, content in enumerate(whole):
            self.assertEqual(self.bytes_of(f"merged{frame}.exr"), content)
            self.assertEqual(self.bytes_of(f"resumed{frame}.exr"), content)
        self.assertEqual(self.bytes_of("again3.exr"), whole[3])
        # Parts that are missing, doubled or belong to another picture.
        options = ["--frames", "0:3", "-o", "x%d.exr"]
        self.assertIn("samples 3 to 5 of 6 are missing", self.run_with("merge", "1_%02d", *options, code=2))
        self.assertIn("already present", self.run_with("merge", "1_%02d", "m%d", *options, code=2))
        self.assertIn("2_02: holds samples of another picture than 1_01: made with frame 2, not with frame 1",
                      self.run_with("merge", "1_01", "2_02", "-o", "x.exr", code=2))
        self.assertIn("must contain the frame number", self.run_with("merge", "1_01", *options, code=2))
        (self.folder / "2_02").unlink()
        for frame in (1, 2):
            (self.folder / f"{frame}_01").unlink()
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("x")], [])
        self.assertIn("1_01: can't be opened", self.run_with("merge", "1_%02d", "2_%02d", *options, code=5))
        (self.folder / "x0.exr").unlink()
        message = self.run_with("merge", "1_%02d", "2_%02d", *options, "--partial")
        for name in ("1_01", "2_01", "2_02"):
            self.assertIn(f"{name} is missing", message)
        self.assertEqual({name for name in os.listdir(self.folder) if name.startswith("x")}, {"x0.exr", "x2.exr", "x3.exr"})
        self.assertEqual(self.bytes_of("x3.exr"), whole[3])
        self.assertIn("none of the checkpoints exists", self.run_with("merge", "3_%02d", *options, "--partial", code=5))

    def test_files_of_frames_stay_apart(self):
        for arguments in (["--checkpoint", "x%d.exr", "-o", "x%d.exr"], ["--resume", "x%d.exr", "-o", "x%d.exr"],
                          ["--checkpoint", "x1%d", "--resume", "x%d", "-o", "a%d.exr", "--frames", "0:11"],
                          ["--checkpoint", "c", "-o", "a%d.exr"], ["--resume", "c", "-o", "a%d.exr"]):
            frames = ["--frames", "0:3"] if "--frames" not in arguments else []
            self.render(*frames, *arguments, code=2)
            self.assertEqual(os.listdir(self.folder), [])

    def test_ended_sequences_continue(self):
        options = ["--spp", "200", "--size", "64x48"]
        (self.folder / "moving.gltf").write_text(moving_square())
        start = ["moving.gltf", *LIGHT[:-2], *options, "--frames", "0:5"]
        begin = time.monotonic()
        self.run_with(*start, "-o", "whole%d.exr", "--aov", "depth")
        seconds = time.monotonic() - begin
        random, ended = Random(3), 0
        command = [PROGRAM, *start, "--checkpoint", "c%d", "--save-every", "0", "--shard", "1/1", "--aov", "depth"]
        for turn in range(30):
            process = subprocess.Popen(command, cwd=self.folder, env=environment(), stderr=subprocess.DEVNULL)
            time.sleep(random.uniform(0, seconds / 3))
            process.send_signal(random.choice([signal.SIGTERM, signal.SIGKILL]))
            code = process.wait(timeout=60)
            self.assertIn(code, (0, 143, -signal.SIGTERM, -signal.SIGKILL))
            ended += code != 0
            if code == 0:
                break
        self.assertGreater(ended, 0)
        self.run_with(*command[1:])
        self.run_with("merge", "c%d", "--frames", "0:5", "-o", "a%d.exr")
        for frame in range(6):
            self.assertEqual(self.bytes_of(f"a{frame}.exr"), self.bytes_of(f"whole{frame}.exr"))
        kept = {"moving.gltf", *(f"{name}{frame}{end}" for frame in range(6) for name, end in
                                 (("c", ""), ("a", ".exr"), ("whole", ".exr")))}
        left = set(os.listdir(self.folder)) - kept
        # A killed process can't remove its unfinished files.
        self.assertTrue(all(name.startswith(".microtrace-") for name in left), left)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
