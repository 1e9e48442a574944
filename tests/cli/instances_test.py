#!/usr/bin/env python3
"""Tests that pictures with instances have the bytes of pictures with copies. The scenes are the repository's, in which each
mesh is placed several more times: turned, mirrored, sheared by its parents, and by EXT_mesh_gpu_instancing.

usage: instances_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import json
import random
import struct
import sys
import unittest
from pathlib import Path

from program import PROGRAM, ProgramTest

SCENES = Path(sys.argv[2]).resolve() / "scenes/gltf"
QUAD = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
LIT = ["--integrator", "path", "--size", "48x36", "--spp", "2", "--seed", "5"]


def chunk(kind, data, padding):
    data += padding * (-len(data) % 4)
    return struct.pack("<I4s", len(data), kind) + data


def read_glb(path):
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[28 + length:]


def glb(asset, buffer):
    chunks = chunk(b"JSON", json.dumps(asset).encode(), b" ") + chunk(b"BIN\0", buffer, b"\0")
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def unit_quaternion(rng):
    q = [rng.gauss(0, 1) for _ in range(4)]
    length = sum(x * x for x in q) ** 0.5
    return [x / length for x in q]


def multiplied(path, seed):
    """A scene with further nodes for each of its meshes."""
    asset, buffer = read_glb(path)
    rng = random.Random(seed)
    roots = asset["scenes"][asset.get("scene", 0)]["nodes"]
    drawn = [node for node in asset["nodes"] if "mesh" in node and "skin" not in node]
    offset = [[rng.uniform(-2, 2) for _ in range(3)] for _ in range(3)]
    buffer += b"\0" * (-len(buffer) % 4)
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(buffer), "byteLength": 36})
    buffer += b"".join(struct.pack("<3f", *p) for p in offset)
    asset["accessors"].append({"bufferView": len(asset["bufferViews"]) - 1, "componentType": 5126, "type": "VEC3",
                               "count": 3})
    asset["buffers"][0]["byteLength"] = len(buffer)
    asset.setdefault("extensionsUsed", []).append("EXT_mesh_gpu_instancing")

    def add(node):
        asset["nodes"].append(node)
        return len(asset["nodes"]) - 1

    for number, node in enumerate(drawn):
        own = {key: node[key] for key in ("translation", "rotation", "scale", "matrix") if key in node}
        same = add(dict(own, mesh=node["mesh"]))
        # A rotated child of a parent that scales unevenly, and mirrors, is sheared.
        child = add({"mesh": node["mesh"], "rotation": unit_quaternion(rng),
                     "scale": [rng.uniform(0.3, 1) for _ in range(3)]})
        sheared = add({"children": [child], "scale": [rng.uniform(0.5, 1), -rng.uniform(0.5, 1), rng.uniform(0.5, 1)],
                       "translation": [rng.uniform(-3, 3) for _ in range(3)]})
        roots += [same, sheared]
        if number % 4 == 0:
            roots.append(add({"mesh": node["mesh"], "scale": [0.25, 0.25, 0.25], "extensions": {
                "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": len(asset["accessors"]) - 1}}}}))
    return glb(asset, buffer)


def backs_before_blended_quads():
    """Two coincident nodes of a mesh: the back of a one-sided quad, and behind it a two-sided quad with alpha."""
    corners = [struct.pack("<12f", *(x for i in order for x in (*QUAD[i], z))) for order, z in (((0, 3, 2, 1), 1), ((0, 1, 2, 3), 0))]
    indices = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    buffer = b"".join(corners) + indices
    views = [{"buffer": 0, "byteOffset": 48 * i, "byteLength": 48 if i < 2 else 12} for i in range(3)]
    accessors = [{"bufferView": i, "componentType": 5126, "type": "VEC3", "count": 4, "min": [-1, -1, 1 - i], "max": [1, 1, 1 - i]}
                 for i in range(2)] + [{"bufferView": 2, "componentType": 5123, "type": "SCALAR", "count": 6}]
    return glb({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": i}, "indices": 2, "material": i} for i in range(2)]}],
        "materials": [{}, {"alphaMode": "BLEND", "doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": [1, 0.2, 0.1, 0.5]}}],
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(buffer)}]}, buffer)


class Instances(ProgramTest):
    def draw(self, how, *arguments, scene="scene.glb"):
        """The outputs of one run, and its counted memory in MiB."""
        for name in ("o.ppm", "o.json"):
            (self.folder / name).unlink(missing_ok=True)
        result = self.run_program(scene, *arguments, "--instances", how, "--stats=json", "-o", "o.ppm",
                                  "--sidecar", "o.json")
        self.assertEqual(result.returncode, 0, result.stderr.decode(errors="replace"))
        statistics = json.loads([line for line in result.stderr.decode().splitlines() if line.startswith("{")][-1])
        sidecar = json.loads((self.folder / "o.json").read_bytes())
        sidecar.pop("metadata", None)
        return ((self.folder / "o.ppm").read_bytes(), sidecar["camera"], sidecar["objects"]), statistics["counted_memory_mib"]

    def assert_same(self, name, *arguments):
        (self.folder / "scene.glb").write_bytes(multiplied(SCENES / name, 1))
        copies, of_copies = self.draw("copy", *arguments)
        instances, of_instances = self.draw("share", *arguments)
        self.assertEqual(instances, copies, (name, arguments))
        return of_instances / of_copies

    def test_path(self):
        for name, options in (("materials.glb", ["--env", "studio"]), ("textured.glb", []), ("lamps.glb", []),
                              ("media.glb", []), ("panes.glb", []), ("far.glb", []), ("moving.glb", ["--time", "0.7"]),
                              ("materials.glb", ["--guiding", "--env", "studio", "--threads", "2"]),
                              ("textured.glb", ["--bsdf", "spec", "--ground"])):
            self.assert_same(name, *LIT, *options)

    # Copies have duplicate triangles, so queries don't pass through backs. Instances don't.
    def test_backs_before_blended_surfaces(self):
        (self.folder / "scene.glb").write_bytes(backs_before_blended_quads())
        copies, instances = (self.draw(how, *LIT, "--view", "0,0")[0] for how in ("copy", "share"))
        self.assertEqual(instances, copies)
        self.assertGreater(len(set(instances[0])), 9)  # the quads are in the picture

    def test_without_light(self):
        for name in ("textures.glb", "textured.glb", "knot.glb"):
            for integrator in ("flat", "normal", "face_normal", "uv", "barycentric", "depth", "id", "position", "albedo"):
                self.assert_same(name, "--integrator", integrator, "--size", "64x48")
        self.assert_same("textures.glb", "--integrator", "flat", "--size", "64x48", "--spp", "4", "--view", "30,40")

    def test_objects_of_json_scenes_share_files(self):
        (self.folder / "knot.glb").write_bytes((SCENES / "knot.glb").read_bytes())
        objects = [{"name": f"{i}", "type": "mesh", "file": "knot.glb", "transform": {
            "translation": [i, 0.3 * i, -i], "rotation": {"axis": [1, i, 2], "angle": 37 * i}, "scale": [0.5, -0.3, 0.4]}}
            for i in range(-2, 3)]
        scene = {"version": 1, "image": {"width": 40, "height": 30}, "objects": objects,
                 "cameras": [{"type": "perspective", "position": [0, 0, 6], "direction": [0, 0, -1], "up": [0, 1, 0],
                              "vertical_fov": 60}]}
        (self.folder / "scene.json").write_text(json.dumps(scene))
        copies, of_copies = self.draw("copy", scene="scene.json")
        instances, of_instances = self.draw("share", scene="scene.json")
        self.assertEqual(instances, copies)
        self.assertLess(of_instances, 0.8 * of_copies)

    def test_instances_need_less_memory(self):
        self.assertLess(self.assert_same("knot.glb", "--integrator", "flat", "--size", "8x6"), 0.8)


if __name__ == "__main__":
    unittest.main(argv=[PROGRAM, *sys.argv[3:]])
