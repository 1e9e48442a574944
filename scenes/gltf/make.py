#!/usr/bin/env python3
"""Writes the glTF scenes of this folder: cube.glb, knot.glb and textures.glb, and those of lit.py and placed.py.

knot.glb is a (2, 3) torus knot of 8 x 96 quadrilaterals in four colors over a floor. textures.glb has four rectangles
before an orthographic camera: a repeated texture magnified, another minified by mip maps, a mask before gray, and one that
leans back, so that its footprints are long.
"""

import math
import pathlib

import lit
import placed
from asset import Asset, cross, png, subtract, unit

MATERIALS = {
    "red": (0.80, 0.05, 0.04),
    "green": (0.10, 0.55, 0.12),
    "blue": (0.05, 0.15, 0.70),
    "gold": (0.90, 0.55, 0.08),
    "grey": (0.30, 0.30, 0.32),
}


def cube():
    asset = Asset({name: MATERIALS[name] for name in ("red", "green", "blue")})
    points = [(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    sides = {
        "red": [(0, 4, 6, 2), (1, 3, 7, 5)],
        "green": [(0, 1, 5, 4), (2, 6, 7, 3)],
        "blue": [(0, 2, 3, 1), (4, 5, 7, 6)],
    }
    triangles = {
        color: [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
        for color, quads in sides.items()
    }
    asset.mesh("Cube", points, triangles)
    return asset


def knot_point(t):
    """A (2, 3) torus knot: twice around the axis, three times around the tube."""
    r = 2 + math.cos(3 * t)
    return (r * math.cos(2 * t), r * math.sin(2 * t), -math.sin(3 * t))


def knot(rings=96, sides=8, radius=0.55):
    asset = Asset(MATERIALS)
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
    bands = {color: [] for color in list(asset.flat)[:4]}
    for i in range(rings):
        for k in range(sides):
            a, b = i * sides + k, i * sides + (k + 1) % sides
            c, d = (a + sides) % len(points), (b + sides) % len(points)
            # Four bands wind along the tube, eight turns in all, and so close where it does.
            band = bands[list(bands)[(k // 2 + i // 3) % 4]]
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


def textures():
    asset = Asset()
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
    for name, make in lit.SCENES.items():
        make().write(folder / f"{name}.glb")
    placed.instances().write(folder / "instances.glb")
    (folder.parent / "sky.exr").write_bytes(lit.sky())


if __name__ == "__main__":
    main()
