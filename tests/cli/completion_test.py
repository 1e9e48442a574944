#!/usr/bin/env python3
"""Tests completion in bash, fish and zsh.

usage: completion_test.py PROGRAM [unittest arguments]
"""

import re
import shlex
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
import option_table
from program import PROGRAM, ProgramTest


COMMANDS = ("merge", "dataset", "verify", "explain", "compare", "view")


class Completion(ProgramTest):
    def script(self, shell):
        result = self.run_program("completion", shell)
        self.assertEqual((result.returncode, result.stderr), (0, b""))
        path = self.folder / f"script.{shell}"
        path.write_bytes(result.stdout)
        return path

    def run_shell(self, *command):
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stderr), (0, ""), command)
        return result.stdout

    def help_options(self, *command):
        groups = option_table.parse(self.run_program(*command, "--help").stdout.decode())
        return {name for options in groups.values() for option in options for name in option.names if name.startswith("--")}

    def complete_in_bash(self, *words):
        script = self.script("bash")
        command = (f"source {shlex.quote(str(script))}; COMP_WORDS=({' '.join(map(shlex.quote, words))}); "
                   f"COMP_CWORD={len(words) - 1}; _microtrace; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
        return set(self.run_shell("bash", "--norc", "-c", command).split("\n")) - {""}

    def test_bash(self):
        for name in ("my scene.json", "model.glb", "notes.txt"):
            (self.folder / name).write_text("")
        (self.folder / "folder").mkdir()
        self.assertEqual(self.complete_in_bash("microtrace", "--samp"), {"--samples"})
        self.assertLessEqual(self.help_options(), self.complete_in_bash("microtrace", "-"))
        self.assertGreater(len(self.help_options()), 30)
        self.assertEqual(self.complete_in_bash("microtrace", "--tonemap", "a"), {"aces", "agx"})
        self.assertEqual(self.complete_in_bash("microtrace", "m"), {"my scene.json", "model.glb", "merge"})
        self.assertIn("folder", self.complete_in_bash("microtrace", ""))
        self.assertNotIn("notes.txt", self.complete_in_bash("microtrace", ""))
        self.assertIn("notes.txt", self.complete_in_bash("microtrace", "-o", "n"))
        self.assertEqual(self.complete_in_bash("microtrace", "--size", ""), set())
        self.assertEqual(self.complete_in_bash("microtrace", "--env", "s") & {"studio"}, {"studio"})

    def test_lists_in_bash(self):
        for words in (["--aov", "depth,nor"], ["--aov", "=", "depth,nor"]):
            self.assertEqual(self.complete_in_bash("microtrace", *words), {"depth,normal"})
        self.assertEqual(self.complete_in_bash("microtrace", "--aov=uv,depth,nor"), {"--aov=uv,depth,normal"})
        self.assertEqual(self.complete_in_bash("microtrace", "dataset", "--formats", "png,co"), {"png,coco"})

    def test_automatic_exposure_is_offered_where_it_is_accepted(self):
        for command, values in [([], {"auto"}), (["view"], {"auto"}), (["compare"], set()), (["merge"], set()), (["dataset"], set())]:
            self.assertEqual(self.complete_in_bash("microtrace", *command, "--exposure", ""), values)

    def test_values_after_an_equals_sign_in_bash(self):
        for name in ("notes.txt", "scene.json"):
            (self.folder / name).write_text("")
        # By default, bash divides words at equals signs. If COMP_WORDBREAKS lacks them, it doesn't.
        for option, start, values in [("--tonemap", "a", {"aces", "agx"}), ("--stats", "", {"text", "json"}), ("--ground", "", {"lowest"}),
                                      ("--output", "n", {"notes.txt"}), ("--size", "", set()), ("--quiet", "", set())]:
            divided = [option, "=", start] if start else [option, "="]
            self.assertEqual(self.complete_in_bash("microtrace", "a.json", *divided), values, option)
            self.assertEqual(self.complete_in_bash("microtrace", "a.json", f"{option}={start}"), {f"{option}={value}" for value in values}, option)
        self.assertEqual(self.complete_in_bash("microtrace", "dataset", "--formats", "=", "n"), {"npz"})
        # An optional value can't be a word of its own.
        self.assertNotIn("json", self.complete_in_bash("microtrace", "--stats", ""))

    def test_commands_in_bash(self):
        for name in ("scene.json", "sums"):
            (self.folder / name).write_text("")
        (self.folder / "set").mkdir()
        for command in COMMANDS:
            self.assertEqual(self.help_options(command), self.complete_in_bash("microtrace", command, "--"))
            self.assertIn(command, self.complete_in_bash("microtrace", command[:2]))
        self.assertEqual(self.complete_in_bash("microtrace", "merge", "s"), {"script.bash", "scene.json", "sums", "set"})
        self.assertEqual(self.complete_in_bash("microtrace", "dataset", "s"), {"scene.json", "set"})
        self.assertEqual(self.complete_in_bash("microtrace", "dataset", "--formats", ""),
                         {"png", "exr", "npz", "coco", "bop"})
        self.assertEqual(self.complete_in_bash("microtrace", "verify", ""), {"set"})
        self.assertEqual(self.complete_in_bash("microtrace", "completion", ""), {"bash", "zsh", "fish"})
        self.assertEqual(self.complete_in_bash("microtrace", "a.json", "--output", "dataset", "--redraw"), set())

    def test_fish(self):
        script = self.script("fish")

        def complete(line):
            answer = self.run_shell("fish", "--no-config", "-c", f"source {script}; complete -C {shlex.quote(line)}")
            return {row.split("\t")[0] for row in answer.splitlines()}

        self.assertEqual(complete("microtrace --samp"), {"--samples"})
        self.assertLessEqual(self.help_options(), complete("microtrace --"))
        self.assertEqual(complete("microtrace --tonemap a"), {"aces", "agx"})
        self.assertEqual(complete("microtrace --tonemap=a"), {"--tonemap=aces", "--tonemap=agx"})
        self.assertEqual(complete("microtrace --stats="), {"--stats=text", "--stats=json"})
        self.assertEqual(complete("microtrace --aov depth,nor"), {"depth,normal"})
        self.assertEqual(complete("microtrace dataset --formats=png,co"), {"--formats=png,coco"})
        self.assertNotIn("json", complete("microtrace --stats "))
        self.assertEqual(complete("microtrace a.json -o verify --redr"), set())
        self.assertEqual(complete("microtrace completion "), {"bash", "zsh", "fish"})
        self.assertIn("dataset", complete("microtrace da"))
        for command in COMMANDS:
            names = {word.rstrip("=") for word in complete(f"microtrace {command} --")}  # --ground= if its value may be omitted
            self.assertEqual(self.help_options(command), names)

    def test_zsh(self):
        script = self.script("zsh")
        self.run_shell("zsh", "-f", "-n", str(script))
        parts = dict(re.findall(r"^  \((\w+)\)\n    _arguments(.*?) ;;$", script.read_text(), re.MULTILINE | re.DOTALL))
        for command in ("render", *COMMANDS):
            for option in self.help_options(*([command] if command != "render" else [])):
                self.assertRegex(parts[command], rf"'(\([^)]*\)|\*){option}[=[]")
        self.assertRegex(parts["render"], r"--tonemap=\[[^\n]*\]:NAME:\(none ")
        self.assertRegex(parts["render"], r"--stats=-\[[^\n]*\]::KIND:\(text json\)")

    def test_completed_words_are_accepted(self):
        for option in ("--integrator", "--aov", "--tonemap", "--view", "--background", "--env", "--filter", "--ppm",
                       "--progress", "--backfaces", "--bsdf"):
            words = self.complete_in_bash("microtrace", option, "") - {"script.bash"}
            self.assertGreater(len(words), 0, option)
            for word in words:
                message = self.run_program("missing.json", option, word, "-o", "a.exr").stderr.decode()
                self.assertIn("missing.json: can't be opened", message, (option, word))

    def test_usage(self):
        for arguments in ([], ["tcsh"], ["bash", "zsh"]):
            result = self.run_program("completion", *arguments)
            self.assertEqual((result.returncode, result.stdout), (2, b""))
        for option in ("--help", "-h"):
            result = self.run_program("completion", option)
            self.assertEqual((result.returncode, result.stderr), (0, b""))
            self.assertIn(b"Usage: microtrace completion bash|zsh|fish", result.stdout)
        with open("/dev/full", "w") as full:
            self.assertEqual(subprocess.run([PROGRAM, "completion", "bash"], stdout=full, stderr=subprocess.DEVNULL).returncode, 5)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
