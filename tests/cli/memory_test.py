#!/usr/bin/env python3
"""Tests a limit on the address space (ulimit -v): libraries that run out of memory must not change pictures. Measures the
memory of many nodes.

usage: memory_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import base64
import json
import resource
import struct
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from program import ProgramTest

SCENE = Path(sys.argv[2]).resolve() / "scenes/perspective1.json"

# A lossless image of 2048 x 2048 blue pixels.
BLUE = ("UklGRtQAAABXRUJQVlA4TMgAAAAv/8f/AQdQvCrUvP8BIUHi/+9mIvqf8Z///Oc///nPf/7zn//85z//+c9//vOf//znP//5z3/+85///Oc///nPf/7z"
        "n//85z//+c9//vOf//znP//5z3/+85///Oc///nPf/7zn//85z//+c9//vOf//znP//5z3/+85///Oc///nPf/7zn//85z//+c9//vOf//znP//5z3/+"
        "85///Oc///nPf/7zn//85z//+c9//vOf//znP//5z3/+85///Oc///nPf/7vAQ==")


def square():
    """Returns an unlit square with the image as its texture."""
    positions = struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0)
    corners = struct.pack("<8f", 0, 1, 1, 1, 0, 0, 1, 0)
    data = base64.b64encode(positions + corners).decode()
    return json.dumps({
        "asset": {"version": "2.0"}, "extensionsUsed": ["EXT_texture_webp", "KHR_materials_unlit"], "scene": 0,
        "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "mode": 5, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "extensions": {"KHR_materials_unlit": {}}}],
        "textures": [{"extensions": {"EXT_texture_webp": {"source": 0}}}],
        "images": [{"uri": "data:image/webp;base64," + BLUE}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32}],
        "buffers": [{"byteLength": 80, "uri": "data:application/octet-stream;base64," + data}]})


def nodes(count):
    """Returns a triangle that so many nodes share."""
    numbers = 3 * [0.123456789]
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(count))}],
        "nodes": [{"mesh": 0, "name": f"Leaf.{i:07}", "rotation": [0, 0, 0, 1], "scale": numbers, "translation": numbers}
                  for i in range(count)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," +
                     base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()}]})


class Memory(ProgramTest):
    def check(self, picture, most, step, *arguments):
        """Lowers the limit from `most` KiB until twelve runs were refused. The picture must be the same, or the program
        must end with exit code 6."""
        words = [*arguments, "--threads", "1", "-o", picture, "-q"]
        path = self.folder / picture
        self.assertEqual(self.run_program(*words).returncode, 0)
        expected = path.read_bytes()
        drawn = refused = 0
        while refused < 12:
            path.unlink(missing_ok=True)
            limit = (most - (drawn + refused) * step) << 10
            result = self.run_program(*words, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            if result.returncode == 0:
                self.assertEqual(path.read_bytes(), expected, limit)
                drawn += 1
            else:
                self.assertEqual(result.returncode, 6, result.stderr)
                self.assertFalse(path.exists())
                refused += 1
        self.assertGreater(drawn, 0)

    def test_nodes_need_a_kilobyte_each(self):
        # The text and the JSON's values take most of it, but nothing else exists at the same time.
        peaks = []
        for count in (10_000, 60_000):
            (self.folder / "nodes.gltf").write_text(nodes(count))
            result = self.run_program("nodes.gltf", "--integrator", "flat", "--instances", "share", "--size", "8x8",
                                      "--threads", "1", "-o", "a.ppm", "-q", "--stats=json")
            self.assertEqual(result.returncode, 0, result.stderr)
            peaks.append(json.loads(result.stdout or result.stderr)["peak_memory_mib"])
        self.assertLess((peaks[1] - peaks[0]) * 2**20 / 50_000, 1250)

    def test_textures_are_not_white(self):
        (self.folder / "square.gltf").write_text(square())
        self.check("a.ppm", 70_000, 1000, "square.gltf", "--integrator", "flat", "--size", "8x8")

    def test_exr(self):
        self.check("a.exr", 50_000, 500, SCENE, "--integrator", "position", "--size", "640x480")

    def test_png(self):
        self.check("a.png", 30_000, 100, SCENE, "--size", "64x48")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
