#!/usr/bin/env python3
"""Tests that the library with default options, used as in README.md, writes the same pictures as the program without
options.

usage: library_test.py PROGRAM SOURCE_FOLDER README_PROGRAM [unittest arguments]
"""

import base64
import json
import struct
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))
from program import ProgramTest, environment

SCENES = Path(sys.argv[2]).resolve() / "scenes"
LIBRARY = Path(sys.argv[3]).resolve()


class Library(ProgramTest):
    def assert_same_bytes(self, scene, extension="ppm"):
        names = [f"{maker}.{extension}" for maker in ("program", "library")]
        program = self.run_program(scene, "-q", "-o", names[0])
        if b"MICROTRACE_MODULE_PATH" in program.stderr:
            self.skipTest("built without the module for this format")
        self.assertEqual(program.returncode, 0, program.stderr)
        library = subprocess.run([LIBRARY, scene, names[1]], cwd=self.folder, capture_output=True, env=environment())
        self.assertEqual(library.returncode, 0, library.stderr)
        pictures = [(self.folder / name).read_bytes() for name in names]
        self.assertGreater(len(set(pictures[0])), 9, "the picture shows something")
        self.assertEqual(pictures[0], pictures[1], scene)

    def write_gltf(self, mode, camera):
        """Writes a triangle (mode 4), or lines between its corners (mode 2), which shade fewer pixels."""
        nodes = [{"mesh": 0}] + [{"camera": 0, "translation": [0, 0, 20]}] * camera
        positions = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()
        (self.folder / "scene.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": mode}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64," + positions}]}))

    def test_json(self):
        self.assert_same_bytes(SCENES / "perspective1.json")

    def test_json_with_a_background_and_without_a_camera(self):
        scene = {"version": 1, "image": {"width": 60, "height": 40}, "background": [0.2, 0.4, 1],
                 "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1, "color": [1, 0.5, 0]}]}
        (self.folder / "scene.json").write_text(json.dumps(scene))
        self.assert_same_bytes("scene.json")

    def test_gltf_with_a_camera(self):
        self.write_gltf(mode=4, camera=True)
        self.assert_same_bytes("scene.gltf", "png")

    def test_gltf_that_is_framed(self):
        self.write_gltf(mode=2, camera=False)
        self.assert_same_bytes("scene.gltf")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
