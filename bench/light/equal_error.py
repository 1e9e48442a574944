#!/usr/bin/env python3
"""Measures how long microtrace takes to reach the error of Mitsuba 3's picture of the helmet with 64 spp.

usage: equal_error.py FOLDER MICROTRACE [--env constant|sky] [--size WxH] [--reference N] [--variant NAME] [--seeds N]
Each picture is compared with a reference by the same program with many samples and another seed, because the programs'
materials differ. The error is the root mean square error of linear radiance over all pixels and channels.
"""
import argparse
import pathlib

import mitsuba as mi
import numpy as np

import time_helmet

SAMPLES = (1, 2, 4, 8, 16, 32, 64, 128)


def read(path):
    return np.array(mi.Bitmap(str(path)).convert(component_format=mi.Struct.Type.Float32))[..., :3].astype(float)


def mean_error(pictures, reference):
    return float(np.sqrt(np.mean([(picture - reference) ** 2 for picture in pictures])))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("program")
    parser.add_argument("--env", choices=time_helmet.ENVIRONMENTS, default="constant")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--reference", type=int, default=4096)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--seeds", type=int, default=1, help="pictures for each error, the root of their mean square")
    options = parser.parse_args()
    mi.set_variant("scalar_rgb")
    folder, program = options.folder, str(pathlib.Path(options.program).resolve())
    width, height = options.size.split("x")

    def ours(spp, seed):
        """Returns the picture and the processor seconds of rendering."""
        seconds = time_helmet.ours(program, folder, options.env, spp, options.size, seed=seed)[1]
        return read(folder / "ours.exr"), seconds

    def theirs(spp, passes, seed, variant):
        seconds = time_helmet.mitsuba(variant, folder, options.env, spp, passes, seed, (width, height))[1]
        return np.load(folder / f"{variant}.npy")[..., :3].astype(float), seconds

    reference = theirs(256, options.reference // 256, 1000, "llvm_ad_rgb")[0]
    goal = mean_error([theirs(64, 1, 1 + seed, options.variant)[0] for seed in range(options.seeds)], reference)
    seconds = theirs(64, 2, 1, options.variant)[1]
    print(f"{options.variant}: 64 spp, {options.size}: error {goal:.5f}, {seconds:.2f} s")

    reference = ours(options.reference, 1)[0]
    errors, times = [], []
    for spp in SAMPLES:
        pictures, seconds_ours = zip(*(ours(spp, seed) for seed in range(2, 2 + options.seeds)))
        errors.append(mean_error(pictures, reference))
        times.append(float(np.mean(seconds_ours)))
        print(f"microtrace: {spp} spp: error {errors[-1]:.5f}, {times[-1]:.2f} s")
    # Interpolates between logarithms, because error and samples are nearly a straight line on logarithmic scales.
    spp = np.exp(np.interp(-np.log(goal), -np.log(errors), np.log(SAMPLES)))
    time = times[-1] * spp / SAMPLES[-1]
    slope = np.polyfit(np.log(SAMPLES), np.log(errors), 1)[0]
    print(f"microtrace has that error at {spp:.1f} spp, {time:.2f} s; Mitsuba takes {seconds / time:.2f} times as long; "
          f"our error goes as spp^{slope:.2f}")


if __name__ == "__main__":
    main()
