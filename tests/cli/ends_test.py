#!/usr/bin/env python3
"""Tests how runs end (limits, signals, full disks) and how messages escape control characters.

usage: ends_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import fcntl
import json
import os
import pty
import signal
import struct
import subprocess
import sys
import termios
import time
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
SCENE = SOURCE / "scenes/perspective1.json"
# Arguments of a rendering that would take hours.
LONG = [SCENE, "--size", "4000x4000", "--spp", "65536", "--integrator", "path", "-q", "-o", "out.ppm"]


class Ends(ProgramTest):
    def start(self, *arguments, **options):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, stderr=subprocess.PIPE,
                                env=environment(), **options)

    def wait_for_temporary(self):
        """Waits until the program has opened its temporary output file."""
        for _ in range(3000):
            if any(name.startswith(".microtrace-") for name in os.listdir(self.folder)):
                return
            time.sleep(0.01)
        self.fail("no file is being written")

    # Messages

    def draw_in_terminal(self, columns, samples):
        """Renders three pictures in a terminal. Returns what is written to it."""
        terminal, other_end = pty.openpty()
        fcntl.ioctl(other_end, termios.TIOCSWINSZ, struct.pack("4H", 25, columns, 0, 0))
        command = [PROGRAM, SOURCE / "scenes/gltf/moving.glb", "--frames", "0:2", "--size", "200x150", "--spp", str(samples), "-o", "%d.ppm", "-t", "1"]
        with subprocess.Popen(command, cwd=self.folder, stderr=other_end, env=environment(TERM="xterm")) as process:
            os.close(other_end)
            text = b""
            while True:
                try:
                    text += os.read(terminal, 4096)
                except OSError:  # the program has ended
                    break
        os.close(terminal)
        self.assertEqual(process.returncode, 0)
        return text

    def test_lines_of_the_progress_bar_fit_into_the_terminal(self):
        for columns in (80, 40, 20, 5):
            drawn = [part.split(b"\x1b")[0] for part in self.draw_in_terminal(columns, 120).split(b"\r") if b"\x1b[K" in part]
            self.assertGreater(len(drawn), 2)
            self.assertLess(max(map(len, drawn)), columns)
            self.assertEqual(any(b"[" in line for line in drawn), columns >= 40, drawn[:3])

    def test_messages_replace_the_progress_bar(self):
        text = self.draw_in_terminal(80, 400)
        self.assertIn(b"picture 2 of 3", text)
        self.assertEqual(text.count(b"wrote "), 3)
        for line in text.split(b"\r"):
            self.assertFalse(b"left" in line and b"wrote" in line, line)

    # Limits

    def test_max_time(self):
        for more in [(), ("--checkpoint", "c", "--save-every", "1000", "--progressive")]:
            result = self.run_program(*LONG, *more, "--max-time", "0.3")
            self.assertEqual(result.returncode, 6, result.stderr)
            self.assertEqual(result.stderr, b"error: --max-time has elapsed; nothing more is written\n")
            self.assertEqual(os.listdir(self.folder), [])
        result = self.run_program(SCENE, "--size", "8x6", "-o", "a.ppm", "--max-time", "3600")
        self.assertEqual(result.returncode, 0, result.stderr)
        for wrong in ["0", "-1", "x", "nan"]:
            self.assertEqual(self.run_program(SCENE, "--max-time", wrong).returncode, 2)

    def test_max_time_bounds_reading_and_writing(self):
        os.mkfifo(self.folder / "pipe.json")
        os.mkfifo(self.folder / "pipe.ppm")
        for arguments in [["pipe.json", "-o", "a.ppm"], [SCENE, "-o", "pipe.ppm"]]:
            result = self.run_program(*arguments, "--max-time", "0.3")
            self.assertEqual(result.returncode, 6, result.stderr)

    # Signals

    def test_signals_leave_no_temporary_file(self):
        for number in [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGXCPU]:
            process = self.start(SCENE, "--size", "600x600", "--spp", "65536", "--integrator", "path", "-q", "-o", "out.ppm",
                                 "--checkpoint", "c", "--save-every", "0")
            self.wait_for_temporary()
            process.send_signal(number)
            _, message = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 128 + number, message)
            self.assertEqual([name for name in os.listdir(self.folder) if name != "c"], [])

    def test_ignored_signals_stay_ignored(self):
        def ignore():
            for number in [signal.SIGINT, signal.SIGHUP, signal.SIGQUIT]:
                signal.signal(number, signal.SIG_IGN)
        process = self.start(*LONG, preexec_fn=ignore)
        time.sleep(0.5)
        for number in [signal.SIGINT, signal.SIGHUP, signal.SIGQUIT]:
            process.send_signal(number)
        time.sleep(0.5)
        self.assertIsNone(process.poll())
        process.terminate()
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 128 + signal.SIGTERM)

    # Standard output

    def test_pipes_that_another_program_made_non_blocking(self):
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        scene = SOURCE / "scenes/perspective1.json"
        with subprocess.Popen([PROGRAM, scene, "-q", "-o", "-"], stdout=writer, stderr=subprocess.PIPE) as process:
            os.close(writer)
            time.sleep(0.2)  # The pipe becomes full.
            with open(reader, "rb") as pipe:
                self.assertEqual(len(pipe.read()), len(b"P6\n640 480\n255\n") + 3 * 640 * 480)
            self.assertEqual(process.wait(), 0, process.stderr.read())

    def test_full_standard_output_is_an_error(self):
        for arguments in [[SCENE, "--validate"], ["--help"], ["--version"], ["merge", "--help"]]:
            with open("/dev/full", "w") as full:
                result = subprocess.run([PROGRAM, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE,
                                        cwd=self.folder, env=environment(), timeout=60)
            self.assertEqual(result.returncode, 5, result.stderr)
            self.assertIn(b"error: standard output", result.stderr)

    # Messages

    def test_control_characters_are_escaped(self):
        evil = "a\x1b]0;owned\x07\x1b[31m\u202e.json"
        (self.folder / evil).write_text("{")
        (self.folder / "link.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "extensionsRequired": ["\x1b[2J"], "extensionsUsed": ["\x1b[2J"],
            "cameras": [{"type": "\x9b31m"}]}))
        scene = json.loads(SCENE.read_text())
        for camera in scene["cameras"]:
            camera["name"] = "\x1b[2J"
        (self.folder / "names.json").write_text(json.dumps(scene))
        for arguments in [[evil], [evil, "--validate"], ["missing\x1b[2J.json"], [SCENE, "-o", "\x1b[2J/a.ppm"],
                          [SCENE, "-o", "a.\x1b[2J"], ["link.gltf"], ["link.gltf", "--validate"],
                          ["names.json", "-c", "\x1b[3J", "-o", "a.ppm"], ["names.json", "-v", "-o", "\x1b[2J.ppm", "--size", "4x4"],
                          [SCENE, "--size", "\x1b[2J"], [SCENE, "--\x1b[2J"], [SCENE, "--env", "\x1b[2J.hdr"],
                          [SCENE, "--seed", "\x1b[2J"], [SCENE, "--resume", "\x1b[2J", "--integrator", "path"],
                          ["merge", "\x1b[2J", "-o", "a.ppm"], [SCENE, "--frames", "\x1b"], [SCENE, "--crop", "\x1b"],
                          [SCENE, "--variant", "\x1b[2J", "--animation", "\x1b"]]:
            result = self.run_program(*arguments)
            for stream in (result.stdout, result.stderr):
                text = stream.decode().replace("\n", "")
                self.assertTrue(text.isprintable(), (arguments, text))
            self.assertNotEqual(result.stdout + result.stderr, b"")

    # Options

    def test_whole_numbers_are_decimal(self):
        def noise(seed):
            return self.picture(SCENE, "--size", "16x12", "--integrator", "path", "--env", "studio", "--spp", "01", "--seed", seed)
        self.assertEqual(noise("010"), noise("10"))
        self.assertNotEqual(noise("010"), noise("8"))
        for option, value in [("--seed", "0x10"), ("--seed", "1e3"), ("--spp", "0x2"), ("--spp", " 2"), ("-t", "0b1"),
                              ("--max-depth", "+3"), ("--seed", "4294967296")]:
            result = self.run_program(SCENE, option, value)
            self.assertEqual(result.returncode, 2, (option, value, result.stderr))
            self.assertIn(b"must be a whole number from ", result.stderr)
        result = self.run_program(SCENE, "--spp", "010", "--size", "4x4", "--stats=json", "-q", "-o", "a.ppm")
        self.assertEqual(json.loads(result.stderr)["samples_per_pixel"], 10)

    def test_resuming_with_fewer_samples_prints_a_warning(self):
        options = [SCENE, "--integrator", "path", "--size", "8x6", "-o", "a.ppm"]
        warning = b"warning: the checkpoints contain samples up to number 4 of each pixel, more than --spp 2"
        for spp, says in [("4", False), ("4", False), ("2", True), ("5", False)]:
            result = self.run_program(*options, "--spp", spp, "--checkpoint", "c")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(warning in result.stderr, says, (spp, result.stderr))
        self.assertEqual(self.run_program(*options, "--spp", "2", "--resume", "c", "--strict").returncode, 3)

    def test_unknown_instruction_sets(self):
        for name in ["avx3", "AVX2", "\x1b[2J"]:
            result = self.run_program(SCENE, "-o", "a.ppm", env=environment(MICROTRACE_ISA=name))
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(b"known are portable, avx2 and avx512", result.stderr)
            self.assertEqual(os.listdir(self.folder), [])
        for name in ["", "portable", "avx2", "avx512"]:  # those that the machine lacks fall back to portable
            result = self.run_program(SCENE, "--size", "8x6", "-o", "a.ppm", env=environment(MICROTRACE_ISA=name))
            self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
