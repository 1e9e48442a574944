#!/usr/bin/env python3
"""Measures the processor time of microtrace, Mitsuba 3 (LLVM) and Blender's Cycles for scenes in which light is hard to
find, and for scenes like common models.

usage: time_scenes.py FOLDER MICROTRACE [--cycles PYTHON] [--runs N] [--spp N] [--size WxH] [SCENE...]
All render at equal size, samples and depth on one thread, alternately. Loading and compiling don't count. PYTHON is a
Python in which bpy can be imported.
"""
import argparse
import pathlib
import statistics

from renderers import Cycles, Microtrace, Mitsuba  # sets Mitsuba's variant, which the scenes need

import hard_scenes
import model_scenes

SCENES = hard_scenes.SCENES | model_scenes.SCENES


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("program")
    parser.add_argument("--cycles", metavar="PYTHON")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    options = parser.parse_intermixed_args()
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    program = str(pathlib.Path(options.program).resolve())
    size = tuple(map(int, options.size.split("x")))
    renderers = [Microtrace(program), Mitsuba()] + ([Cycles(options.cycles, False)] if options.cycles else [])
    print("scene | program | CPU s | relative to microtrace | mean", flush=True)
    for name in options.scenes or SCENES:
        scene = SCENES[name](folder).finish()
        for renderer in renderers:
            renderer.load(folder, scene, size)
        renderers[1].render(options.spp, 99)  # compiles
        runs = [[renderer.render(options.spp, seed) for renderer in renderers] for seed in range(options.runs)]
        seconds = [statistics.median(time for time, _ in results) for results in zip(*runs)]
        for renderer, time, results in zip(renderers, seconds, zip(*runs)):
            mean = statistics.mean(float(picture.mean()) for _, picture in results)
            print(f"{name} | {renderer.name} | {time:.2f} | {time / seconds[0]:.2f} | {mean:.5f}", flush=True)


if __name__ == "__main__":
    main()
