#!/usr/bin/env python3
"""Builds the program again by other compilers and without optimisation, and checks that every build draws the same bytes
with every instruction set and any number of threads.

usage: same_bits.py PROGRAM SOURCE_FOLDER BUILD_FOLDER
"""

import hashlib
import itertools
import os
import shutil
import subprocess
import sys
from pathlib import Path

PROGRAM, SOURCE, FOLDER = os.path.abspath(sys.argv[1]), Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
SCENES = ["perspective1.json", "perspective2.json", "perspective3.json", "environment.json",
          "orthographic.json", "hyperboloid.json"]
QUESTIONS = [[scene, "-o", "-"] for scene in SCENES] + [
    ["perspective2.json", "--spp", "7", "-o", "-"],
    ["gltf/knot.glb", "--integrator", "flat", "-o", "-"],
    ["gltf/textures.glb", "--integrator", "flat", "-o", "-"],
    ["gltf/cube.glb", "--view", "-71,33", "--integrator", "normal", "-o", "-"],
    ["gltf/knot.glb", "--integrator", "barycentric", "-o", "-"],
    ["gltf/knot.glb", "--integrator", "path", "--spp", "3", "--size", "160x120", "-o", "-"],
    ["gltf/knot.glb", "--integrator", "path", "--spp", "2", "--size", "120x90", "--env", "studio", "--env-rotation", "40",
     "--background", "env", "--exposure", "0.3", "--tonemap", "agx", "-o", "-"],
    ["framed.json", "--integrator", "depth", "-o", "-"],
    # The framed camera's numbers and the boxes to their last digit.
    ["perspective1.json", "--view", "12.5,-61", "-o", "/dev/null", "--sidecar", "-"],
    ["gltf/knot.glb", "--view", "-200,10", "--integrator", "flat", "-o", "/dev/null", "--sidecar", "-"],
]
ISAS = ["portable", "avx2", "avx512"]  # one that the machine lacks falls back to portable
VARIANTS = {
    "gcc-debug": {"CMAKE_CXX_COMPILER": "g++", "CMAKE_BUILD_TYPE": "Debug"},
    "clang-release": {"CMAKE_CXX_COMPILER": "clang++", "CMAKE_BUILD_TYPE": "Release"},
}


def build(name, settings):
    folder = FOLDER / name
    options = [f"-D{key}={value}" for key, value in settings.items()]
    subprocess.run(["cmake", "-S", SOURCE, "-B", folder, "-G", "Ninja", *options,
                    "-DMICROTRACE_BUILD_TESTS=OFF", "-DMICROTRACE_BUILD_BENCHMARKS=OFF",
                    "-DMICROTRACE_WITH_OPENIMAGEIO=OFF"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder, "--target", "microtrace", "microtrace_codecs"], check=True,
                   stdout=subprocess.DEVNULL)
    return folder / "src/cli/microtrace"


def digest(program, question, isa, threads):
    answer = subprocess.run([program, *question, "-t", str(threads)], check=True, capture_output=True,
                            cwd=SOURCE / "scenes", env=dict(os.environ, MICROTRACE_ISA=isa)).stdout
    assert answer, question
    return hashlib.sha256(answer).hexdigest()


for compiler in {settings["CMAKE_CXX_COMPILER"] for settings in VARIANTS.values()}:
    if not shutil.which(compiler):
        sys.exit(f"{compiler} is not installed; ./test installs it")
programs = {"this build": PROGRAM} | {name: build(name, s) for name, s in VARIANTS.items()}
differing = 0
for question in QUESTIONS:
    digests = {(name, isa, threads): digest(program, question, isa, threads)
               for (name, program), isa, threads in itertools.product(programs.items(), ISAS, (1, 2))}
    expected = digests["this build", "portable", 1]
    print(f"{' '.join(question)}: {expected[:16]} from {len(digests)} combinations")
    for combination, value in digests.items():
        if value != expected:
            differing += 1
            print(f"  {combination} gives {value[:16]}")
sys.exit(1 if differing else 0)
