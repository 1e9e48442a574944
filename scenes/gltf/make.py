#!/usr/bin/env python3
"""Writes the glTF scenes of this folder: cube.glb, knot.glb and textures.glb.

knot.glb is a (2, 3) torus knot of 8 x 96 quadrilaterals in four colours over a floor. textures.glb has four rectangles
before an orthographic camera: a repeated texture magnified, another minified by mip maps, a mask before grey, and one that
leans back, so that its footprints are long.
"""

import json
import math
import pathlib
import struct
import zlib

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

    def numbers(self, kind, tuples):
        data = b"".join(struct.pack(f"<{len(t)}f", *t) for t in tuples)
        return self.add("accessors", {"bufferView": self.view(data, 34962), "componentType": 5126, "type": kind,
                                      "count": len(tuples)})

    def texture(self, name, png, sampler):
        self.buffer += b"\0" * (-len(self.buffer) % 4)
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(png)})
        self.buffer += png
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": view})
        return self.add("textures", {"name": name, "source": image, "sampler": self.add("samplers", sampler)})

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


def png(size, channels, pixel):
    """A square PNG file of pixel(x, y), 8 bits a channel."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(size)) for y in range(size))
    header = struct.pack(">IIBBBBB", size, size, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9))
            + chunk(b"IEND", b""))


def textures():
    asset = Asset([])
    repeat, mirrored, linear, mip_maps = 10497, 33648, 9729, 9987
    patches = png(8, 3, lambda x, y: ((37 * x + 91 * y) % 256, (151 * x + 53 * y) % 256, 40 * ((x + y) % 2) + 30 * y))
    waves = png(64, 3, lambda x, y: (
        round(127.5 + 127.5 * math.sin(math.pi * x / 16)), 255 if (x // 4 + y // 8) % 2 else 30, (x * y) % 256))
    holes = png(16, 4, lambda x, y: (255, 16 * y, 255 - 16 * x, max(0, 255 - 4 * ((x - 8) ** 2 + (y - 7) ** 2))))
    sampler = {"wrapS": repeat, "wrapT": repeat, "magFilter": linear, "minFilter": mip_maps}
    # Name, texture, factor, corners x0, y0, x1, y1 with depths at y0 and y1, uv there; a unit is 80 pixels.
    rectangles = [
        ("Magnified", asset.texture("patches", patches, sampler), (1, 1, 1, 1),
         (-3.75, 0.25, -0.25, 2.75, 0, 0), (-0.5, 1.75, 1.75, -0.25)),
        ("Minified", asset.texture("waves", waves, sampler), (1, 0.75, 1, 1),
         (0.25, 0.25, 3.75, 2.75, 0, 0), (0, 8.4375, 11.8125, 0)),
        ("Mask", asset.texture("holes", holes, dict(sampler, wrapS=mirrored)), (0.5, 1, 1, 0.875),
         (-3.75, -2.75, -0.25, -0.25, 0, 0), (-1, 2.5, 2.5, 0)),
        ("Leaning", 1, (1, 1, 1, 1), (0.25, -2.75, 3.75, -0.25, 0, -4.5), (-1, 9, 4.5, -5)),
    ]
    for name, texture, factor, (x0, y0, x1, y1, z0, z1), (u0, v0, u1, v1) in rectangles:
        material = {"name": name, "extensions": {"KHR_materials_unlit": {}},
                    "pbrMetallicRoughness": {"baseColorFactor": factor, "baseColorTexture": {"index": texture}}}
        if name == "Mask":
            material.update(alphaMode="MASK", alphaCutoff=0.25)
        primitive = {
            "attributes": {"POSITION": asset.positions([(x0, y0, z0), (x1, y0, z0), (x1, y1, z1), (x0, y1, z1)]),
                           "TEXCOORD_0": asset.numbers("VEC2", [(u0, v0), (u1, v0), (u1, v1), (u0, v1)])},
            "indices": asset.indices([(0, 1, 2), (0, 2, 3)]), "material": asset.add("materials", material)}
        asset.node({"name": name, "mesh": asset.add("meshes", {"name": name, "primitives": [primitive]})})
    grey = asset.add("materials", {"name": "grey", "extensions": {"KHR_materials_unlit": {}},
                                   "pbrMetallicRoughness": {"baseColorFactor": [*MATERIALS["grey"], 1]}})
    primitive = {"attributes": {"POSITION": asset.positions([(-3.75, -2.75, -1), (-0.25, -2.75, -1), (-0.25, -0.25, -1),
                                                             (-3.75, -0.25, -1)])},
                 "indices": asset.indices([(0, 1, 2), (0, 2, 3)]), "material": grey}
    asset.node({"name": "Behind", "mesh": asset.add("meshes", {"name": "Behind", "primitives": [primitive]})})
    camera = asset.add("cameras", {"type": "orthographic",
                                   "orthographic": {"xmag": 4, "ymag": 3, "znear": 1, "zfar": 100}})
    asset.node({"name": "Front", "camera": camera, "translation": [0, 0, 10]})
    return asset


def main():
    folder = pathlib.Path(__file__).parent
    cube().write(folder / "cube.glb")
    knot().write(folder / "knot.glb")
    textures().write(folder / "textures.glb")


if __name__ == "__main__":
    main()
