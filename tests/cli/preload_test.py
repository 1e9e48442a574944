#!/usr/bin/env python3
"""Tests the program with few threads, and with a preloaded library that changes the floating-point environment.

usage: preload_test.py PROGRAM SOURCE_FOLDER FEW_THREADS HOST_RULES [unittest arguments]; the last two are libraries
"""

import base64
import json
import math
import struct
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from program import ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
FEW_THREADS, HOST_RULES = sys.argv[3:5]


def hills(n=110):
    """Returns a glTF asset with enough triangles for several threads to build its tree."""
    points = [(4 * i / n - 2, 4 * j / n - 2, 0.3 * math.sin(0.3 * i) * math.cos(0.2 * j)) for i in range(n) for j in range(n)]
    corners = [k for i in range(n - 1) for j in range(n - 1) for k in
               (i * n + j, i * n + n + j, i * n + j + 1, i * n + j + 1, i * n + n + j, i * n + n + j + 1)]
    points = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in points]
    data = b"".join(struct.pack("<3f", *p) for p in points) + struct.pack(f"<{len(corners)}I", *corners)
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "translation": [0.1, 0.3, 0.7]}, {"camera": 0, "translation": [0.1, 0.3, 7.1]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.3, 0.7, 1], "metallicFactor": 0.3}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": n * n, "type": "VEC3",
                       "min": [min(p[k] for p in points) for k in range(3)],
                       "max": [max(p[k] for p in points) for k in range(3)]},
                      {"bufferView": 1, "componentType": 5125, "count": len(corners), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 12 * n * n},
                        {"buffer": 0, "byteOffset": 12 * n * n, "byteLength": 4 * len(corners)}],
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]})


class Preloaded(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "hills.gltf").write_text(hills())

    def draw(self, name, *arguments, **variables):
        """Renders the hills. Returns the exit code, the bytes of the picture, and standard error."""
        result = self.run_program("hills.gltf", "--size", "48x36", "-o", name, *arguments,
                                  env=environment(**variables))
        path = self.folder / name
        return result.returncode, path.read_bytes() if path.exists() else None, result.stderr.decode()

    def test_fewer_threads_render_the_same_picture_with_a_warning(self):
        for name in ["hills.ppm", "hills.png"]:
            code, expected, _ = self.draw(name, "--spp", "2", "-t", "4")
            self.assertEqual(code, 0)
            for most in range(4):
                (self.folder / name).unlink()
                code, picture, said = self.draw(name, "--spp", "2", "-t", "4", LD_PRELOAD=FEW_THREADS, MOST_THREADS=str(most))
                self.assertEqual(code, 0, said)
                self.assertEqual(picture, expected)
                warning = f"warning: the system refused to start {3 - most} of 4 threads"
                self.assertEqual(warning in said, most < 3, said)

    def test_quantities_render_with_few_threads(self):
        code, picture, said = self.draw("normal.ppm", "--integrator", "normal", "-t", "9",
                                        LD_PRELOAD=FEW_THREADS, MOST_THREADS="2")
        self.assertEqual(code, 0, said)
        self.assertIn("refused to start 6 of 9 threads", said)

    def test_formats_whose_libraries_need_threads_are_refused(self):
        few = {"LD_PRELOAD": FEW_THREADS, "MOST_THREADS": "1"}
        code, picture, said = self.draw("hills.tif", **few)
        if "MICROTRACE_MODULE_PATH" in said:
            self.skipTest("no OpenImageIO")
        self.assertEqual((code, picture), (6, None), said)
        self.assertIn("error: hills.tif: needs OpenImageIO", said)
        code, _, said = self.draw("hills.hdr", "--spp", "1")
        self.assertEqual(code, 0, said)
        code, picture, said = self.draw("hills.ppm", "--env", "hills.hdr", **few)
        self.assertEqual((code, picture), (6, None), said)
        self.assertIn("error: hills.hdr: needs OpenImageIO", said)

    def test_a_preloaded_library_changes_no_byte(self):
        for name, *arguments in [("hills.ppm", "--exposure", "0.3", "--spp", "2"), ("hills.png", "--view", "31.7,12.3", "--spp", "2"),
                                 ("depth.ppm", "--integrator", "depth"), ("hills.hdr", "--spp", "2")]:
            code, expected, said = self.draw(name, *arguments)
            if "MICROTRACE_MODULE_PATH" in said:
                continue
            self.assertEqual(code, 0, said)
            for rounding in [0, 0x400, 0x800, 0xC00]:
                (self.folder / name).unlink()
                code, picture, said = self.draw(name, *arguments, LD_PRELOAD=HOST_RULES, ROUNDING=str(rounding))
                self.assertEqual(code, 0, said)
                self.assertEqual(picture, expected, (name, rounding))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[5:]])
