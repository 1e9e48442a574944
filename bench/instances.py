#!/usr/bin/env python3
"""Renders fields of 10^6 to 4 x 10^9 triangles, in which nodes share a bumpy sphere, by `microtrace`.

usage: instances.py PROGRAM [--most N] [--plot FILE.svg]

Each field is path traced at 1920 x 1080 with one sample per pixel. Prints a table of times and of peak
memory, for fields of at most 10^7 triangles also with copies instead of shared meshes. --most leaves
out fields with more triangles. --plot draws times and memory over the number of triangles.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "light"))
import files
import plot_scaling

SIDE = 223  # of the grid of the sphere's vertices; two triangles a cell
SPACING = 2.6  # between nodes
NODES = (10, 100, 1000, 10_000, 43_000)  # ids are 32-bit numbers, so 4.3 x 10^9 triangles are the most
MOST_COPIED = 10_000_000  # triangles
CURVES = {  # label, unit and color of each curve by the key of a measurement
    "load_s": ("loading, s", "#1b6ca8"),
    "build_s": ("tree, s", "#b3541e"),
    "trace_s": ("tracing, s", "#3c7d3e"),
    "peak_memory_gib": ("memory, GiB", "#7a3c8f"),
}


def sphere():
    """Returns the positions, normals and triangles of a sphere with bumps."""
    u, v = np.meshgrid(
        np.arange(SIDE + 1) / SIDE * 2 * np.pi, np.arange(SIDE + 1) / SIDE * np.pi, indexing="ij")
    direction = np.stack([np.sin(v) * np.cos(u), np.cos(v), np.sin(v) * np.sin(u)], -1)
    radius = 1 + 0.15 * np.sin(7 * u) * np.sin(9 * v) + 0.05 * np.sin(31 * u) * np.sin(37 * v)
    first = np.arange(SIDE)[:, None] * (SIDE + 1) + np.arange(SIDE)
    corners = [first, first + SIDE + 2, first + 1, first, first + SIDE + 1, first + SIDE + 2]
    return {"positions": (direction * radius[..., None]).reshape(-1, 3),
            "normals": direction.reshape(-1, 3), "triangles": np.stack(corners, -1)}


def nodes(count):
    """Returns `count` turned and scaled nodes in a square, and a camera that overlooks them."""
    random = np.random.default_rng(1)
    side = int(np.ceil(count**0.5))
    turns = random.normal(size=(count, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    moves = random.uniform(-0.5, 0.5, (count, 3))
    scales = random.uniform(0.6, 1.4, count)
    result = []
    for i in range(count):
        x, z = (i % side - side / 2) * SPACING, (i // side - side / 2) * SPACING
        result.append({"mesh": 0, "rotation": turns[i].tolist(), "scale": [scales[i]] * 3,
                       "translation": [x + moves[i, 0], moves[i, 1], z + moves[i, 2]]})
    extent = side * SPACING
    half_turn = np.radians(-25) / 2
    result.append({"camera": 0, "translation": [0, 6 + 0.06 * extent, 8 + 0.5 * extent],
                   "rotation": [np.sin(half_turn), 0, 0, np.cos(half_turn)]})
    return result


def write(path, count):
    glb = files.Glb()
    material = glb.add("materials", {"pbrMetallicRoughness": {
        "baseColorFactor": [0.4, 0.6, 0.3, 1], "metallicFactor": 0, "roughnessFactor": 0.7}})
    glb.add("meshes", {"primitives": [glb.primitive(sphere(), material)]})
    glb.add("cameras", {"type": "perspective",
                        "perspective": {"yfov": 0.6, "znear": 0.1, "aspectRatio": 16 / 9}})
    for node in nodes(count):
        glb.add_node(**node)
    glb.write(path)


def measure(program, scene, picture, sharing):
    """Returns the program's measurements of one rendering."""
    run = subprocess.run(
        [program, scene, "-o", picture, "--size", "1920x1080", "--spp", "1", "--stats=json",
         "--quiet", "--instances", sharing], check=True, capture_output=True, text=True)
    result = json.loads(run.stderr)
    result["peak_memory_gib"] = result["peak_memory_mib"] / 1024
    return result


def row(label, m):
    cells = [label, f"{m['primitives']:.2g}", f"{m['load_s']:.2f} s", f"{m['build_s']:.2f} s",
             f"{m['trace_s']:.1f} s", f"{m['peak_memory_mib']:.0f} MiB"]
    return "| " + " | ".join(cells) + " |"


def draw(rows):
    counts = [m["primitives"] for m in rows]
    values = [m[key] for m in rows for key in CURVES]
    x, y, out = plot_scaling.axes(counts, values, "s, GiB", (1,))
    lowest = 0
    for key in sorted(CURVES, key=lambda key: -rows[-1][key]):
        label, color = CURVES[key]
        points = [(x(m["primitives"]), y(m[key])) for m in rows]
        out.append(plot_scaling.line(points, color))
        lowest = max(points[-1][1] + 4, lowest + 16)  # labels must not overlap
        out.append(plot_scaling.text(plot_scaling.WIDTH - plot_scaling.RIGHT + 8, lowest, label,
                                     "start", color))
    return "\n".join(out + ["</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--most", type=float, default=5e9)
    parser.add_argument("--plot", type=pathlib.Path)
    arguments = parser.parse_args()
    print("| nodes | triangles | loading | building the tree | tracing | peak memory |")
    print("|---|---|---|---|---|---|")
    shared = []
    with tempfile.TemporaryDirectory() as name:
        scene, picture = pathlib.Path(name) / "field.glb", pathlib.Path(name) / "field.ppm"
        for count in NODES:
            if count * 2 * SIDE**2 > arguments.most:
                break
            write(scene, count)
            shared.append(measure(arguments.program, scene, picture, "share"))
            print(row(f"{count}", shared[-1]), flush=True)
            if count * 2 * SIDE**2 <= MOST_COPIED:
                copied = measure(arguments.program, scene, picture, "copy")
                print(row(f"{count}, copied", copied), flush=True)
    if arguments.plot:
        arguments.plot.write_text(draw(shared))


if __name__ == "__main__":
    main()
