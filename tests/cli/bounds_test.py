#!/usr/bin/env python3
"""Tests the cost of hostile input: memory must be counted before it is allocated, and nothing may block.

usage: bounds_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import json
import os
import resource
import struct
import subprocess
import sys
import unittest
from functools import partial
from pathlib import Path

import hostile
from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
SMALL = ["-o", "out.ppm", "-q"]


class Bounds(ProgramTest):
    def write(self, name, n):
        return hostile.write(name, n, self.folder)

    def draw(self, path, *options, code=0):
        size = [] if "--size" in options else ["--size", "4x4"]
        result = self.run_program(path, *SMALL, *size, *options)
        said = result.stderr.decode(errors="replace")
        self.assertEqual(result.returncode, code, said)
        self.assertEqual((self.folder / "out.ppm").exists(), code == 0)
        return said

    def counted(self, path, *options):
        """Returns the counted memory in MiB."""
        said = self.draw(path, "--stats=json", *options)
        (self.folder / "out.ppm").unlink()
        return json.loads(said)["counted_memory_mib"]

    def measured(self, path, *options):
        """Returns the exit code, the messages and the peak memory in KiB of one run."""
        process = subprocess.Popen([PROGRAM, str(path), *SMALL, *options], cwd=self.folder, stderr=subprocess.PIPE,
                                   env=environment())
        said = process.stderr.read().decode()
        process.stderr.close()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, said, usage.ru_maxrss

    def test_memory_limit_values(self):
        scene = SOURCE / "scenes/perspective1.json"
        for text in ("1G", "300M", "400000K", "1000000000"):
            self.draw(scene, "--memory-limit", text)
        (self.folder / "out.ppm").unlink()
        for text in ("0", "-1", "1T", "1.5G", "G", "lots", "99999999999G", "1 G", "0x10"):
            said = self.draw(scene, "--memory-limit", text, code=2)
            self.assertIn("--memory-limit", said)

    def test_small_stacks_are_refused(self):
        def run(kibibytes, *arguments, hard=resource.RLIM_INFINITY):
            limits = kibibytes << 10, hard
            return self.run_program(*arguments, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_STACK, limits))

        # Shadow rays of a scene with instances use most.
        words = [SOURCE / "scenes/gltf/moving.glb", *SMALL, "--size", "32x24", "--instances", "share", "--integrator", "path", "--spp", "1"]
        for hard, advice in ((resource.RLIM_INFINITY, b"raise the limit, as by ulimit -s 8192"), (5 << 20, b"raise the limit, as by ulimit -s 5120"),
                             (1023 << 10, b"the hard limit must be raised, which needs privileges")):
            refused = run(1023, *words, hard=hard)
            message = b"error: stacks are limited to 1023 KiB, but microtrace needs 1024 KiB; " + advice + b"\n"
            self.assertEqual((refused.returncode, refused.stderr), (6, message))
        self.assertEqual(run(64, "--help").returncode, 0)
        for threads in ("1", "2"):
            drawn = run(1024, *words, "--threads", threads)
            self.assertEqual((drawn.returncode, drawn.stderr), (0, b""))
        # Commands that trace no rays need less.
        self.assertEqual(run(1024, *words, "--checkpoint", "part").returncode, 0)
        self.assertEqual(run(1024, "dataset", words[0], "--size", "8x6", "-o", "set", "-q").returncode, 0)
        for command in (["merge", "part", "-o", "a.png"], ["compare", "a.png", "a.png"], ["verify", "set", "--redraw", "0"]):
            self.assertEqual(run(512, *command).returncode, 0, command)
        self.assertEqual(run(512, "verify", "set").returncode, 6)

    def test_allocations_beyond_the_limit_are_refused(self):
        limit = 64
        cases = [("zeros", 3 << 24), ("zeros_with_attributes", 3 << 24), ("sparse_zeros", 3 << 24),
                 ("points", 3 << 23), ("instances", 1 << 22), ("pixels", 1 << 26), ("wide_nodes", 1 << 17)]
        for name, n in cases:
            with self.subTest(name):
                path = self.write(name, n)
                code, said, peak = self.measured(path, "--memory-limit", f"{limit}M")
                self.assertEqual(code, 6, said)
                self.assertIn(path.name, said)
                self.assertIn("--memory-limit", said)
                # The margin covers the program itself, but not the additional memory of sanitizers.
                if "ASAN_OPTIONS" not in os.environ:
                    self.assertLess(peak / 1024, 3 * limit + 64)
                self.assertFalse((self.folder / "out.ppm").exists())

    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "sanitizers need memory of their own")
    def test_json_takes_no_more_than_is_counted(self):
        code, said, peak = self.measured(self.write("small_members", 400_000), "--stats=json", "--size", "4x4")
        self.assertEqual(code, 0, said)
        statistics = json.loads([line for line in said.splitlines() if line.startswith("{")][-1])
        self.assertLess(peak / 1024 - 30, statistics["counted_memory_mib"])

    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "sanitizers need memory of their own")
    def test_long_tokens_take_no_more_than_the_limit(self):
        # A beginning, a middle of 1 MiB, which is repeated, and an end.
        cases = [(b"", b"\n", b"x", 3), (b'{"a":"', b"a", b"", 3), (b'{"a":"', b"a", b'"} x', 3), (b"[", b"1", b"]", 6),
                 (b'{"a":"', b"\\n", b'\\q"', 6)]
        limit = 160
        path = self.folder / "long.json"
        for begin, middle, end, expected in cases:
            with self.subTest(begin + middle + end):
                # Not written all at once: measured() counts at least the peak of this process.
                with open(path, "wb") as out:
                    out.write(begin)
                    for _ in range(48):
                        out.write(middle * ((1 << 20) // len(middle)))
                    out.write(end)
                code, said, peak = self.measured(path, "--memory-limit", f"{limit}M")
                self.assertEqual(code, expected, said)
                self.assertIn(path.name, said)
                self.assertLess(peak / 1024, limit)

    def test_pictures_count_against_the_limit(self):
        scene = SOURCE / "scenes/perspective1.json"
        self.draw(scene, "--size", "4000x4000", "--memory-limit", "100M", code=6)
        self.draw(scene, "--integrator", "path", "--spp", "1", "--size", "2000x2000", "--time-limit", "9",
                  "--memory-limit", "300M", code=6)

    def memory_of_each(self, write, few, many, *options):
        """Returns the peak memory in bytes for each item of the scenes that write(number of items) makes."""
        peaks = []
        for n in (few, many):
            code, said, peak = self.measured(write(n), "--integrator", "flat", "--size", "4x4", *options)
            self.assertEqual(code, 0, said)
            peaks.append(peak)
        return (peaks[1] - peaks[0]) * 1024 / (many - few)

    def write_lattice(self, n):
        """Writes instances at different places, of which neighbors are far apart in the file."""
        path = self.write("instances", n)
        asset = json.loads(path.read_text())
        asset["buffers"].append({"byteLength": 12 * n, "uri": "places.bin"})
        asset["bufferViews"].append({"buffer": 1, "byteLength": 12 * n})
        asset["accessors"][1]["bufferView"] = 1
        path.write_text(json.dumps(asset))
        # Not written all at once: measured() counts at least the peak of this process.
        with open(self.folder / "places.bin", "wb") as places:
            for i in range(n):
                place = i * 7919 % n
                places.write(struct.pack("<3f", 2 * (place % 64), 2 * (place // 64 % 64), 2 * (place // 4096)))
        return path

    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "sanitizers need memory of their own")
    def test_many_nodes_take_little_memory(self):
        self.assertLess(self.memory_of_each(partial(self.write, "transformed_nodes"), 10_000, 50_000), 2.5 * 1024)

    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "sanitizers need memory of their own")
    def test_many_instances_take_little_memory(self):
        shared = ("--instances", "share")
        self.assertLess(self.memory_of_each(partial(self.write, "instances"), 50_000, 250_000, *shared), 380)
        self.assertLess(self.memory_of_each(self.write_lattice, 100_000, 500_000, *shared, "--threads", "1"), 330)

    def test_textures_of_one_image_share_its_mip_maps(self):
        one, many = (self.counted(self.write("textures", n), "--integrator", "path", "--spp", "1") for n in (1, 128))
        self.assertLess(many - one, 2)

    def test_cost_is_linear_in_file_size(self):
        for name in hostile.ALL:
            with self.subTest(name):
                if name in ("equal_extensions_used",):
                    continue
                small, large = (self.counted(self.write(name, n), "--integrator", "flat", "--time", "0.5")
                                if name in hostile.GLTF else self.counted(self.write(name, n)) for n in (400, 1600))
                self.assertLess(large - 1, 4.5 * small, f"{small} MiB, {large} MiB")

    def test_only_regular_files_are_read_beside_the_scene(self):
        os.mkfifo(self.folder / "pipe.glb")
        os.mkfifo(self.folder / "pipe.hdr")
        (self.folder / "zero.glb").symlink_to("/dev/zero")
        (self.folder / "zero.hdr").symlink_to("/dev/zero")
        for name in ("pipe", "zero"):
            scene = self.folder / "scene.json"
            scene.write_text(json.dumps(hostile.scene(objects=[{"type": "mesh", "file": f"{name}.glb"}])))
            self.assertIn("is not a regular file", self.draw(scene, "--allow-path", "/dev", code=5))
            scene.write_text(json.dumps(hostile.scene(environment={"type": "map", "file": f"{name}.hdr"})))
            self.assertIn("is not a regular file", self.draw(scene, "--integrator", "path", "--allow-path", "/dev", code=5))
            self.assertIn("is not a regular file",
                          self.draw(SOURCE / "scenes/perspective1.json", "--integrator", "path",
                                    "--env", f"{name}.hdr", code=5))

    def test_the_scene_itself_may_be_a_pipe(self):
        text = (SOURCE / "scenes/perspective1.json").read_bytes()
        result = subprocess.run([PROGRAM, "/dev/stdin", *SMALL], cwd=self.folder, input=text, capture_output=True,
                                env=environment())
        self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
