#!/usr/bin/env python3
"""Writes the glTF scenes of this folder: cube.glb and knot.glb.

knot.glb is a (2, 3) torus knot of 8 x 96 quadrilaterals in four colours over a floor.
"""

import json
import math
import pathlib
import struct

MATERIALS = {
    "red": (0.80, 0.05, 0.04),
    "green": (0.10, 0.55, 0.12),
    "blue": (0.05, 0.15, 0.70),
    "gold": (0.90, 0.55, 0.08),
    "grey": (0.30, 0.30, 0.32),
}


class Asset:
    """Collects the JSON and the buffer of one asset."""

    def __init__(self, colours):
        self.buffer = b""
        self.colours = list(colours)
        self.json = {
            "asset": {"version": "2.0", "generator": "microtrace scenes/gltf/make.py"},
            "extensionsUsed": ["KHR_materials_unlit"],
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
            "meshes": [],
            "materials": [
                {
                    "name": name,
                    "pbrMetallicRoughness": {"baseColorFactor": [*MATERIALS[name], 1]},
                    "extensions": {"KHR_materials_unlit": {}},
                }
                for name in self.colours
            ],
            "accessors": [],
            "bufferViews": [],
        }

    def add(self, array, item):
        self.json.setdefault(array, []).append(item)
        return len(self.json[array]) - 1

    def view(self, data, target):
        self.buffer += b"\0" * (-len(self.buffer) % 4)
        view = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data), "target": target}
        self.buffer += data
        return self.add("bufferViews", view)

    def positions(self, points):
        data = b"".join(struct.pack("<3f", *p) for p in points)
        stored = [struct.unpack_from("<3f", data, 12 * i) for i in range(len(points))]
        return self.add("accessors", {
            "bufferView": self.view(data, 34962), "componentType": 5126, "type": "VEC3",
            "count": len(points),
            "min": [min(p[k] for p in stored) for k in range(3)],
            "max": [max(p[k] for p in stored) for k in range(3)],
        })

    def indices(self, triangles):
        flat = [i for t in triangles for i in t]
        data = struct.pack(f"<{len(flat)}H", *flat)
        return self.add("accessors", {
            "bufferView": self.view(data, 34963), "componentType": 5123, "type": "SCALAR",
            "count": len(flat),
        })

    def mesh(self, name, points, triangles_by_colour):
        positions = self.positions(points)
        primitives = [
            {"attributes": {"POSITION": positions}, "indices": self.indices(triangles),
             "material": self.colours.index(colour)}
            for colour, triangles in triangles_by_colour.items()
        ]
        mesh = self.add("meshes", {"name": name, "primitives": primitives})
        self.node({"name": name, "mesh": mesh})

    def node(self, node):
        self.json["scenes"][0]["nodes"].append(self.add("nodes", node))

    def write(self, path):
        self.json["buffers"] = [{"byteLength": len(self.buffer)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = self.buffer + b"\0" * (-len(self.buffer) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def cube():
    asset = Asset(["red", "green", "blue"])
    points = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    sides = {
        "red": [(0, 4, 6, 2), (1, 3, 7, 5)],
        "green": [(0, 1, 5, 4), (2, 6, 7, 3)],
        "blue": [(0, 2, 3, 1), (4, 5, 7, 6)],
    }
    triangles = {
        colour: [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
        for colour, quads in sides.items()
    }
    asset.mesh("Cube", points, triangles)
    return asset


def knot_point(t):
    """A (2, 3) torus knot: twice around the axis, three times around the tube."""
    r = 2 + math.cos(3 * t)
    return (r * math.cos(2 * t), r * math.sin(2 * t), -math.sin(3 * t))


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def knot(rings=96, sides=8, radius=0.55):
    asset = Asset(["red", "green", "blue", "gold", "grey"])
    points = []
    for i in range(rings):
        t = 2 * math.pi * i / rings
        center = knot_point(t)
        tangent = unit(subtract(knot_point(t + 1e-3), knot_point(t - 1e-3)))
        normal = unit(cross(tangent, cross(center, tangent)))
        binormal = cross(tangent, normal)
        for k in range(sides):
            c, s = math.cos(2 * math.pi * k / sides), math.sin(2 * math.pi * k / sides)
            points.append(tuple(p + radius * (c * n + s * b)
                                for p, n, b in zip(center, normal, binormal)))
    bands = {colour: [] for colour in asset.colours[:4]}
    for i in range(rings):
        for k in range(sides):
            a, b = i * sides + k, i * sides + (k + 1) % sides
            c, d = (a + sides) % len(points), (b + sides) % len(points)
            # Four bands wind along the tube, eight turns in all, and so close where it does.
            band = bands[asset.colours[(k // 2 + i // 3) % 4]]
            band += [(a, b, d), (a, d, c)]
    asset.mesh("Knot", points, bands)
    floor = [(-6, -4, -6), (6, -4, -6), (6, -4, 4), (-6, -4, 4)]
    asset.mesh("Floor", floor, {"grey": [(0, 2, 1), (0, 3, 2)]})
    camera = asset.add("cameras", {
        "type": "perspective",
        "perspective": {"yfov": math.pi / 4, "znear": 0.1},
    })
    tilt = -0.2
    asset.node({
        "name": "Front", "camera": camera, "translation": [0, 1.6, 10.5],
        "rotation": [math.sin(tilt / 2), 0, 0, math.cos(tilt / 2)],
    })
    return asset


def main():
    folder = pathlib.Path(__file__).parent
    cube().write(folder / "cube.glb")
    knot().write(folder / "knot.glb")


if __name__ == "__main__":
    main()
