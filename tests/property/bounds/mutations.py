#!/usr/bin/env python3
"""Halves the error bounds of mutations.txt one by one in a copy of the source, builds the tests with each, and runs them.
At least one test must fail. If an entry cites a proof beside the bound, only the presence of the text is checked.

usage: mutations.py BUILD FOLDER [NAME...]

BUILD is a Ninja build of the unchanged source. Unchanged object files are taken from it. FOLDER receives the copy. If NAMEs
are given, only bounds whose name contains one of them are tried. Not part of ctest, because it takes a few minutes. The exit
status is 1 if a halved bound is undetected or no longer exists.
"""

import importlib.util
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parent
SOURCE = TESTS.parents[2]

# Imports the parser of mutations, and the function that copies changed files.
spec = importlib.util.spec_from_file_location("golden_mutations", SOURCE / "tests/golden/mutations.py")
faults = importlib.util.module_from_spec(spec)
spec.loader.exec_module(faults)

PROGRAM = "tests/property/bounds/bounds_test"
# For each part of the source, the files that must be recompiled.
PARTS = {
    "accel/filters/": ["tests/property/bounds/bounds_test.cpp"],
    "accel/filters/roundings.hpp": ["tests/property/bounds/bounds_test.cpp", "src/accel/kernels/portable.cpp"],
    "accel/spawn/": ["tests/property/bounds/bounds_test.cpp"],
    "accel/kernels/": ["src/accel/kernels/portable.cpp", "src/accel/kernels/avx2.cpp", "src/accel/kernels/avx512.cpp"],
    "accel/spawn/kernels/": ["src/accel/spawn/kernels/portable.cpp", "src/accel/spawn/kernels/avx2.cpp",
                             "src/accel/spawn/kernels/avx512.cpp"],
}


class Build:
    def __init__(self, build, copy):
        self.build, self.copy = build, copy
        commands = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
        self.commands = {str(Path(c["file"]).relative_to(SOURCE)): c["command"] for c in commands
                         if Path(c["file"]).is_relative_to(SOURCE)}
        last = subprocess.run(["ninja", "-C", build, "-t", "commands", PROGRAM], check=True, capture_output=True,
                              text=True).stdout.splitlines()[-1]
        self.link = next(part for part in last.split(" && ") if f"-o {PROGRAM} " in part)

    def make(self, file):
        """Builds the tests with the copy's version of a file below src/."""
        part = max((part for part in PARTS if file.startswith(part)), key=len)
        link = self.link.replace(f"-o {PROGRAM} ", f"-o {self.copy / 'bounds_test'} ")
        running = []
        for name in PARTS[part]:
            if name not in self.commands:
                continue  # compiled only for other processors
            target = self.copy / (name.replace("/", "_") + ".o")
            command = re.sub(r" -o (\S+\.o) ", f" -o {target} ", self.commands[name])
            running.append(subprocess.Popen(shlex.split(command.replace(str(SOURCE / "src"), str(self.copy / "src"))),
                                            cwd=self.build))
            built = re.search(r" -o (\S+\.o) ", self.commands[name])[1]
            # Links the new object instead of the test's own. If the object replaces one of the library, it comes first, and
            # the linker omits the library's.
            link = link.replace(f" {built} ", f" {target} ") if f" {built} " in link else link.replace(
                " -o ", f" {target} -o ", 1)
        if any([process.wait() for process in running]):
            sys.exit(f"{file} does not compile")
        subprocess.run(shlex.split(link), cwd=self.build, check=True)

    def failing(self):
        """Returns the names of the tests that fail."""
        result = subprocess.run([self.copy / "bounds_test", "--gtest_brief=1"], capture_output=True, text=True, check=False)
        return sorted(set(re.findall(r"^\[  FAILED  \] (\w+\.\w+)", result.stdout, re.M))) or result.returncode * ["?"]


def main():
    copy, names = Path(sys.argv[2]).resolve(), sys.argv[3:]
    copy.mkdir(parents=True, exist_ok=True)
    shutil.copytree(SOURCE / "src", copy / "src", copy_function=faults.copy_changed, dirs_exist_ok=True)
    build = Build(Path(sys.argv[1]).resolve(), copy)
    for part in PARTS:
        build.make(part)
        if build.failing():
            sys.exit("tests fail without any bound halved")
    unnoticed = 0
    for name, file, before, after in faults.read(TESTS / "mutations.txt"):
        if names and not any(part in name for part in names):
            continue
        path = copy / "src" / file
        text = path.read_text(encoding="utf-8")
        is_proved = after == "proof"
        if text.count(before) != 1 and not (is_proved and before in text):
            print(f"STALE      {name}: {file} has it {text.count(before)} times", flush=True)
            unnoticed += 1
            continue
        if is_proved:
            print(f"proof      {name}", flush=True)
            continue
        try:
            path.write_text(text.replace(before, after), encoding="utf-8")
            build.make(file)
            failing = build.failing()
        finally:
            path.write_text(text, encoding="utf-8")
        print(f"{'caught   ' if failing else 'UNNOTICED'}  {name}" + (f"  {failing}" if failing else ""), flush=True)
        unnoticed += not failing
    sys.exit(1 if unnoticed else 0)


if __name__ == "__main__":
    main()
