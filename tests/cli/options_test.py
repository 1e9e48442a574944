#!/usr/bin/env python3
"""Tests the table of options: the listed defaults, and whether an option affects samples.

usage: options_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import re
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
import option_table
from program import ProgramTest

SOURCE = Path(sys.argv[2]).resolve()
SCENE = SOURCE / "scenes/perspective1.json"
MOVING = SOURCE / "scenes/gltf/moving.glb"
LIGHT = [SCENE, "--integrator", "path", "--size", "16x12", "-q"]
# Other options that an option requires.
CONTEXT = {"--fov": ["--view", "front"], "--up": ["--eye", "0,0,30"], "--aperture": ["--focus", "3"], "--fps": ["--frames", "3:3"],
           "--shutter-times": ["--shutter", "0:0.1"]}
# Options that affect samples, with values that differ from the defaults.
SAMPLES_DEPEND = {
    "--size": "12x16", "--crop": "0,0,8,8", "--background": "transparent", "--camera": "0", "--view": "top", "--eye": "0,0,30",
    "--filter": "blackman-harris", "--seed": "1", "--max-depth": "1", "--backfaces": "occlude", "--bsdf": "spec", "--guiding": None,
    "--env": "#ff8000", "--env-rotation": "90", "--env-intensity": "0.5", "--ground": None, "--target-error": "0.5", "--quality": "draft", "--time": "1", "--shutter": "0:0.1"}
SAMPLES_STAY = {
    "--threads": "3", "--stats": None, "--progress": "none", "--exposure": "2", "--tonemap": "aces", "--memory-limit": "1G",
    "--max-time": "600", "--verbose": None, "--strict": None, "--time-limit": "500", "--save-every": "1", "--ppm": "ascii",
    "--allow-path": ".", "--aov": "depth", "--sidecar": "a.json", "--progressive": None, "--spp": "3"}
# Options that change an option with which the checkpoint was made, and the words of both.
SAMPLES_DEPEND_ON_MORE = [
    (SCENE, ["--view", "front"], ["--fov", "30"]), (SCENE, ["--eye", "0,0,30"], ["--up", "1,0,0"]),
    (SCENE, ["--eye", "0,0,30"], ["--target", "0,1,0"]), (SCENE, ["--aperture", "0.2", "--focus", "3"], ["--aperture", "0.1"]),
    (SCENE, ["--aperture", "0.1", "--focus", "3"], ["--focus", "4"]), (SCENE, ["--shutter", "0:0.1"], ["--shutter-times", "4"]),
    (MOVING, ["--time", "0.5"], ["--animation", "0"])]
# Options of files, of sequences and of the run, which have tests of their own, and those that render nothing.
OTHERS = {"SCENE", "--output", "--integrator", "--denoise", "--frames", "--fps", "--variant", "--instances", "--checkpoint", "--resume",
          "--shard", "--display-server", "--end-with-parent", "--validate", "--version", "--quiet", "--help"}


class Options(ProgramTest):
    def options(self):
        groups = option_table.parse(self.run_program("--help").stdout.decode())
        return [option for options in groups.values() for option in options]

    def render(self, *arguments, picture="a.ppm"):
        result = self.run_program(*arguments, "-o", picture)
        self.assertEqual(result.returncode, 0, (arguments, result.stderr))
        return (self.folder / picture).read_bytes()

    def test_listed_defaults_are_true(self):
        count = 0
        for option in self.options():
            default = option.default.split(";")[0]
            if not re.fullmatch(r"[a-z0-9.,:-]+", default) or default == "none":
                continue
            # The second scene has settings of its own, which options without values don't change.
            for scene in (SCENE, SOURCE / "scenes/sky.json"):
                with self.subTest(option.name, default=default, scene=scene.name):
                    count += 1
                    context = CONTEXT.get(option.name, [])
                    picture = "%d.ppm" if "--frames" in context else "3.ppm"
                    pictures = []
                    for more in ([], [option.name, default]):
                        result = self.run_program(scene, *LIGHT[1:], "--spp", "2", *context, *more, "-o", picture)
                        self.assertEqual(result.returncode, 0, result.stderr)
                        pictures.append((self.folder / "3.ppm").read_bytes())
                    self.assertEqual(pictures[0], pictures[1])
        self.assertGreater(count, 20)

    def test_samples_of_different_options_are_not_combined(self):
        self.render(*LIGHT, "--spp", "2", "--checkpoint", "c")
        checkpoint = (self.folder / "c").read_bytes()
        known = {name for option in self.options() for name in option.names}
        for option, value in SAMPLES_DEPEND.items():
            self.assertIn(option, known)
            light = [word for word in LIGHT if option != "--size" or word not in ("--size", "16x12")]
            result = self.run_program(*light, "--spp", "2", option, *([value] if value else []), "--resume", "c", "-o", "a.exr")
            self.assertEqual(result.returncode, 2, (option, result.stderr))
            self.assertIn(b"c: holds samples of another picture: ", result.stderr)
        self.assertEqual((self.folder / "c").read_bytes(), checkpoint)

    def test_samples_depend_on_details_of_other_options(self):
        for scene, before, changed in SAMPLES_DEPEND_ON_MORE:
            with self.subTest(changed=changed):
                (self.folder / "c").unlink(missing_ok=True)
                words = [scene, *LIGHT[1:], "--spp", "2", "-o", "a.exr"]
                result = self.run_program(*words, *before, "--checkpoint", "c")
                self.assertEqual(result.returncode, 0, result.stderr)
                kept = [word for i, word in enumerate(before) if not {word, before[i - i % 2]} & {changed[0]}]
                result = self.run_program(*words, *kept, *changed, "--resume", "c")
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(b"c: holds samples of another picture: ", result.stderr)

    def test_each_option_has_a_test_of_samples(self):
        known = {option.name for option in self.options()}
        tested = {*SAMPLES_DEPEND, *SAMPLES_STAY, *(changed[0] for _, _, changed in SAMPLES_DEPEND_ON_MORE), *OTHERS}
        self.assertEqual(known, tested)

    def test_other_options_may_differ(self):
        whole = self.render(*LIGHT, "--spp", "3")
        known = {name for option in self.options() for name in option.names}
        for option, value in SAMPLES_STAY.items():
            self.assertIn(option, known)
            (self.folder / "c").unlink(missing_ok=True)
            self.render(*LIGHT, "--spp", "2", "--checkpoint", "c")
            quiet = LIGHT[:-1] if option == "--verbose" else LIGHT
            more = ["--spp", "3"] if option != "--spp" else []
            picture = "a.exr" if option == "--aov" else "a.ppm"
            self.render(*quiet, *more, option, *([value] if value else []), "--checkpoint", "c", picture=picture)
            self.assertEqual(self.render(*LIGHT, "--spp", "3", "--resume", "c"), whole, option)

    def test_messages(self):
        for arguments, message in ((["--spp", "3", "--spp", "4"], b"error: --spp is given twice\n"),
                                   (["--frames", "0:1", "--time", "2"], b"error: --time can't be combined with --frames\n"),
                                   (["--fov", "30"], b"error: --fov requires --view or --eye\n"),
                                   (["--aperture", "0.1"], b"error: --aperture requires --focus\n"),
                                   (["--focus", "0"], b"error: --focus: expects a number above 0, at most 1e38, not 0\n"),
                                   (["--stats=xml"], b"error: --stats: expects text or json, not xml\n"),
                                   (["--filter", "gauss"], b"error: --filter: expects box or blackman-harris, not gauss\n")):
            result = self.run_program(*LIGHT, *arguments)
            self.assertEqual(result.returncode, 2)
            self.assertTrue(result.stderr.startswith(message), result.stderr)
        # Switches may be repeated.
        self.assertEqual(self.run_program(*LIGHT, "-q", "--quiet", "--spp", "1", "-o", "a.ppm").stderr, b"")

    def test_help_comes_before_other_errors(self):
        for arguments in (["--fov", "wide", "--help"], ["--help"], ["-h", "--fps", "3"]):
            self.assertEqual(self.run_program(*arguments).returncode, 0, arguments)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
