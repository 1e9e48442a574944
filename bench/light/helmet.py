#!/usr/bin/env python3
"""Writes a helmet of about 15 000 triangles with four textures of 2048 x 2048 pixels, for microtrace
(helmet.glb) and for Mitsuba 3 (helmet.xml with PLY and PNG files), and a sky with a sun (sky.hdr).

usage: helmet.py FOLDER
"""
import pathlib
import shutil
import sys

import numpy as np

import files
import textures

EYE, TARGET, YFOV = (1.05, 0.41, 3.9), (0.0, 0.0, 0.0), 38.0


def bump(x, width):
    return np.exp(-((x / width) ** 2))


def shell(u, v):
    """Returns a skull with a crest, ears and a hollow for the visor. v starts at the top, and +z is the front."""
    phi, theta = (u - 0.5) * 2 * np.pi, v * np.pi
    d = np.stack([np.sin(phi) * np.sin(theta), np.cos(theta), np.cos(phi) * np.sin(theta)], -1)
    x, y, z = d[..., 0], d[..., 1], d[..., 2]
    hollow = 1 / (1 + ((np.abs(x) / 0.62) ** 6 + (np.abs(y + 0.02) / 0.33) ** 6))
    radius = 1 - 0.3 * hollow * (z > 0) + 0.09 * bump(x, 0.12) * (1 - bump(np.maximum(y, 0), 0.3))
    radius += 0.1 * bump(np.hypot(y + 0.1, z), 0.28)
    radius += 0.006 * np.sin(14 * y) * np.sin(11 * phi) * np.sin(theta)
    p = d * radius[..., None] * np.array([1.0, 1.1, 1.15])
    p[..., 1] += 0.5 * np.maximum(-0.75 - y, 0)  # concave from below
    return p


def visor(u, v):
    phi, theta = (u - 0.5) * 2 * np.pi, v * np.pi
    d = np.stack([np.sin(phi) * np.sin(theta), np.cos(theta), np.cos(phi) * np.sin(theta)], -1)
    return d * np.array([0.6, 0.33, 0.48]) + np.array([0, -0.02, 0.56])


def neck(u, v):
    phi, around = (u - 0.5) * 2 * np.pi, v * 2 * np.pi
    radius = 0.62 + 0.1 * np.cos(around)
    return np.stack([np.sin(phi) * radius, -0.9 - 0.1 * np.sin(around), np.cos(phi) * radius], -1)


def hose(side):
    def at(u, v):
        s, around = v[..., None], u[..., None] * 2 * np.pi
        def middle(s):
            a = np.pi * s
            return np.concatenate([side * (0.3 + 0.9 * np.sin(a)), -0.45 - 0.3 * np.sin(a),
                                   0.72 * np.cos(a)], -1)
        along = middle(s + 1e-4) - middle(s - 1e-4)
        along /= np.linalg.norm(along, axis=-1, keepdims=True)
        a = np.cross(along, [0, 1, 0])
        a /= np.linalg.norm(a, axis=-1, keepdims=True)
        ring = 0.1 * (1 + 0.12 * np.sin(60 * np.pi * s))
        return middle(s) + ring * (np.cos(around) * a + np.sin(around) * np.cross(a, along))
    return at


def patch(surface, columns, rows, box):
    """Returns a mesh of the surface over a grid in the unit square of (u, v). Its texture coordinates fill `box`."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1))
    p, e = surface(u, v), 1e-4
    inner = np.clip(v, 2 * e, 1 - 2 * e)  # the direction along u is undefined at a pole
    along = surface(u + e, inner) - surface(u - e, inner)
    down = surface(u, inner + e) - surface(u, inner - e)
    n = np.cross(down, along)  # tangent, bitangent (-down) and normal are right-handed
    unit = lambda x: x / np.linalg.norm(x, axis=-1, keepdims=True)
    tangent = np.concatenate([unit(along), np.ones_like(u)[..., None]], -1)
    x0, y0, x1, y1 = box
    uvs = np.stack([x0 + u * (x1 - x0), y0 + v * (y1 - y0)], -1)
    first = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    a, b, c, d = first, first + columns + 1, first + columns + 2, first + 1
    triangles = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    flat = p.reshape(-1, 3)
    corners = flat[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return {"positions": flat, "normals": unit(n).reshape(-1, 3), "uvs": uvs.reshape(-1, 2),
            "tangents": tangent.reshape(-1, 4), "triangles": triangles[area > 1e-9]}


def joined(patches):
    counts = np.cumsum([0] + [len(p["positions"]) for p in patches])
    mesh = {key: np.concatenate([p[key] for p in patches])
            for key in ("positions", "normals", "uvs", "tangents")}
    mesh["triangles"] = np.concatenate([p["triangles"] + n for p, n in zip(patches, counts)])
    return mesh


def helmet():
    return joined([patch(shell, 96, 56, (0.0, 0.0, 1.0, 0.6)), patch(visor, 40, 24, (0.0, 0.62, 0.5, 0.98)),
                   patch(hose(1), 10, 60, (0.52, 0.62, 0.75, 0.8)),
                   patch(hose(-1), 10, 60, (0.77, 0.62, 1.0, 0.8)),
                   patch(neck, 48, 10, (0.52, 0.82, 1.0, 0.98))])


def camera_rotation():
    """Returns the quaternion that rotates -z to the direction from the eye to the target and keeps +y up."""
    back = np.subtract(EYE, TARGET)
    yaw = np.arctan2(back[0], back[2]) / 2
    pitch = -np.arctan2(back[1], np.hypot(back[0], back[2])) / 2
    return [float(np.cos(yaw) * np.sin(pitch)), float(np.sin(yaw) * np.cos(pitch)),
            float(-np.sin(yaw) * np.sin(pitch)), float(np.cos(yaw) * np.cos(pitch))]


def write_glb(folder, mesh):
    glb = files.Glb()
    texture = lambda name: glb.texture(folder / f"{name}.png")
    material = glb.add("materials", {
        "name": "helmet", "emissiveFactor": [1, 1, 1], "emissiveTexture": texture("emissive"),
        "normalTexture": texture("normal"),
        "pbrMetallicRoughness": {"baseColorTexture": texture("base_color"),
                                 "metallicRoughnessTexture": texture("metallic_roughness")}})
    glb.add_node(mesh=glb.add("meshes", {"primitives": [glb.primitive(mesh, material)]}), name="helmet")
    lens = {"yfov": float(np.radians(YFOV)), "aspectRatio": 4 / 3, "znear": 0.1}
    glb.add_node(camera=glb.add("cameras", {"type": "perspective", "perspective": lens}),
                 translation=list(EYE), rotation=camera_rotation())
    glb.write(folder / "helmet.glb")


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    textures.write(folder)
    mesh = helmet()
    write_glb(folder, mesh)
    files.write_ply(folder / "helmet.ply", mesh)
    here = pathlib.Path(__file__).parent
    for name in ("helmet.xml", "constant.xml", "sky.xml"):
        shutil.copy(here / name, folder)
    print(len(mesh["triangles"]), "triangles")


if __name__ == "__main__":
    main()
