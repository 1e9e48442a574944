#!/usr/bin/env python3
"""Measures the processor time of microtrace and of Mitsuba 3 (LLVM) for scenes in which light is hard to find.

usage: time_scenes.py FOLDER MICROTRACE [--runs N] [--spp N] [--size WxH] [SCENE...]
Both render at equal size, samples and depth on one thread, alternately. Loading and compiling don't count.
"""
import argparse
import pathlib
import statistics
import time

import drjit
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
drjit.set_thread_count(1)

import hard_scenes  # noqa: E402, needs the variant
import time_helmet  # noqa: E402


def ours(program, folder, scene, spp, size, seed):
    """Returns the seconds of rendering: the difference from a process that renders one pixel."""
    command = [program, f"{scene.name}.glb", "-q", "-t", "1", "--integrator", "path", "--background", "env", "--spp", str(spp),
               "--seed", str(seed), "--max-depth", str(scene.depth), "--size", "x".join(map(str, size)), *scene.options,
               "-o", f"{scene.name}_ours.exr"]
    whole, _ = time_helmet.cpu(command, folder)
    rest, _ = time_helmet.cpu([*command[:-1], "pixel.exr", "--crop", "0,0,1,1"], folder)
    return whole - rest


def theirs(scene, spp, seed):
    begin = time.process_time()
    picture = np.array(mi.render(scene, spp=spp, seed=seed))
    return time.process_time() - begin, picture


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("program")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    options.folder.mkdir(parents=True, exist_ok=True)
    size = tuple(map(int, options.size.split("x")))
    print("scene | CPU s, ours | Mitsuba LLVM's | ratio | mean, ours | Mitsuba's", flush=True)
    for name in options.scenes or hard_scenes.SCENES:
        scene = hard_scenes.SCENES[name](options.folder).finish()
        film = scene.mitsuba["sensor"]["film"]
        film["width"], film["height"] = size
        loaded = mi.load_dict(scene.mitsuba)
        theirs(loaded, options.spp, 99)  # compiles
        a, b, pictures = [], [], []
        for seed in range(options.runs):
            a.append(ours(program, options.folder, scene, options.spp, size, seed))
            seconds, picture = theirs(loaded, options.spp, seed)
            b.append(seconds)
            pictures.append(picture[..., :3])
        mean = np.array(mi.Bitmap(str(options.folder / f"{name}_ours.exr")))[..., :3].mean()
        print(f"{name} | {statistics.median(a):.2f} | {statistics.median(b):.2f} | {statistics.median(b) / statistics.median(a):.2f} | "
              f"{mean:.5f} | {np.mean(pictures):.5f}", flush=True)


if __name__ == "__main__":
    main()
