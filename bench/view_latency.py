#!/usr/bin/env python3
"""Measures the time from a turn of the camera to its picture in `microtrace view`, including HTTP and PNG.

usage: view_latency.py PROGRAM [TRIANGLES [TURNS]]
"""

import array
import json
import math
import os
import statistics
import struct
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests/view"))
from viewer import Viewer


def bumpy_sphere(path, triangles):
    """Writes a sphere with waves, of about this number of triangles, as a .glb with normals from the faces."""
    rows = max(3, round(math.sqrt(triangles / 4)))
    columns = 2 * rows
    positions, indices = array.array("f"), array.array("I")
    for i in range(rows + 1):
        for j in range(columns):
            theta, phi = math.pi * i / rows, 2 * math.pi * j / columns
            r = 1 + 0.05 * math.sin(25 * theta) * math.sin(20 * phi)
            positions.extend((r * math.sin(theta) * math.cos(phi), r * math.cos(theta), r * math.sin(theta) * math.sin(phi)))
    for i in range(rows):
        for j in range(columns):
            a, b = i * columns + j, i * columns + (j + 1) % columns
            indices.extend((a, a + columns, b, b, a + columns, b + columns))
    count = len(positions) // 3
    lows, highs = [min(positions[c::3]) for c in range(3)], [max(positions[c::3]) for c in range(3)]
    data = positions.tobytes() + indices.tobytes()
    views = [{"buffer": 0, "byteLength": 12 * count}, {"buffer": 0, "byteOffset": 12 * count, "byteLength": 4 * len(indices)}]
    accessors = [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": lows, "max": highs},
                 {"bufferView": 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"}]
    text = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                       "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
                       "buffers": [{"byteLength": len(data)}], "bufferViews": views, "accessors": accessors}).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data)
    return len(indices) // 3


def report(name, seconds):
    seconds = sorted(1000 * s for s in seconds)
    print(f"{name:28} median {statistics.median(seconds):6.1f} ms, 95 % {seconds[int(0.95 * len(seconds))]:6.1f} ms, "
          f"maximum {seconds[-1]:6.1f} ms")


def main():
    program = sys.argv[1]
    wanted = int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000
    turns = int(sys.argv[3]) if len(sys.argv) > 3 else 100
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "sphere.glb")
        print(f"{bumpy_sphere(scene, wanted)} triangles, 640 x 480")
        words = ["--size", "640x480", "--env", "studio", "--spp", "64"]
        with Viewer(program, scene, *words) as viewer:
            path = viewer.open()
            viewer.draw([*words, "--view", "0,10"], path, moving=True)
            moving, first = [], []
            for turn in range(turns):
                start = time.perf_counter()
                viewer.draw([*words, "--view", f"{360 * turn / turns},10"], path, moving=True)
                moving.append(time.perf_counter() - start)
            # The first picture after the movement, while the previous one is still refining.
            for turn in range(turns):
                start = time.perf_counter()
                number = viewer.request("PUT", path, "\n".join([*words, "--view", f"{360 * turn / turns},20"])).json["request"]
                after = 0
                while True:
                    response = viewer.request("GET", f"{path}?after={after}")
                    after = response.picture["sequence"]
                    if response.picture["request"] == number:
                        break
                first.append(time.perf_counter() - start)
                time.sleep(0.2)
            report("while turning", moving)
            report("first picture after a turn", first)
            print(f"memory {viewer.memory() / 2**20:.0f} MiB")


if __name__ == "__main__":
    main()
