"""Renders a scene of hard_scenes.py by microtrace, Mitsuba 3 (LLVM) and Blender's Cycles, each on one thread.

A renderer has a name, the name of its model, load(folder, scene, size), and render(spp, seed), which returns the
processor time in seconds and the picture. Loading and compiling don't count.
"""
import json
import pathlib
import subprocess
import sys
import time

import drjit
import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")

import time_helmet  # noqa: E402

CHUNK = 1024  # samples of one call of Mitsuba


class Microtrace:
    def __init__(self, program, extra=()):
        self.name, self.model = " ".join(["microtrace", *extra]), "microtrace"
        self.program, self.extra = program, list(extra)

    def load(self, folder, scene, size):
        self.folder, self.scene, self.size = folder, scene, size

    def render(self, spp, seed):
        scene = self.scene
        command = [self.program, f"{scene.name}.glb", "-q", "-t", "1", "--integrator", "path", "--background", "env",
                   "--spp", str(spp), "--seed", str(seed), "--max-depth", str(scene.depth), "--size",
                   "x".join(map(str, self.size)), *scene.options, *self.extra, "-o", "ours.exr"]
        whole, _ = time_helmet.cpu(command, self.folder)
        short = [option for option in command[:-1] if option not in self.extra]
        rest, _ = time_helmet.cpu([*short, "pixel.exr", "--crop", "0,0,1,1"], self.folder)
        picture = np.array(mi.Bitmap(str(self.folder / "ours.exr")))[..., :3]
        return max(whole - rest, 1e-3), picture.astype(float)


class Mitsuba:
    name = model = "Mitsuba"

    def load(self, folder, scene, size):
        film = scene.mitsuba["sensor"]["film"]
        film["width"], film["height"] = size
        drjit.set_thread_count(2)
        self.scene = mi.load_dict(scene.mitsuba)
        self.once(4, 0)  # compiles

    def once(self, spp, seed):
        drjit.set_thread_count(1)
        begin = time.process_time()
        picture = np.array(mi.render(self.scene, spp=spp, seed=seed), dtype=float)
        seconds = time.process_time() - begin
        drjit.set_thread_count(2)  # Mitsuba can't read pictures with a single thread
        return seconds, picture[..., :3]

    def render(self, spp, seed):
        parts = [CHUNK] * (spp // CHUNK) + [spp % CHUNK] * (spp % CHUNK > 0)
        runs = [(part, *self.once(part, seed * 1000 + i)) for i, part in enumerate(parts)]
        return sum(run[1] for run in runs), sum(run[0] * run[2] for run in runs) / spp


class Cycles:
    def __init__(self, python, guiding):
        self.name, self.model = "Cycles" + (" guided" if guiding else ""), "Cycles"
        self.python, self.guiding = python, guiding

    def load(self, folder, scene, size):
        self.folder = folder
        light = ["--sky", str(folder / "sky.exr")] if scene.options[1] == "sky.exr" else ["--uniform", scene.options[1].split(",")[0]]
        self.command = [self.python, str(pathlib.Path(__file__).with_name("cycles_render.py")), str(folder / f"{scene.name}.glb"),
                        "--size", "x".join(map(str, size)), "--depth", str(scene.depth), *light]
        self.command += ["--guiding"] if self.guiding else []

    def render(self, spp, seed):
        out = self.folder / "cycles.npy"
        done = subprocess.run([*self.command, f"{spp}:{seed}:{out}"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stderr)
        return json.loads(done.stdout.strip().splitlines()[-1])[0], np.load(out).astype(float)
