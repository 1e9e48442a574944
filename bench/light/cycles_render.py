#!/usr/bin/env python3
"""Renders a glTF file with Blender's Cycles on one thread, from the file's camera, and prints processor times as JSON.

usage: cycles_render.py SCENE.glb --size WxH --depth N (--sky FILE | --uniform RADIANCE) [--guiding] RUN...
RUN is SAMPLES:SEED:FILE.npy. Prints for each the seconds of rendering, less those of a picture of one pixel.
Needs Blender as a Python module (bpy 5.0).
"""
import argparse
import json
import pathlib
import sys
import tempfile
import time

import bpy
import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from against_cycles import read, set_sky


def load(options):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # The importer divides light intensities by 683 lumens per watt without this option.
    bpy.ops.import_scene.gltf(filepath=options.scene, export_import_convert_lighting_mode="COMPAT")
    for material in bpy.data.materials:
        material.cycles.emission_sampling = "FRONT"  # the other side is black
    scene = bpy.context.scene
    scene.camera = next(thing for thing in bpy.data.objects if thing.type == "CAMERA")
    if options.sky:
        set_sky(options.sky)
    else:
        scene.world = bpy.data.worlds.new("sky")
        scene.world.use_nodes = True
        background = scene.world.node_tree.nodes["Background"]
        background.inputs[0].default_value = [options.uniform] * 3 + [1]
    return scene


def set_up(scene, options):
    scene.render.engine = "CYCLES"
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.use_guiding = options.guiding
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
        setattr(cycles, "max_bounces" if kind == "max" else f"{kind}_bounces", options.depth - 1)
    cycles.transparent_max_bounces = 64
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    width, height = map(int, options.size.split("x"))
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"


def render(scene, spp, seed, path):
    scene.cycles.samples, scene.cycles.seed = spp, seed
    scene.render.filepath = str(path)
    begin = time.process_time()
    bpy.ops.render.render(write_still=True)
    return time.process_time() - begin


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--depth", type=int, default=8)
    parser.add_argument("--sky")
    parser.add_argument("--uniform", type=float, default=0.0)
    parser.add_argument("--guiding", action="store_true")
    parser.add_argument("runs", nargs="+")
    options = parser.parse_args()
    scene = load(options)
    set_up(scene, options)
    times = []
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "picture.exr"
        render(scene, 1, 0, path)  # loads the kernels
        scene.render.use_border = scene.render.use_crop_to_border = True
        size = scene.render.resolution_x, scene.render.resolution_y
        scene.render.border_max_x, scene.render.border_max_y = 1 / size[0], 1 / size[1]
        rest = min(render(scene, 1, 0, path) for _ in range(2))
        scene.render.use_border = False
        for run in options.runs:
            spp, seed, out = run.split(":", 2)
            times.append(render(scene, int(spp), int(seed), path) - rest)
            np.save(out, read(path).astype(np.float32))
    print("\n" + json.dumps(times))


if __name__ == "__main__":
    main()
