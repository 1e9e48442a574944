#!/usr/bin/env python3
"""Measures the processor time of microtrace and of Mitsuba 3 for the helmet, alternately, each on one thread.

usage: time_helmet.py FOLDER MICROTRACE [--runs N] [--spp N] [--env constant|sky] [--variants A,B]
FOLDER is the folder that helmet.py wrote. The Python that runs this script must be able to import `mitsuba`.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys

HERE = pathlib.Path(__file__).parent.resolve()
ENVIRONMENTS = {"constant": "1,1,1", "sky": "sky.hdr"}


def cpu(command, folder):
    """Runs a command. Returns the user and system time of its process in seconds, and its output."""
    before = os.times()
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    after = os.times()
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return seconds, done.stdout


def ours(program, folder, env, spp, size="640x480", seed=0):
    """Returns the seconds of (the whole process, rendering only). Rendering is the difference from a process that
    renders one pixel."""
    command = [program, "helmet.glb", "-q", "-t", "1", "--integrator", "path", "--max-depth", "8", "--env", ENVIRONMENTS[env],
               "--background", "env", "--size", size, "--spp", str(spp), "--seed", str(seed), "-o", "ours.exr"]
    whole, _ = cpu(command, folder)
    rest, _ = cpu(command[:-1] + ["pixel.exr", "--crop", "0,0,1,1"], folder)
    return whole, whole - rest


def mitsuba(variant, folder, env, spp, passes=1, seed=0, size=("640", "480")):
    """Like ours(), with the rendering time that mitsuba_render.py measures. Only the last pass counts, because the
    first pass of llvm_ad_rgb also compiles the kernel or reads it from the cache."""
    command = [sys.executable, str(HERE / "mitsuba_render.py"), "helmet.xml", "--variant", variant,
               "--passes", str(passes), "--seed", str(seed), "--out", f"{variant}.npy", f"spp={spp}", f"env={env}",
               f"width={size[0]}", f"height={size[1]}"]
    whole, text = cpu(command, folder)
    renders = json.loads(text)["render_s"]
    return whole - sum(renders[:-1]), renders[-1]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("program")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--env", choices=ENVIRONMENTS, default="constant")
    parser.add_argument("--variants", default="scalar_rgb,llvm_ad_rgb")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    variants = options.variants.split(",")
    times = {name: [] for name in ["microtrace"] + variants}
    for _ in range(options.runs):
        times["microtrace"].append(ours(program, options.folder, options.env, options.spp))
        for variant in variants:
            passes = 1 if variant.startswith("scalar") else 2
            times[variant].append(mitsuba(variant, options.folder, options.env, options.spp, passes))
    print("CPU seconds, median of", options.runs, "| whole process | range | rendering | range")
    medians = {}
    for name, pairs in times.items():
        columns = list(zip(*pairs))
        medians[name] = [statistics.median(c) for c in columns]
        print(name, *(f"| {m:.2f} | {min(c):.2f} .. {max(c):.2f}" for m, c in zip(medians[name], columns)))
    for name in variants:
        ratios = (a / b for a, b in zip(medians[name], medians["microtrace"]))
        print(f"{name} / microtrace", *(f"| {r:.2f} |" for r in ratios))


if __name__ == "__main__":
    main()
