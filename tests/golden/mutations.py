#!/usr/bin/env python3
"""Applies the faults of mutations.txt one at a time to a copy of the source. Builds the program with each fault and runs
the command lines of questions.txt. If no output changes, the fault is undetected.

usage: mutations.py PROGRAM FOLDER [NAME...]

PROGRAM is a build of the unchanged source. Its modules are used. FOLDER receives the copy and the copy's build. If NAMEs
are given, only faults whose name contains one of them are tried. Not part of ctest, because it takes more than an hour.
The exit status is 1 if a fault is undetected or can no longer be applied to the source.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parent
SOURCE = TESTS.parents[1]
PARTS = ["CMakeLists.txt", "CMakePresets.json", "LICENSE", "cmake", "docs", "include", "src", "third_party"]


def read(path):
    """Yields (name, file, text, replacement) for each block."""
    for block in path.read_text(encoding="ascii").split("\n\n"):
        lines = [line for line in block.splitlines() if not line.startswith("#")]
        if lines:
            name, file, before, after = lines
            assert file.startswith("in ") and before.startswith("- ") and after.startswith("+ "), block
            yield name, file[3:], before[2:], after[2:]


def copy_changed(source, target):
    """Copies a file only if it differs, so that nothing else is rebuilt."""
    if not Path(target).exists() or Path(source).read_bytes() != Path(target).read_bytes():
        shutil.copyfile(source, target)


def build(copy):
    subprocess.run(["cmake", "--build", copy / "build/release", "--target", "microtrace"], check=True, capture_output=True)


def is_caught(copy):
    """Returns the first output that differs, or None."""
    result = subprocess.run([sys.executable, "-B", TESTS / "pinned_test.py", copy / "build/release/src/cli/microtrace",
                             "--threads", "2", "--first-only"], capture_output=True, text=True, check=False)
    if result.returncode == 0:
        return None
    differing = [line for line in result.stdout.splitlines() if line.startswith("DIFFERENT")]
    return differing[0].split(maxsplit=1)[1] if differing else result.stderr.strip().splitlines()[-1]


def main():
    program, copy, names = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3:]
    os.environ["MICROTRACE_MODULE_PATH"] = str(program.parents[1] / "lib/microtrace")
    copy.mkdir(parents=True, exist_ok=True)
    for part in PARTS:
        if (SOURCE / part).is_dir():
            shutil.copytree(SOURCE / part, copy / part, copy_function=copy_changed, dirs_exist_ok=True)
        else:
            copy_changed(SOURCE / part, copy / part)
    subprocess.run(["cmake", "--preset", "release", "-DMICROTRACE_BUILD_TESTS=OFF", "-DMICROTRACE_BUILD_BENCHMARKS=OFF",
                    "-DMICROTRACE_WITH_OPENIMAGEIO=OFF", "-DMICROTRACE_WITH_DRACO=OFF",
                    "-DMICROTRACE_WITH_CODECS=OFF", "-DMICROTRACE_WITH_OPENEXR=OFF"], cwd=copy, check=True, stdout=subprocess.DEVNULL)
    build(copy)
    if is_caught(copy):
        sys.exit("the answers differ without any fault; run pinned_test.py first")
    unnoticed = 0
    for name, file, before, after in read(TESTS / "mutations.txt"):
        if names and not any(part in name for part in names):
            continue
        path = copy / "src" / file
        text = path.read_text(encoding="utf-8")
        if text.count(before) != 1:
            print(f"STALE      {name}: {file} has it {text.count(before)} times", flush=True)
            unnoticed += 1
            continue
        try:
            path.write_text(text.replace(before, after), encoding="utf-8")
            build(copy)
            difference = is_caught(copy)
        finally:
            path.write_text(text, encoding="utf-8")
        print(f"{'caught   ' if difference else 'UNNOTICED'}  {name}" + (f"  [{difference}]" if difference else ""), flush=True)
        unnoticed += not difference
    sys.exit(1 if unnoticed else 0)


if __name__ == "__main__":
    main()
