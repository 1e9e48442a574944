#!/usr/bin/env python3
"""Tests checkpoints, interruptions, shards, time limits and target errors.

usage: samples_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path
from random import Random

from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
SCENE = SOURCE / "scenes/perspective1.json"
LIGHT = ["--integrator", "path", "--env", "studio", "--size", "32x20"]


class Samples(ProgramTest):
    def render(self, *arguments, code=0, scene=SCENE):
        result = self.run_program(scene, *LIGHT, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr.decode(errors="replace")

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def whole(self, *arguments):
        self.render("-o", "whole.ppm", *arguments)
        return self.bytes_of("whole.ppm")

    def test_seed_changes_the_noise_and_threads_change_nothing(self):
        pictures = [self.whole("--spp", "3", "--seed", seed, "-t", threads)
                    for seed, threads in ((1, 1), (1, 3), (2, 2))]
        self.assertEqual(pictures[0], pictures[1])
        self.assertNotEqual(pictures[0], pictures[2])

    def test_qualities_name_samples_and_errors(self):
        for quality, options in ((["draft"], ["--spp", "16"]),
                                 (["good", "--spp", "40"], ["--spp", "40", "--target-error", "0.03"]),
                                 (["good", "--target-error", "0.5"], ["--spp", "256", "--target-error", "0.5"]),
                                 (["final", "--spp", "40"], ["--spp", "40", "--target-error", "0.01"])):
            self.assertEqual(self.whole("--quality", *quality), self.whole(*options), quality)
        self.assertIn("256 samples each", self.render("--quality", "good", "-o", "a.ppm"))
        self.render("--quality", "good", "--spp", "4", "--shard", "1/2", "--checkpoint", "a")
        self.render("--quality", "good", "--spp", "4", "--shard", "2/2", "--checkpoint", "b")
        self.run_program("merge", "a", "b", "-o", "merged.ppm")
        self.assertEqual(self.bytes_of("merged.ppm"), self.whole("--spp", "4"))

    def test_refused_qualities(self):
        for name in ("best", "Good"):
            self.assertIn("draft, good or final", self.render("-o", "a.ppm", "--quality", name, code=2))
        result = self.run_program(SCENE, "--integrator", "flat", "--quality", "good", "-o", "a.ppm")
        self.assertEqual(result.returncode, 2)
        self.assertIn(b"--quality needs path tracing; use --integrator path", result.stderr)
        for option in (["--aperture", "0.1", "--focus", "3"], ["--max-depth", "3"], ["--backfaces", "occlude"]):
            for integrator in ("flat", "depth"):
                result = self.run_program(SCENE, "--size", "8x6", "--integrator", integrator, *option, "-o", "a.ppm")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(f"{option[0]} needs path tracing".encode(), result.stderr)
                self.assertFalse((self.folder / "a.ppm").exists())
        self.assertFalse((self.folder / "a.ppm").exists())

    def test_rendering_continues_from_checkpoints(self):
        whole = self.whole("--spp", "37")
        self.render("-o", "a.ppm", "--spp", "5", "--checkpoint", "c")
        self.render("-o", "b.ppm", "--spp", "20", "--checkpoint", "c", "-t", "3")
        self.render("-o", "d.ppm", "--spp", "37", "--resume", "c")
        self.assertEqual(self.bytes_of("d.ppm"), whole)
        self.assertEqual(self.bytes_of("a.ppm"), self.whole("--spp", "5"))
        self.assertEqual(self.bytes_of("b.ppm"), self.whole("--spp", "20"))
        # All samples are in the checkpoint, so nothing remains to be rendered.
        self.render("-o", "d.ppm", "--spp", "20", "--checkpoint", "c", "--resume", "c")
        self.assertEqual(self.bytes_of("d.ppm"), self.bytes_of("b.ppm"))

    def test_killed_runs_keep_saved_samples(self):
        options = ["--spp", "3000"]
        arguments = [SCENE, *LIGHT, *options, "-o", "out.ppm", "--checkpoint", "c", "--save-every", "0"]
        kills = 0
        for _ in range(3):
            process = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, env=environment())
            before = self.folder.joinpath("c").stat().st_mtime_ns if (self.folder / "c").exists() else 0
            while process.poll() is None:
                path = self.folder / "c"
                if path.exists() and path.stat().st_mtime_ns != before:
                    break
                time.sleep(0.002)
            process.send_signal(signal.SIGKILL)
            kills += process.wait() == -signal.SIGKILL
            self.assertTrue((self.folder / "c").exists())
        self.assertGreater(kills, 0, "the program was always done before it was killed")
        self.assertFalse((self.folder / "out.ppm").exists())
        stats = self.render(*options, "-o", "out.ppm", "--checkpoint", "c", "--stats=json")
        stats = json.loads(stats)
        self.assertEqual(stats["samples_per_pixel"], 3000)
        self.assertLess(stats["rays"], 3000 * 32 * 20)
        self.assertEqual(self.bytes_of("out.ppm"), self.whole(*options))

    def test_terminated_runs_save_their_samples(self):
        whole = self.whole("--spp", "3000")
        arguments = [SCENE, *LIGHT, "--spp", "3000", "-o", "out.ppm", "--checkpoint", "c"]
        saved, random = 0, Random(5)
        for _ in range(20):
            process = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, env=environment(),
                                       stderr=subprocess.PIPE)
            time.sleep(random.uniform(0, 0.3))
            process.send_signal(random.choice([signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGXCPU]))
            _, message = process.communicate(timeout=60)
            if process.returncode == 0:
                break
            # An early signal ends the program before it has installed its handlers, or at once.
            self.assertIn(process.returncode, [sign * number for sign, base in ((1, 128), (-1, 0)) for number in
                                               (base + signal.SIGTERM, base + signal.SIGINT, base + signal.SIGHUP, base + signal.SIGXCPU)])
            if message.endswith(b"interrupted: the samples are saved in c\n"):
                saved += 1
                self.assertTrue((self.folder / "c").exists())
            self.assertLessEqual(set(os.listdir(self.folder)), {"c", "whole.ppm"})
        self.assertGreater(saved, 0)
        self.render(*map(str, arguments[1 + len(LIGHT):]))
        self.assertEqual(self.bytes_of("out.ppm"), whole)

    def test_runs_end_with_their_parent(self):
        arguments = [SCENE, *LIGHT, "--spp", "65536", "--shard", "1/2", "--checkpoint", "c", "--save-every", "1000"]
        child = [PROGRAM, *map(str, arguments)]
        code = ("import subprocess, sys, threading, time\n"
                "def start(): print(subprocess.Popen(sys.argv[1:]).pid, flush=True)\n"
                "thread = threading.Thread(target=start); thread.start(); thread.join(); time.sleep(100)")
        parent = subprocess.Popen([sys.executable, "-c", code, *child, "--end-with-parent", "-q"], cwd=self.folder,
                                  env=environment(), stdout=subprocess.PIPE)
        pid = int(parent.stdout.readline())
        time.sleep(0.5)
        os.kill(pid, 0)  # The end of the thread that started the run doesn't end the run.
        parent.kill()
        # The run holds the other end of the pipe until it ends.
        parent.communicate(timeout=60)
        self.assertEqual(os.listdir(self.folder), ["c"])
        other = self.run_program(*child[1:], f"--end-with-parent={os.getpid() + 1}")
        self.assertEqual(other.returncode, 143)
        result = self.run_program(SCENE, *LIGHT, "--spp", "1", "-o", "a.ppm", f"--end-with-parent={os.getpid()}")
        self.assertEqual(result.returncode, 0, result.stderr)

    def interrupted(self, interrupt, parent=None):
        """Starts a run that takes long to save its samples, calls interrupt(process id) after the first save, and checks
        that the samples are saved once more."""
        command = [PROGRAM, SCENE, *LIGHT[:-1], "1000x1000", "--spp", "65536", "-o", "out.ppm", "--checkpoint", "c",
                   "--save-every", "0", *(["--end-with-parent"] if parent else [])]
        process = subprocess.Popen([*(parent or []), *map(str, command)], cwd=self.folder, env=environment(),
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        pid = int(process.stdout.readline()) if parent else process.pid
        while not (self.folder / "c").exists() and process.poll() is None:
            time.sleep(0.01)
        interrupt(pid)
        if parent:
            process.kill()
        _, message = process.communicate(timeout=120)
        self.assertTrue(message.endswith(b"interrupted: the samples are saved in c\n"), message)
        self.assertEqual(os.listdir(self.folder), ["c"])
        (self.folder / "c").unlink()
        return process.returncode

    def test_repeated_notice_of_the_time_limit_does_not_end_the_run_at_once(self):
        def interrupt(pid):
            for _ in range(20):
                time.sleep(0.005)
                os.kill(pid, signal.SIGXCPU)

        self.assertEqual(self.interrupted(interrupt), 128 + signal.SIGXCPU)

    def test_one_request_may_arrive_as_two_signals(self):
        # timeout(1) signals its child and then the child's group.
        def interrupt(pid):
            for _ in range(20):
                os.kill(pid, signal.SIGTERM)
                time.sleep(0.005)

        self.assertEqual(self.interrupted(interrupt), 128 + signal.SIGTERM)

    def test_runs_save_their_samples_when_the_terminal_is_closed(self):
        # The kernel and the shell both signal the program.
        def interrupt(pid):
            os.kill(pid, signal.SIGHUP)
            os.kill(pid, signal.SIGHUP)

        self.assertEqual(self.interrupted(interrupt), 128 + signal.SIGHUP)

    def test_runs_whose_whole_group_is_interrupted_save_their_samples(self):
        code = "import subprocess, sys; p = subprocess.Popen(sys.argv[1:]); print(p.pid, flush=True); p.wait()"
        self.interrupted(lambda pid: os.kill(pid, signal.SIGINT), parent=[sys.executable, "-c", code])

    def test_merges_in_any_order_and_grouping(self):
        whole = self.whole("--spp", "20")
        for shard in range(1, 6):
            self.render("--spp", "20", "--shard", f"{shard}/5", "--checkpoint", f"p{shard}")

        def merge(*arguments, code=0):
            result = self.run_program("merge", *arguments)
            self.assertEqual(result.returncode, code, result.stderr)
            return result.stderr

        merge("p1", "p2", "p3", "p4", "p5", "--checkpoint", "all")
        random = Random(7)
        for _ in range(5):
            parts = [f"p{i}" for i in range(1, 6)]
            for step in range(4):
                random.shuffle(parts)
                name = f"m{step}"
                merge(parts.pop(), parts.pop(), "--checkpoint", name, "--partial", "-q")
                parts.append(name)
            self.assertEqual(self.bytes_of(parts[0]), self.bytes_of("all"))
        merge("all", "-o", "out.ppm", "--checkpoint", "again")
        self.assertEqual(self.bytes_of("out.ppm"), whole)
        self.assertEqual(self.bytes_of("again"), self.bytes_of("all"))
        self.assertIn(b"all: holds samples 0 to 19, some of", merge("p2", "all", "--checkpoint", "x", code=2))
        self.assertIn(b"are missing", merge("p1", "p3", "--checkpoint", "x", code=2))
        self.assertIn(b"would overwrite", merge("p1", "p3", "--checkpoint", "p3", "--partial", code=2))
        merge("p1", code=2)
        self.assertFalse((self.folder / "x").exists())
        # A rendering that continues from all shards draws the channels of one run.
        parts = [word for i in (4, 2, 5, 1, 3) for word in ("--resume", f"p{i}")]
        self.render("--spp", "20", *parts, "--aov", "depth,normal,id", "-o", "a.exr")
        self.render("--spp", "20", "--aov", "depth,normal,id", "-o", "b.exr")
        self.assertEqual(self.bytes_of("a.exr"), self.bytes_of("b.exr"))

    def test_interrupted_runs_leave_complete_files(self):
        process = subprocess.Popen(
            [PROGRAM, SCENE, *LIGHT, "--spp", "65536", "-o", "out.ppm", "--checkpoint", "c", "--progressive",
             "--save-every", "0"], cwd=self.folder, env=environment())
        while not (self.folder / "out.ppm").exists() and process.poll() is None:
            time.sleep(0.002)
        time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(), 130)
        self.assertEqual(sorted(os.listdir(self.folder)), ["c", "out.ppm"])
        self.assertEqual(len(self.bytes_of("out.ppm")), len(b"P6\n32 20\n255\n") + 32 * 20 * 3)
        self.render("-o", "out.ppm", "--spp", "1", "--resume", "c")

    def test_shards_make_the_whole(self):
        whole = self.whole("--spp", "50")
        for shard in (1, 2, 3):
            self.render("--spp", "50", "--shard", f"{shard}/3", "--checkpoint", f"part{shard}")
        self.assertEqual(sorted(os.listdir(self.folder)), ["part1", "part2", "part3", "whole.ppm"])
        for order in ("123", "312"):
            result = self.run_program("merge", *(f"part{i}" for i in order), "-o", "merged.ppm")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertRegex(result.stderr, rb"^wrote merged\.ppm: 32 x 20 pixels, 50 samples each, in [0-9.]+ s\n$")
            self.assertEqual(self.bytes_of("merged.ppm"), whole)
        # A merge may use different display options.
        self.run_program("merge", "part1", "part2", "part3", "-o", "merged.ppm", "--exposure", "1", "--tonemap", "aces")
        self.assertEqual(self.bytes_of("merged.ppm"), self.whole("--spp", "50", "--exposure", "1", "--tonemap", "aces"))
        # If samples are missing, merge writes a picture only with --partial. Another run can add the missing samples.
        result = self.run_program("merge", "part1", "part3", "-o", "none.ppm")
        self.assertEqual(result.returncode, 2)
        self.assertIn(b"error: none.ppm: samples 16 to 32 of 50 are missing; ", result.stderr)
        self.assertFalse((self.folder / "none.ppm").exists())
        result = self.run_program("merge", "part1", "part3", "-o", "merged.ppm", "--partial")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"warning: merged.ppm: samples 16 to 32 of 50 are missing\n", result.stderr)
        self.assertNotEqual(self.bytes_of("merged.ppm"), whole)
        self.render("--spp", "50", "--resume", "part1", "--resume", "part3", "-o", "filled.ppm")
        self.assertEqual(self.bytes_of("filled.ppm"), whole)
        twice = self.run_program("merge", "part1", "part2", "part1", "-o", "merged.ppm")
        self.assertEqual(twice.returncode, 2)
        self.assertIn(b"part1: holds samples 0 to 15, some of which are already present", twice.stderr)

    def test_a_checkpoint_of_another_program_is_not_overwritten(self):
        self.render("--spp", "60000", "--shard", "2/2", "--time-limit", "0.2", "--checkpoint", "other")
        command = [PROGRAM, SCENE, *LIGHT, "--spp", "60000", "--shard", "1/2", "--time-limit", "60", "--save-every", "0.1"]
        first = subprocess.Popen([*command, "--checkpoint", "same"], cwd=self.folder, env=environment(), stderr=subprocess.PIPE)
        while not (self.folder / "same").exists():
            self.assertIsNone(first.poll())
            time.sleep(0.02)
        shutil.copy(self.folder / "other", self.folder / "copy")
        os.replace(self.folder / "copy", self.folder / "same")
        self.assertIn(b"same: was written by another program meanwhile", first.communicate(timeout=60)[1])
        self.assertEqual(first.returncode, 5)
        self.assertEqual(self.bytes_of("same"), self.bytes_of("other"))

    def test_one_of_two_programs_keeps_the_checkpoint(self):
        for before in ("new", "old"):
            for _ in range(10):
                if before == "old":
                    self.render("--spp", "2", "--shard", "1/2", "--checkpoint", "same")
                command = [PROGRAM, SCENE, *LIGHT, "--spp", "4", "--shard", "1/2", "--checkpoint", "same"]
                processes = [subprocess.Popen(command, cwd=self.folder, env=environment(), stderr=subprocess.PIPE) for _ in range(2)]
                messages = [process.communicate()[1] for process in processes]
                codes = sorted(process.returncode for process in processes)
                # The second may have started after the first had ended.
                self.assertIn(codes, ([0, 0], [0, 5]), messages)
                if codes == [0, 5]:
                    self.assertTrue(any(b"was written by another program meanwhile" in message for message in messages))
                self.assertEqual([name for name in os.listdir(self.folder) if name != "same"], [])
                (self.folder / "same").unlink()

    def test_merging_refuses_options_without_effect(self):
        self.render("--spp", "4", "--shard", "1/2", "--checkpoint", "part1")
        self.render("--spp", "4", "--shard", "2/2", "--checkpoint", "part2")
        for option in (["--denoise"], ["--exposure", "1"], ["--tonemap", "none"]):
            result = self.run_program("merge", "part1", "part2", "--checkpoint", "all", *option)
            self.assertEqual((result.returncode, (self.folder / "all").exists()), (2, False), option)
            self.assertIn(b"without --output", result.stderr)
        result = self.run_program("merge", "part1", "part2", "-o", "a.ppm", "--memory-limit", "10K")
        self.assertEqual(result.returncode, 6)
        self.assertIn(b"raise it (--memory-limit)", result.stderr)

    def test_checkpoints_that_cannot_be_written_do_not_cost_the_picture(self):
        expected = self.whole("--spp", "16")
        # The picture fits within this limit of file sizes, the checkpoint doesn't.
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (6000, 6000))
        result = self.run_program(SCENE, *LIGHT, "--spp", "16", "--checkpoint", "c", "--save-every", "0", "-o", "a.ppm", preexec_fn=limit)
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertEqual(result.stderr.count(b"warning: c: can't be written"), 1, result.stderr)
        self.assertIn(b"error: c: can't be written", result.stderr)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir() if p.name.endswith(("c", "a.ppm"))), ["a.ppm"])
        self.assertEqual(self.bytes_of("a.ppm"), expected)
        # A shard has no picture.
        result = self.run_program(SCENE, *LIGHT, "--spp", "16", "--shard", "1/2", "--checkpoint", "c", preexec_fn=limit)
        self.assertEqual(result.returncode, 5, result.stderr)

    def test_samples_of_other_pictures_are_refused(self):
        scene = self.folder / "scene.json"
        shutil.copy(SCENE, scene)
        self.render("-o", "a.ppm", "--spp", "2", "--checkpoint", "c", scene=scene)
        before = self.bytes_of("c")

        def refused(reason, *arguments):
            message = self.render("-o", "b.png", "--spp", "4", "--checkpoint", "c", *arguments, code=2, scene=scene)
            self.assertIn("c: holds samples of another picture: " + reason, message)
            self.assertEqual(self.bytes_of("c"), before)
            self.assertFalse((self.folder / "b.png").exists())

        refused("made without --seed, not with --seed 1", "--seed", "1")
        refused("made without --max-depth", "--max-depth", "3")
        refused("made without --backfaces, not with --backfaces occlude", "--backfaces", "occlude")
        refused("made without --background", "--background", "transparent")
        refused("made without --crop", "--crop", "0,0,8,8")
        scene.write_text(scene.read_text() + "\n")
        refused("made with scene files ")

    def test_files_of_the_scene_are_part_of_the_identity(self):
        vertices = b"".join(x.to_bytes(4, "little") for x in
                            (0, 0, 0, 0x3F800000, 0, 0, 0, 0x3F800000, 0))
        (self.folder / "a.bin").write_bytes(vertices)
        gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                "buffers": [{"uri": "a.bin", "byteLength": 36}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                               "min": [0, 0, 0], "max": [1, 1, 0]}]}
        scene = self.folder / "a.gltf"
        scene.write_text(json.dumps(gltf))
        self.render("-o", "a.ppm", "--checkpoint", "c", scene=scene)
        self.render("-o", "a.ppm", "--checkpoint", "c", "--spp", "2", scene=scene)
        # Moves the third corner, but keeps the accessor's bounds.
        (self.folder / "a.bin").write_bytes(vertices[:24] + (0x3F000000).to_bytes(4, "little") + vertices[28:])
        message = self.render("-o", "a.ppm", "--checkpoint", "c", "--spp", "3", code=2, scene=scene)
        self.assertIn("made with scene files ", message)

    def test_damaged_checkpoints_are_refused(self):
        self.render("-o", "a.ppm", "--spp", "2", "--checkpoint", "c")
        good = self.bytes_of("c")
        flipped = bytearray(good)
        flipped[len(good) // 2] ^= 4
        for name, content, reason in (("cut", good[:-9], "damaged"), ("flip", bytes(flipped), "damaged"),
                                      ("head", good[:30], "damaged"), ("none", b"", "not a checkpoint"),
                                      ("other", b"P6\n", "not a checkpoint"), ("long", good + b"x", "damaged"),
                                      ("new", good[:19] + b"\x09" + good[20:], "version 9")):
            (self.folder / name).write_bytes(content)
            message = self.render("-o", "b.ppm", "--spp", "3", "--resume", name, code=5)
            self.assertIn(f"{name}: ", message)
            self.assertIn(reason, message)
        self.assertIn("missing", self.render("-o", "b.ppm", "--resume", "missing", code=5))
        self.assertFalse((self.folder / "b.ppm").exists())

    def test_time_limit_keeps_the_samples_taken(self):
        stats = json.loads(self.render("-o", "a.ppm", "--spp", "65536", "--time-limit", "0.3", "--stats=json"))
        taken = stats["samples_per_pixel"]
        self.assertGreaterEqual(taken, 1)
        self.assertLess(taken, 65536)
        self.assertEqual(stats["rays"], taken * 32 * 20)
        self.assertEqual(self.bytes_of("a.ppm"), self.whole("--spp", taken))

    def test_target_error_stops_sampling(self):
        options = ["--spp", "512", "--target-error", "0.15", "--stats=json"]
        stats = json.loads(self.render("-o", "a.ppm", *options, "-t", "1"))
        self.assertLess(stats["rays"], 512 * 32 * 20)
        self.assertGreaterEqual(stats["rays"], 32 * 32 * 20)
        # More threads and an interruption must not change the result.
        self.render("-o", "b.ppm", "--spp", "40", *options[2:], "--checkpoint", "c")
        again = json.loads(self.render("-o", "b.ppm", *options, "-t", "3", "--checkpoint", "c"))
        self.assertEqual(again["samples_per_pixel"], stats["samples_per_pixel"])
        self.assertEqual(self.bytes_of("a.ppm"), self.bytes_of("b.ppm"))

    def test_contradictory_options_are_refused(self):
        for arguments in (["--shard", "1/2"], ["--shard", "0/2", "--checkpoint", "c", "--spp", "4"],
                          ["--shard", "3/2", "--checkpoint", "c", "--spp", "4"],
                          ["--shard", "1/5", "--checkpoint", "c", "--spp", "4"],
                          ["--shard", "1/2", "--checkpoint", "c", "--spp", "4", "-o", "a.ppm"],
                          ["--shard", "1/2", "--checkpoint", "c", "--spp", "4", "--sidecar", "a.json"],
                          ["--checkpoint", "a.ppm", "-o", "a.ppm"], ["--time-limit", "-1"],
                          ["--time-limit", "soon"], ["--checkpoint", "c", "--frames", "0:1", "-o", "%d.ppm"],
                          ["--progressive", "-o", "-"], ["--target-error", "0"],
                          ["--integrator", "flat", "--checkpoint", "c"]):
            result = self.run_program(SCENE, *(LIGHT if "flat" not in arguments else []), *arguments)
            self.assertEqual(result.returncode, 2, (arguments, result.stderr))
            self.assertNotEqual(result.stderr, b"")
            self.assertEqual(os.listdir(self.folder), [], arguments)
        nowhere = self.run_program(SCENE, *LIGHT, "--checkpoint", "no/where", "-o", "a.ppm")
        self.assertEqual(nowhere.returncode, 5, nowhere.stderr)
        for arguments in (["merge"], ["merge", "a"], ["merge", "a", "-o", "b.xyz"]):
            self.assertIn(self.run_program(*arguments).returncode, (2, 5))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
