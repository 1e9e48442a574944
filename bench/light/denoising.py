#!/usr/bin/env python3
"""Measures how many samples the denoiser is worth.

usage: denoising.py FOLDER MICROTRACE [--spp N] [--reference N] [--size WxH] [SCENE...]
SCENE is a scene of hard_scenes.py or a glTF file; by default, all of the former. MICROTRACE_OIDN_PATH names the denoiser.
Prints the root mean square error of a picture of N samples in levels of its 8-bit values, without and with the denoiser,
against a picture of many samples. The square of their ratio is the number of times as many samples that give the
error of the denoised picture.
"""
import argparse
import pathlib
import subprocess

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")

import hard_scenes  # noqa: E402, needs the variant


def picture(command, file):
    subprocess.run([*command, "-o", str(file)], check=True)
    return np.array(mi.Bitmap(str(file)))[..., :3].astype(float)


def rms(difference):
    return np.sqrt(np.mean(difference**2))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("program")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--reference", type=int, default=4096)
    parser.add_argument("--size", default="320x240")
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    options.folder.mkdir(parents=True, exist_ok=True)
    print("scene | rms, noisy | denoised | worth, times as many samples", flush=True)
    for name in options.scenes or hard_scenes.SCENES:
        command = [program, name, "-q", "--size", options.size]
        if name in hard_scenes.SCENES:
            scene = hard_scenes.SCENES[name](options.folder).finish()
            command = [program, str(options.folder / f"{name}.glb"), "-q", "--size", options.size, "--background", "env",
                       "--max-depth", str(scene.depth), *scene.options]
        file = options.folder / "picture.png"
        reference = picture([*command, "--spp", str(options.reference), "--seed", "1"], file)
        noisy = picture([*command, "--spp", str(options.spp)], file)
        denoised = picture([*command, "--spp", str(options.spp), "--denoise"], file)
        before, after = rms(noisy - reference), rms(denoised - reference)
        print(f"{pathlib.Path(name).stem} | {before:.2f} | {after:.2f} | {(before / after)**2:.1f}", flush=True)


if __name__ == "__main__":
    main()
