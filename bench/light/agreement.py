#!/usr/bin/env python3
"""Compares pictures by microtrace with pictures by Mitsuba 3, for scenes that both programs support.

usage: agreement.py FOLDER MICROTRACE [--spp N] [--seeds N] [SCENE...]
SCENE is a scene of hard_scenes.py; without it, the scenes of agreement_scenes.py are compared.
Each program renders several pictures of each scene with different seeds. The differences between the programs' means
over blocks of pixels, divided by their standard deviations, must look normally distributed. Writes the scenes and the
mean pictures to FOLDER.
"""
import argparse
import pathlib

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")

import agreement_scenes  # noqa: E402, needs the variant
import hard_scenes  # noqa: E402
import time_helmet  # noqa: E402

BLOCK = 8  # in pixels


def blocks(picture):
    height, width, channels = picture.shape
    return picture.reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, channels).mean((1, 3))


def ours(program, folder, scene, spp, seed):
    command = [program, f"{scene.name}.glb", "-q", "--integrator", "path", "--background", "env", "--spp", str(spp),
               "--seed", str(seed), "--max-depth", str(scene.depth), "--size", "128x96", "-o", "ours.exr"]
    time_helmet.cpu(command + scene.options, folder)
    return np.array(mi.Bitmap(str(folder / "ours.exr")))[..., :3].astype(float)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("program")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("scenes", nargs="*", metavar="SCENE")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    options.folder.mkdir(parents=True, exist_ok=True)
    print("scene | mean, ours | Mitsuba's | difference of means, sigma | of blocks, sigma: root of mean square | largest",
          flush=True)
    if options.scenes:
        scenes = [hard_scenes.SCENES[name](options.folder).finish() for name in options.scenes]
    else:
        scenes = agreement_scenes.write(options.folder)
    for scene in scenes:
        theirs = mi.load_dict(scene.mitsuba)
        a, b = [], []
        for seed in range(options.seeds):
            a.append(ours(program, options.folder, scene, options.spp, seed))
            picture = np.array(mi.render(theirs, spp=options.spp, seed=seed), dtype=float)
            b.append(picture[..., :3])
        for name, pictures in (("ours", a), ("mitsuba", b)):
            mi.Bitmap(np.mean(pictures, 0).astype(np.float32)).write(str(options.folder / f"{scene.name}_{name}.exr"))
        n = options.seeds
        whole_a, whole_b = ([p.mean() for p in pictures] for pictures in (a, b))
        deviation = np.sqrt((np.var(whole_a, ddof=1) + np.var(whole_b, ddof=1)) / n)
        small_a, small_b = (np.array([blocks(p)[..., 1] for p in pictures]) for pictures in (a, b))
        z = small_a.mean(0) - small_b.mean(0)
        spread = np.sqrt((small_a.var(0, ddof=1) + small_b.var(0, ddof=1)) / n)
        # Other blocks show only the sky, whose pixels the programs place differently.
        lit = spread > 1e-3 * small_b.mean(0)
        z = np.abs(z[lit] / spread[lit])
        print(f"{scene.name} | {np.mean(whole_a):.5f} | {np.mean(whole_b):.5f} | "
              f"{(np.mean(whole_a) - np.mean(whole_b)) / deviation:.2f} | {np.sqrt(np.mean(z**2)):.2f} | {z.max():.1f}", flush=True)


if __name__ == "__main__":
    main()
