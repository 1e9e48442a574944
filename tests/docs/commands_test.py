#!/usr/bin/env python3
"""Runs each command and each JSON snippet of README.md, CONTRIBUTING.md and docs/*.md.

Commands are read from code blocks and inline code. Commands of microtrace run with a small picture size, in a folder with
the files that they name. Each other command must match a pattern below, with a note about the place that runs it.

usage: commands_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))
from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
# Commands with --denoise need a library, which this one stands for.
os.environ.setdefault("MICROTRACE_OIDN_PATH", str(Path(PROGRAM).parents[2] / "tests/support/libfake_oidn.so"))
PAGES = [SOURCE / "README.md", SOURCE / "CONTRIBUTING.md", *sorted((SOURCE / "docs").glob("*.md"))]

# Patterns of commands that other tests run.
RUN_ELSEWHERE = [
    r"\./demo$|\./test$",  # .ci/run
    r"cmake --preset \w+ && cmake --build --preset \w+( && ctest --preset \w+)?( --target \w+)?$",  # ./demo and ./test, with other presets
    r"cmake --build --preset release --target \w+$",  # long checks that are started by hand; see test_targets_exist
    r"cmake --install build/release( --prefix \w+)?$|cpack( .*)?$",  # package.*
    r"cmake --workflow --preset \w+$|scripts/\w+( \w+)*$",  # see test_scripts_and_presets_exist
    r"ctest -L [\w |]+$",
    r"scripts/setup python && python3 -m venv venv && venv/bin/pip install \.$",  # scripts/bare python
    r"python3 -m venv tools && |cmake --preset release -DCMAKE_CXX_COMPILER=",  # scripts/bare older
    r"import microtrace|\w+ = (mt|scene)\.|mt\.",  # python.tests
    r"(python3 )?(tests|bench)/[\w/]+\.(py|sh|txt)( .*)?$",  # see test_scripts_and_presets_exist
    r"(array=\$\(|SHARDS=\d+ )?sbatch .*|kubectl apply -f clusters/kubernetes/dataset.yaml$",  # slurm, python.tests
    r"ssh -L \d+:127\.0\.0\.1:\d+ server microtrace view ",  # microtrace view itself: view.server
    r"pip install --no-deps --target ~/oidn pyoidn$|export MICROTRACE_OIDN_PATH=",  # like python/tests/requirements.txt
    r"ci/check_pictures( assets expected result --size 320x240)?$|mkdir -p expected && cp -R",  # check_pictures
    r"ffmpeg |assimp |ulimit |sudo apt",
    r"(find_package|target_link_libraries)\(|#include |(const )?auto |microtrace::|[\w.]+\.py FOLDER",  # package.consumer, docs.library
]
# Pages whose code blocks contain formulas instead of commands.
PROSE = {"derivations.md", "exactness.md"}


class Snippet:
    def __init__(self, page, line, text):
        self.place, self.page, self.text = f"{page.relative_to(SOURCE)}:{line}", page, text


def blocks(page):
    """Returns (line, language or None, text) for each code block."""
    lines, found, fence = page.read_text().split("\n"), [], None
    for number, line in enumerate(lines, 1):
        if line.startswith("```"):
            if fence is None:
                fence = (number + 1, line[3:], [])
            else:
                found.append((fence[0], fence[1], "\n".join(fence[2])))
                fence = None
        elif fence is not None:
            fence[2].append(line)
        elif line.startswith("    ") and line.strip():
            found.append((number, None, line.strip()))
    return found


def commands():
    for page in PAGES:
        for line, language, text in blocks(page):
            if language is None and page.name not in PROSE or language in ("sh", "bash"):
                for offset, command in enumerate(text.split("\n")):
                    command = re.sub(r"\s+", " ", re.sub(r"\s+#\s.*$", "", command)).strip()
                    if command:
                        yield Snippet(page, line + offset, command)
        inside = False
        for number, text in enumerate(page.read_text().split("\n"), 1):
            inside ^= text.startswith("```")
            if inside or text.startswith("    "):
                continue
            for code in re.findall(r"`([^`]+)`", text):
                if re.match(r"(microtrace|cmake|ctest|cpack|python3|\./\w+$|scripts/\w+$) ?", code):
                    yield Snippet(page, number, code.replace("\\|", "|"))


def is_ours(command):
    return re.match(r"microtrace ", command) is not None


def has_placeholder(command):
    return re.search(r"\b[A-Z]{4,}\b|\[|<|\bbash\|", command) is not None


def small(command):
    """Returns the command with fewer pixels and samples."""
    command = re.sub(r"--size \S+", "", command)
    command = re.sub(r"(--spp|--samples) (\d+)", lambda m: f"{m[1]} {min(int(m[2]), 4)}", command)
    command = re.sub(r"(orbit|hemisphere|random):\d+", r"\1:2", command)
    if re.match(r"microtrace (merge|completion|verify|explain|compare)|microtrace --", command):
        return command
    if command.startswith("microtrace view"):  # serves until it is ended
        command = f"timeout --preserve-status 2 {command} --no-browser"
    command += " --size 32x24"
    has_one_sample = re.search(r"--integrator (?!path)|--spp|--samples", command)
    return command if has_one_sample else command + " --spp 2"


COMMANDS = [[], ["merge"], ["dataset"], ["verify"], ["explain"], ["compare"], ["view"]]


class Documentation(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "scenes").symlink_to(SOURCE / "scenes")
        for name in ("model.glb", "scene.glb"):
            shutil.copy(SOURCE / "scenes/gltf/materials.glb", self.folder / name)
        shutil.copy(SOURCE / "scenes/perspective1.json", self.folder / "scene.json")
        for name in ("expected", "actual"):
            for extension in ("png", "exr"):
                self.assertEqual(self.run_program("scene.json", "--size", "8x4", "-q", "-o", f"{name}.{extension}").returncode, 0)
        (self.folder / "sky.ppm").write_bytes(b"P6\n4 2\n255\n" + bytes(range(24)))
        shutil.copy(SOURCE / "scenes/gltf/moving.glb", self.folder / "moving.glb")
        self.assertEqual(self.run_program("scene.json", "--size", "8x4", "-q", "-o", "sky.exr").returncode, 0)
        (self.folder / "model.gltf").write_text(json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                                                            "nodes": [{"name": "empty"}]}))
        for name in ("bin", ".local/share/bash-completion/completions", ".config/fish/completions"):
            (self.folder / name).mkdir(parents=True)
        (self.folder / "bin/microtrace").symlink_to(PROGRAM)

    def test_commands_of_the_program(self):
        known = "".join(self.run_program(*command, "--help").stdout.decode() for command in COMMANDS)
        count = 0
        for snippet in commands():
            if not is_ours(snippet.text):
                continue
            with self.subTest(snippet.place, command=snippet.text):
                for option in re.findall(r"(?<![\w-])(--[a-z][a-z-]*)", snippet.text):
                    self.assertIn(option, known, snippet.place)
                if re.fullmatch(r"microtrace \w+", snippet.text):  # only the name of a command
                    self.assertIn(snippet.text.split()[1:], COMMANDS)
                    continue
                if has_placeholder(snippet.text):
                    continue
                count += 1
                path = f"{self.folder / 'bin'}:{os.environ['PATH']}"
                result = subprocess.run(["bash", "-c", small(snippet.text)], cwd=self.folder, capture_output=True,
                                        env=dict(environment(), PATH=path, HOME=str(self.folder)))
                self.assertEqual(result.returncode, 0, f"{snippet.place}: {snippet.text}\n{result.stderr.decode()}")
        self.assertGreater(count, 20, "the commands are not where this test looks")

    def test_options_in_the_text_are_there(self):
        known = set(re.findall(r"(?<![\w-])--?[a-z][a-z-]*", "".join(
            self.run_program(*command, "--help").stdout.decode() for command in COMMANDS)))
        count = 0
        for page in PAGES:
            if page.name in ("performance.md", "CONTRIBUTING.md", "architecture.md", "internals.md"):
                continue  # these pages name options of other programs
            for code in re.findall(r"`(--?[a-z][a-z-]*)(?![\w*])", page.read_text()):
                count += 1
                self.assertIn(code, known, page.name)
        self.assertGreater(count, 100)

    def test_other_commands_are_run_elsewhere(self):
        for snippet in commands():
            if is_ours(snippet.text) or snippet.page.name == "internals.md" or snippet.text == "microtrace":
                continue
            if snippet.page.name == "outputs.md" and "<=" in snippet.text or re.match(r"microtrace[:_C.]", snippet.text):
                continue
            known = any(re.match(pattern, snippet.text) for pattern in RUN_ELSEWHERE)
            self.assertTrue(known, f"{snippet.place}: nothing runs `{snippet.text}`")

    def test_scripts_and_presets_exist(self):
        presets = json.loads((SOURCE / "CMakePresets.json").read_text())
        names = {preset["name"] for kind in presets.values() if isinstance(kind, list) for preset in kind}
        cmake = "\n".join(path.read_text() for path in SOURCE.rglob("CMakeLists.txt") if "build" not in path.parts)
        count = 0
        for snippet in commands():
            for script in re.findall(r"(?:^|\s)((?:\./|scripts/|tests/|bench/|clusters/)[\w./]+)", snippet.text):
                self.assertTrue((SOURCE / script).exists(), f"{snippet.place}: there is no {script}")
                count += 1
            for preset in re.findall(r"--preset (\w+)", snippet.text):
                self.assertIn(preset, names, snippet.place)
            for target in re.findall(r"^cmake .*--target (\w+)", snippet.text):
                self.assertTrue(re.search(rf"add_(custom_target|executable)\({target}\b", cmake),
                                f"{snippet.place}: there is no target {target}")
        self.assertGreater(count, 3)

    def test_continuous_integration_runs_the_two_commands(self):
        script = (SOURCE / ".ci/run").read_text()
        self.assertLess(script.index("demo"), script.rindex("test"), ".ci/run runs ./demo before ./test")

    def test_json_snippets(self):
        count = 0
        for page in PAGES:
            for line, language, text in blocks(page):
                if language != "json":
                    continue
                with self.subTest(page=page.name, line=line):
                    count += 1
                    text = text.strip()
                    # A snippet may show a part of a scene without the enclosing braces.
                    scene = json.loads(text if text.startswith("{") else "{" + text + "}")
                    if "views" in scene:
                        (self.folder / "views.json").write_text(text)
                        result = self.run_program("dataset", "scene.json", "--views", "views.json", "-o", f"views{line}")
                        self.assertEqual(result.returncode, 0, f"{page.name}:{line}: {result.stderr.decode()}")
                        continue
                    scene = {"version": 1, "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1}], **scene}
                    (self.folder / "snippet.json").write_text(json.dumps(scene))
                    result = self.run_program("snippet.json", "--strict", "--size", "8x6", "-o", "-")
                    self.assertEqual(result.returncode, 0, f"{page.name}:{line}: {result.stderr.decode()}")
        self.assertGreater(count, 1)

    def test_links_lead_somewhere(self):
        headings = lambda page: {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
                                 for heading in re.findall(r"(?m)^#+ (.*)$", page.read_text())}
        count = 0
        for page in [*PAGES, SOURCE / "CHANGELOG.md", *SOURCE.glob("*/README.md")]:
            for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, anchor = target.partition("#")
                file = (page.parent / path).resolve() if path else page
                count += 1
                self.assertTrue(file.exists(), f"{page.name}: {target}")
                if anchor:
                    self.assertIn(anchor, headings(file), f"{page.name}: {target}")
        self.assertGreater(count, 30)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
