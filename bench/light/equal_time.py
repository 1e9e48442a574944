#!/usr/bin/env python3
"""Compares the noise of microtrace, Mitsuba 3 (LLVM) and Blender's Cycles after equal processor time.

usage: equal_time.py FOLDER MICROTRACE [--cycles PYTHON] [--seconds S] [--seeds N] [--only A,B] [--scenes SCENE...]
The scenes are those of hard_scenes.py. PYTHON is a Python in which bpy can be imported. Each program renders on one
thread; loading and compiling don't count. Each gets the number of samples that takes it about S seconds. The error is
the root mean square of the difference from a long reference by the same program with another seed, because the
programs' models differ a little. It is given as error * sqrt(time), relative to microtrace's: for linear radiance, and
for x / (1 + x), in which single bright pixels don't dominate. References are kept in FOLDER. --options is a list of
options of microtrace; each is a further row.
"""
import argparse
import pathlib

import numpy as np
from renderers import Cycles, Microtrace, Mitsuba  # sets Mitsuba's variant, which hard_scenes needs

import hard_scenes

REFERENCE = 12  # times as long


def shown(picture):
    return picture / (1 + np.maximum(picture, 0))


def rms(pictures):
    return float(np.sqrt(np.mean(np.square(pictures))))


def measure(renderer, folder, scene, size, options):
    """Returns the mean seconds, the two errors times the root of the seconds, and the mean radiance."""
    renderer.load(folder, scene, size)
    trial = 16
    seconds, _ = renderer.render(trial, 1)
    while seconds < options.seconds / 8 and trial < 1 << 14:
        trial *= 4
        seconds, _ = renderer.render(trial, 1)
    longer = renderer.render(4 * trial, 1)[0]
    of_sample = max(longer - seconds, 1e-6) / (3 * trial)  # the rest doesn't depend on samples, such as training
    spp = int(np.clip(round((options.seconds - (seconds - of_sample * trial)) / of_sample), 1, 65536))
    kept = folder / f"{scene.name}_{renderer.model}_reference.npy"
    if not kept.exists():
        reference = renderer.render(min(REFERENCE * spp, 65536), 9999)[1]
        np.save(kept, reference)
    reference = np.load(kept)
    runs = [renderer.render(spp, 1 + seed) for seed in range(options.seeds)]
    time_of = float(np.mean([run[0] for run in runs]))
    linear = rms([run[1] - reference for run in runs])
    mapped = rms([shown(run[1]) - shown(reference) for run in runs])
    return spp, time_of, linear * time_of**0.5, mapped * time_of**0.5, float(np.mean([run[1] for run in runs]))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("program")
    parser.add_argument("--cycles", metavar="PYTHON")
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--options", nargs="*", default=[], help="for example --guiding")
    parser.add_argument("--only", default="microtrace,mitsuba,cycles")
    parser.add_argument("--scenes", nargs="*", metavar="SCENE")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    size = tuple(map(int, options.size.split("x")))
    program = str(pathlib.Path(options.program).resolve())
    only = options.only.split(",")
    print("scene | program | spp | CPU s | error sqrt(s) | after x / (1 + x) | relative | relative | mean", flush=True)
    for name in options.scenes or hard_scenes.SCENES:
        scene = hard_scenes.SCENES[name](options.folder).finish()
        renderers = [Microtrace(program)]
        renderers += [Microtrace(program, extra.split()) for extra in options.options]
        renderers += [Mitsuba()] if "mitsuba" in only else []
        if options.cycles and "cycles" in only:
            renderers += [Cycles(options.cycles, False), Cycles(options.cycles, True)]
        ours = None
        for renderer in renderers:
            spp, seconds, linear, mapped, mean = measure(renderer, options.folder, scene, size, options)
            ours = ours or (linear, mapped)
            print(f"{name} | {renderer.name} | {spp} | {seconds:.2f} | {linear:.4f} | {mapped:.4f} | "
                  f"{linear / ours[0]:.2f} | {mapped / ours[1]:.2f} | {mean:.4f}", flush=True)


if __name__ == "__main__":
    main()
