#!/usr/bin/env python3
"""Checks that builds by other compilers give the same outputs for questions.txt as a program, with every instruction set and
different numbers of threads.

usage: same_bits.py PROGRAM OTHER_PROGRAM
       same_bits.py PROGRAM --build SOURCE_FOLDER BUILD_FOLDER

The second form makes all builds that are listed below.
"""

import itertools
import os
import shutil
import subprocess
import sys
from pathlib import Path

import questions

ISAS = ["portable", "avx2", "avx512"]  # an instruction set that the machine lacks falls back to portable
THREADS = [1, 2, 7]
VARIANTS = {
    "clang-O0": ("clang++", "-O0"),
    "gcc-O0": ("g++", "-O0"),
    "gcc-O1": ("g++", "-O1 -DNDEBUG"),
    "gcc-O2": ("g++", "-O2 -DNDEBUG"),
    "gcc-O3-native": ("g++", "-O3 -march=native -DNDEBUG"),
    "clang-O2": ("clang++", "-O2 -DNDEBUG"),
    "clang-O3-native": ("clang++", "-O3 -march=native -DNDEBUG"),
}


def build(source, folder, compiler, flags):
    """Returns the program of a build. Also builds the modules that the questions need."""
    subprocess.run(["cmake", "-S", source, "-B", folder, "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={compiler}",
                    "-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={flags}",
                    "-DMICROTRACE_BUILD_TESTS=OFF", "-DMICROTRACE_BUILD_BENCHMARKS=OFF", "-DMICROTRACE_UNITY=ON",
                    *(f"-DMICROTRACE_WITH_{module}=OFF" for module in ("OPENIMAGEIO", "DRACO"))],
                   check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "--target", "microtrace", "microtrace_codecs", "microtrace_openexr",
                    "microtrace_meshopt"],
                   check=True, stdout=subprocess.DEVNULL)
    return folder / "src/cli/microtrace"


def build_all(source, parent):
    """Returns the programs of all builds by name."""
    for compiler in {compiler for compiler, _ in VARIANTS.values()}:
        if not shutil.which(compiler):
            sys.exit(f"{compiler} is not installed; ./test installs it")
    return {name: build(source, parent / name, *how) for name, how in VARIANTS.items()}


def main():
    os.environ.pop("MICROTRACE_MODULE_PATH", None)  # each build must use its own modules
    program, other, *folders = sys.argv[1:]
    is_long = other == "--build"
    others = build_all(*map(Path, folders)) if is_long else {"the other build": other}
    programs = {name: os.path.abspath(path) for name, path in ({"this build": program} | others).items()}
    everything = list(itertools.product(ISAS, THREADS))
    few = itertools.cycle([[("portable", 1)], [("avx512", 2)], [("avx2", 7)]])
    differing = 0
    listed = questions.read()[1]
    for question in listed:
        expected = None
        compared = 0
        for name, program in programs.items():
            # The other build of the short form is one for the thread sanitizer, which takes ten times as long.
            for isa, threads in everything if is_long or name == "this build" else next(few):
                # One thread renders samples in passes; seven threads render tile by tile.
                answer = questions.ask(program, question, threads, isa, with_samples=threads < 7)
                expected = expected or answer
                compared += 1
                for part, digest in answer.items():
                    if digest != expected[part]:
                        differing += 1
                        print(f"DIFFERENT {part}: {question.text}: {name}, {isa}, {threads} threads")
        print(f"{compared} combinations: {question.text}", flush=True)
    assert any(question.has_light for question in listed)
    sys.exit(1 if differing else 0)


if __name__ == "__main__":
    main()
