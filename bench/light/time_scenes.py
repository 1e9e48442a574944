#!/usr/bin/env python3
"""Measures the processor time of microtrace and of Mitsuba 3 (LLVM) for scenes in which light is hard to find.

usage: time_scenes.py FOLDER MICROTRACE [--runs N] [--spp N] [--size WxH] [SCENE...]
Both render at equal size, samples and depth on one thread, alternately. Loading and compiling don't count.
"""
import argparse
import pathlib
import statistics

from renderers import Microtrace, Mitsuba  # sets Mitsuba's variant, which hard_scenes needs

import hard_scenes


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
        ours, theirs = Microtrace(program), Mitsuba()
        runs = {ours: [], theirs: []}
        for renderer in runs:
            renderer.load(options.folder, scene, size)
        theirs.render(options.spp, 99)  # compiles
        for seed in range(options.runs):
            for renderer, results in runs.items():
                results.append(renderer.render(options.spp, seed))
        a, b = (statistics.median(seconds for seconds, _ in results) for results in runs.values())
        means = (statistics.mean(float(picture.mean()) for _, picture in results) for results in runs.values())
        print(f"{name} | {a:.2f} | {b:.2f} | {b / a:.2f} | " + " | ".join(f"{mean:.5f}" for mean in means), flush=True)


if __name__ == "__main__":
    main()
