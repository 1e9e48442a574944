#!/usr/bin/env python3
"""Renders glTF assets with microtrace and with Blender's Cycles, from the same position under the same sky, and
compares the pictures. Both are displayed with exposure 1 / 0.6, three.js' ACES curve and gamma 2.2.

usage: against_cycles.py FOLDER MICROTRACE ASSET... [--spp N] [--size N] [--defaults]

Needs Blender as a Python module (bpy 5.0) and numpy. Writes NAME.png for each asset. It contains Cycles' picture,
microtrace's, and four times their difference plus gray.
"""
import argparse
import math
import pathlib
import subprocess
import sys

import bpy
import numpy as np

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import files
import textures

THETA, PHI, FOV = 35, 65, 45  # degrees: azimuth about +y from +z, and polar angle from +y


def in_gltf(p):
    """Converts a point from Blender's axes, in which z points up, to glTF's."""
    return np.array([p[0], p[2], -p[1]])


def load(asset):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # Without this option, the importer divides light intensities by 683 lumens per watt, which
    # microtrace doesn't do.
    bpy.ops.import_scene.gltf(filepath=str(asset), export_import_convert_lighting_mode="COMPAT")
    for thing in list(bpy.data.objects):
        thing.animation_data_clear()
        if thing.type == "CAMERA":
            bpy.data.objects.remove(thing)


def box():
    """Returns the center of the scene's bounding box, in glTF's axes, and the length of the box's diagonal."""
    graph = bpy.context.evaluated_depsgraph_get()
    corners = []
    for thing in bpy.context.scene.objects:
        if thing.type == "MESH":
            posed = thing.evaluated_get(graph)
            points = np.empty(3 * len(posed.data.vertices), np.float32)
            posed.data.vertices.foreach_get("co", points)
            matrix = np.array(posed.matrix_world)
            corners.append(points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
    points = in_gltf(np.concatenate(corners).T).T
    low, high = points.min(0), points.max(0)
    return (low + high) / 2, float(np.linalg.norm(high - low))


def set_camera(target, radius):
    data = bpy.data.cameras.new("camera")
    camera = bpy.data.objects.new("camera", data)
    scene = bpy.context.scene
    scene.collection.objects.link(camera)
    scene.camera = camera
    data.sensor_fit, data.angle_y = "VERTICAL", math.radians(FOV)
    data.clip_start, data.clip_end = radius / 1000, radius * 1000
    theta, phi = math.radians(THETA), math.radians(PHI)
    camera.rotation_euler = phi, 0, theta
    x, y, z = target + radius * np.array([math.sin(phi) * math.sin(theta), math.cos(phi), math.sin(phi) * math.cos(theta)])
    camera.location = x, -z, y


def set_sky(path):
    """Sets the sky. Cycles maps the direction (x, y) to u = 1/2 - atan2(y, x) / 2 pi. microtrace maps the same
    direction to the same u, because Blender's (x, y) is glTF's (x, -z)."""
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes = world.node_tree.nodes
    nodes.clear()
    image, light, out = (nodes.new(f"ShaderNode{kind}") for kind in ("TexEnvironment", "Background", "OutputWorld"))
    image.image = bpy.data.images.load(str(path))
    world.node_tree.links.new(image.outputs[0], light.inputs[0])
    world.node_tree.links.new(light.outputs[0], out.inputs[0])


def render(path, options):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples = "CPU", options.spp
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    if not options.defaults:  # By default, Cycles clamps and blurs indirect light and terminates paths early.
        cycles.sample_clamp_indirect = cycles.blur_glossy = 0
        for kind in ("max", "diffuse", "glossy", "transmission", "volume"):
            setattr(cycles, "max_bounces" if kind == "max" else f"{kind}_bounces", 31)
        cycles.transparent_max_bounces = 64
    scene.render.resolution_x = scene.render.resolution_y = options.size
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def read(path):
    """Reads linear colors, top row first."""
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    pixels = np.empty(image.size[0] * image.size[1] * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(image.size[1], image.size[0], image.channels)[::-1, :, :3].astype(float)


def shown(light):
    into = np.array([[0.59719, 0.35458, 0.04823], [0.07600, 0.90834, 0.01566], [0.02840, 0.13383, 0.83777]])
    back = np.array([[1.60475, -0.53108, -0.07367], [-0.10208, 1.10813, -0.00605], [-0.00327, -0.07276, 1.07602]])
    v = light / 0.6 @ into.T
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)
    return np.clip(v @ back.T, 0, 1) ** (1 / 2.2)


def compare(asset, options):
    """Returns the mean and the 99th percentile of the difference, and the mean light of Cycles' picture and of microtrace's."""
    sky, theirs, ours = (options.folder / name for name in ("sky.hdr", f"{asset.stem}_cycles.exr", f"{asset.stem}.exr"))
    load(asset)
    target, diagonal = box()
    radius = 1.35 * diagonal
    set_camera(target, radius)
    set_sky(sky)
    render(theirs, options)
    subprocess.run([options.program, str(asset), "-q", "--view", f"{THETA},{90 - PHI},{radius}",
                    "--target", ",".join(map(repr, map(float, target))), "--fov", str(FOV), "--env", str(sky), "--background",
                    "env", "--filter", "blackman-harris", "--spp", str(options.spp), "--size", f"{options.size}x{options.size}",
                    "-o", str(ours)], check=True)
    a, b = read(theirs), read(ours)
    difference = shown(b) - shown(a)
    sheet = np.concatenate([shown(a), shown(b), np.clip(0.5 + 4 * difference, 0, 1)], 1)
    files.write_png(options.folder / f"{asset.stem}.png", (sheet * 255 + 0.5).astype(np.uint8))
    return np.abs(difference).mean(), np.quantile(np.abs(difference), 0.99), a.mean(), b.mean()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("program")
    parser.add_argument("assets", type=lambda path: pathlib.Path(path).resolve(), nargs="+")
    parser.add_argument("--spp", type=int, default=128)
    parser.add_argument("--size", type=int, default=240)
    parser.add_argument("--defaults", action="store_true", help="Cycles as it comes: clamped, with short paths")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    files.write_hdr(options.folder / "sky.hdr", textures.sky())
    print("asset | mean difference | 99 % are below | mean light, Cycles | ours", flush=True)
    for asset in options.assets:
        print("{} | {:.4f} | {:.3f} | {:.4f} | {:.4f}".format(asset.stem, *compare(asset, options)), flush=True)


if __name__ == "__main__":
    main()
