"""Writes scenes like the models that people render: textured, coated and transparent surfaces under a sky with a sun."""
import mitsuba as mi
import numpy as np

import files
import textures
from agreement_scenes import Both, ball, joined, quad, textured_quad
from hard_scenes import add_sky, random_edges, write_leaf
from helmet import patch


def texture_files(folder, size):
    """Writes the helmet's textures with fewer pixels. Returns their paths by name."""
    paths = {}
    for name, pixels in textures.maps().items():
        paths[name] = folder / f"{name}_{size}.png"
        if not paths[name].exists():
            step = textures.SIZE // size
            files.write_png(paths[name], np.ascontiguousarray(pixels[::step, ::step]))
    return paths


def column(x, z):
    """A fluted column."""
    def surface(u, v):
        angle = -2 * np.pi * u
        radius = 0.11 + 0.02 * np.cos(np.pi * (v - 0.5)) - 0.006 * np.cos(20 * angle) + 0.05 * (v < 0.06) + 0.05 * (v > 0.94)
        return np.stack([x + radius * np.cos(angle), 1 - 2 * v, z + radius * np.sin(angle)], -1)
    return patch(surface, 80, 45, (0, 0, 1, 1))


def curtain(x, z):
    def surface(u, v):
        fold = 0.04 * np.sin(30 * u + 3 * v) * (0.3 + v) + 0.02 * np.sin(7 * u)
        return np.stack([x + fold, 0.7 - 1.4 * v, z + 0.7 * (0.5 - u)], -1)
    return patch(surface, 100, 40, (0, 0, 1, 1))


def atrium(folder):
    """A court of columns, curtains and plants with three sets of textures, open to the sky; 262 000 triangles."""
    scene = Both(folder, "atrium", depth=8)
    stone, cloth = texture_files(folder, 2048), texture_files(folder, 1024)
    walls = [textured_quad((-1.6, -1, 5), (3.2, 0, 0), (0, 0, -8)), textured_quad((-1.6, -1, -3), (3.2, 0, 0), (0, 2.6, 0)),
             textured_quad((-1.6, -1, 5), (0, 0, -8), (0, 2.6, 0)), textured_quad((1.6, -1, -3), (0, 0, 8), (0, 2.6, 0)),
             textured_quad((1.6, -1, 5), (-3.2, 0, 0), (0, 2.6, 0))]
    scene.add_textured(joined(walls), cloth, metallic=0)
    places = [(x, z) for x in (-1, 1) for z in np.linspace(-2.4, 2.4, 11)]
    scene.add_textured(joined([column(x, z) for x, z in places]), stone, metallic=0)
    scene.add_textured(joined([curtain(1.2 * x, z + 0.24) for x, z in places if (z > -2) or x > 0][:13]), cloth)
    random = np.random.default_rng(5)
    plants = []
    for px, pz in [(x * 0.75, z) for x, z in places[::2]]:
        for _ in range(60):
            along, up = random_edges(random, 0.12)
            plants.append(textured_quad((px, -0.8, pz) + random.uniform(-0.15, 0.15, 3), along, up))
    scene.add(joined(plants), (0.2, 0.5, 0.1), mask_png=write_leaf(folder))
    add_sky(scene)
    return scene


def car(folder):
    """A coated body with windows of glass, tires and metal rims on the ground."""
    scene = Both(folder, "car", depth=12)
    scene.add(quad((-9, -0.9, 9), (18, 0, 0), (0, 0, -18)), (0.35, 0.35, 0.35))

    def bulge(size, center, power):
        def surface(u, v):
            phi, theta = 2 * np.pi * u, np.pi * v
            d = np.stack([np.sin(phi) * np.sin(theta), np.cos(theta), np.cos(phi) * np.sin(theta)], -1)
            return np.array(center) + np.sign(d) * np.abs(d) ** power * size
        return surface
    scene.add_coated(patch(bulge((1.6, 0.35, 0.75), (0, -0.35, 0), 0.6), 300, 150, (0, 0, 1, 1)), (0.7, 0.05, 0.03), metallic=0.3, roughness=0.4)
    window = patch(bulge((0.85, 0.45, 0.6), (-0.1, -0.05, 0), 0.8), 120, 60, (0, 0, 1, 1))
    inside = patch(bulge((0.83, 0.43, 0.58), (-0.1, -0.05, 0), 0.8), 120, 60, (0, 0, 1, 1))
    inside |= {"normals": -inside["normals"], "triangles": inside["triangles"][:, ::-1]}
    scene.add_glass(joined([window, inside]))
    for x in (-0.95, 0.95):
        for z in (-0.62, 0.62):
            def tire(u, v, x=x, z=z):
                phi, around = 2 * np.pi * u, 2 * np.pi * v
                radius = 0.2 + 0.08 * np.cos(around)
                return np.stack([x + radius * np.cos(phi), -0.62 + radius * np.sin(phi), z + 0.09 * np.sin(around)], -1)
            scene.add(patch(tire, 80, 30, (0, 0, 1, 1)), (0.02, 0.02, 0.02))
            scene.add(ball((x, -0.62, z), 0.13), conductor=0.2)
    add_sky(scene)
    return scene


def sphere(folder):
    """A bumpy sphere of a million triangles."""
    scene = Both(folder, "sphere", depth=8)

    def surface(u, v):
        phi, theta = 2 * np.pi * u, np.pi * v
        radius = 1 + 0.03 * np.sin(20 * phi) * np.sin(17 * theta) * np.sin(theta)
        d = np.stack([np.sin(phi) * np.sin(theta), np.cos(theta), np.cos(phi) * np.sin(theta)], -1)
        return d * radius[..., None]
    scene.add(patch(surface, 1000, 500, (0, 0, 1, 1)), (0.7, 0.7, 0.7))
    scene.mitsuba["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": 1.0}}
    scene.options = ["--env", "1,1,1"]
    return scene


SCENES = {f.__name__: f for f in (atrium, car, sphere)}
