"""Writes scenes in which light is hard to find, once for microtrace and once for Mitsuba 3."""
import mitsuba as mi
import numpy as np

import files
import textures
from agreement_scenes import Both, add_room, ball, box, joined, quad, textured_quad


def add_lamp(scene, center, size, emission):
    """Adds a square lamp that shines down, and a black square above it."""
    x, y, z = np.subtract(center, (size / 2, 0, size / 2))
    scene.add(quad((x, y, z), (size, 0, 0), (0, 0, size)), (0, 0, 0), emission=emission)
    scene.add(quad((x, y + 0.005, z), (size, 0, 0), (0, 0, size)), (0, 0, 0))


def add_sky(scene):
    """Adds a sky with a sun."""
    mi.Bitmap(textures.sky(512).astype(np.float32)).write(str(scene.folder / "sky.exr"))
    scene.mitsuba["sky"] = {"type": "envmap", "filename": str(scene.folder / "sky.exr"),
                            "to_world": mi.ScalarTransform4f().rotate([0, 1, 0], 90)}
    scene.options = ["--env", "sky.exr"]


def random_edges(random, length):
    """Returns the edges of a square with a random orientation."""
    along, up = random.normal(size=(2, 3))
    up -= along * (along @ up) / (along @ along)
    return [length * v / np.linalg.norm(v) for v in (along, up)]


def write_leaf(folder):
    """Writes a mask with the outline of a leaf. Returns its path."""
    y, x = np.mgrid[0:64, 0:64] / 31.5 - 1
    path = folder / "leaf.png"
    files.write_png(path, ((np.abs(x) < 0.6 * np.cos(np.pi / 2 * y)) * 255).astype(np.uint8))
    return path


def cornell(folder):
    scene = Both(folder, "cornell", depth=8)
    add_room(scene)
    add_lamp(scene, (0, 0.98, 0), 0.6, 12.0)
    return scene


def lamps(folder):
    scene = Both(folder, "lamps", depth=8)
    add_room(scene)
    for x in np.linspace(-0.9, 0.9, 8):
        for z in np.linspace(-0.9, 0.9, 8):
            add_lamp(scene, (x, 0.95 - 0.3 * abs(x * z), z), 0.05, 40.0)
    return scene


def points(folder):
    scene = Both(folder, "points", depth=8)
    add_room(scene)
    random = np.random.default_rng(1)
    places, intensities = random.uniform(-0.95, 0.95, (1000, 3)), random.uniform(0.0005, 0.005, 1000)
    for place, intensity in zip(places.tolist(), intensities.tolist()):
        scene.add_point(place, intensity)
    return scene


def window(folder):
    """A closed room with a window of a twentieth of a wall, under a sky."""
    scene = Both(folder, "window", depth=8)
    white = (0.8, 0.8, 0.8)
    scene.add(quad((-2, -1, -2), (4, 0, 0), (0, 2, 0)), white)
    scene.add(quad((-2, -1, 5), (0, 0, -7), (0, 2, 0)), white)
    scene.add(quad((-2, -1, 5), (4, 0, 0), (0, 0, -7)), white)
    scene.add(quad((-2, 1, -2), (4, 0, 0), (0, 0, 7)), white)
    scene.add(quad((2, -1, 5), (-4, 0, 0), (0, 2, 0)), white)
    for low, high in (((-1, -2), (1, -0.4)), ((-1, 0.4), (1, 5)), ((-1, -0.4), (-0.2, 0.4)), ((0.4, -0.4), (1, 0.4))):
        scene.add(quad((2, low[0], low[1]), (0, 0, high[1] - low[1]), (0, high[0] - low[0], 0)), white)
    for side in box((-0.8, -1, -0.5), (-0.2, 0.2, 0.1)):
        scene.add(side, (0.6, 0.3, 0.1))
    scene.add(ball((0.5, -0.6, 0), 0.4), (0.7, 0.7, 0.7))
    scene.mitsuba["sky"] = {"type": "constant", "radiance": {"type": "rgb", "value": 3.0}}
    scene.options = ["--env", "3,3,3"]
    return scene


def glass(folder):
    """A Cornell box with a glass ball below the lamp."""
    scene = Both(folder, "glass", depth=12)
    add_room(scene)
    add_lamp(scene, (0, 0.98, 0), 0.3, 48.0)
    scene.add_glass(ball((0.1, 0.45, 0.2), 0.35))
    return scene


def thousand(folder):
    """A room with a thousand small lamps of one color that face all directions."""
    scene = Both(folder, "thousand", depth=8)
    add_room(scene)
    random = np.random.default_rng(2)
    lamps = []
    for _ in range(1000):
        along, up = random_edges(random, 0.01)
        lamps.append(quad(random.uniform(-0.95, 0.95, 3), along, up))
    scene.add(joined(lamps), (0, 0, 0), emission=100.0)
    return scene


def screen(folder):
    """Three small bright lamps, and a large screen whose texture is dark except for a few bright spots."""
    scene = Both(folder, "screen", depth=8)
    add_room(scene)
    for x in (-0.7, 0.0, 0.7):
        add_lamp(scene, (x, 0.9, -0.5), 0.01, 4000.0)
    pixels = np.full((64, 64, 3), 8, np.uint8)
    for row, column in np.random.default_rng(3).integers(2, 62, (12, 2)):
        pixels[row:row + 2, column:column + 2] = 255
    path = folder / "screen.png"
    files.write_png(path, pixels)
    scene.add(textured_quad((-0.8, -0.2, -0.98), (1.6, 0, 0), (0, 0.9, 0)), (0, 0, 0), emission=40.0, emissive_png=path)
    return scene


def bulb(folder):
    """A Cornell box that is lit by a small ball within a bulb of glass."""
    scene = Both(folder, "bulb", depth=12)
    add_room(scene)
    scene.add(ball((0.1, 0.45, 0.2), 0.08, rows=16), (0, 0, 0), emission=60.0)
    inside = ball((0.1, 0.45, 0.2), 0.22)
    inside |= {"normals": -inside["normals"], "triangles": inside["triangles"][:, ::-1]}
    scene.add_glass(joined([ball((0.1, 0.45, 0.2), 0.25), inside]))
    return scene


def metal(folder):
    """Caustics of two polished metal balls under a small lamp."""
    scene = Both(folder, "metal", depth=8)
    add_room(scene)
    add_lamp(scene, (0, 0.98, 0), 0.2, 100.0)
    scene.add(ball((0.5, -0.6, 0.6), 0.35), conductor=0.1)
    scene.add(ball((-0.3, 0.5, -0.1), 0.3), conductor=0.2)
    return scene


def white(folder):
    """A closed white room. Its lamp shines only at the ceiling."""
    scene = Both(folder, "white", depth=16)
    color = (0.9, 0.9, 0.9)
    scene.add(quad((-1, -1, -1), (2, 0, 0), (0, 2, 0)), color)
    scene.add(quad((-1, -1, 5), (2, 0, 0), (0, 0, -6)), color)
    scene.add(quad((-1, 1, -1), (2, 0, 0), (0, 0, 6)), color)
    scene.add(quad((-1, -1, 5), (0, 0, -6), (0, 2, 0)), color)
    scene.add(quad((1, -1, -1), (0, 0, 6), (0, 2, 0)), color)
    scene.add(quad((1, -1, 5), (-2, 0, 0), (0, 2, 0)), color)
    for side in box((-0.6, -1, -0.5), (-0.1, 0.2, 0.1)) + box((0.1, -1, 0), (0.6, -0.4, 0.5)):
        scene.add(side, color)
    scene.add(quad((-0.3, 0.7, 0.3), (0.6, 0, 0), (0, 0, -0.6)), (0, 0, 0), emission=3.0)
    scene.add(quad((-0.3, 0.69, 0.3), (0.6, 0, 0), (0, 0, -0.6)), color)
    return scene


def ajar(folder):
    """A room that is lit only through a narrow gap from a bright room beside it."""
    scene = Both(folder, "ajar", depth=12)
    white = (0.8, 0.8, 0.8)
    scene.add(quad((-1, -1, -1), (4, 0, 0), (0, 2, 0)), white)
    scene.add(quad((-1, -1, 5), (4, 0, 0), (0, 0, -6)), white)
    scene.add(quad((-1, 1, -1), (4, 0, 0), (0, 0, 6)), white)
    scene.add(quad((-1, -1, 5), (0, 0, -6), (0, 2, 0)), white)
    scene.add(quad((3, -1, -1), (0, 0, 6), (0, 2, 0)), white)
    scene.add(quad((3, -1, 5), (-4, 0, 0), (0, 2, 0)), white)
    scene.add(quad((1, -1, -0.85), (0, 0, 5.85), (0, 2, 0)), white)
    for side in box((-0.6, -1, -0.5), (-0.1, 0.2, 0.1)) + box((0.1, -1, 0), (0.6, -0.4, 0.5)):
        scene.add(side, (0.6, 0.3, 0.1))
    add_lamp(scene, (2, 0.98, 0), 0.6, 60.0)
    return scene


def leaves(folder):
    """Ground and a wall in the shade of leaves, whose outlines are textures, under a sky with a sun."""
    scene = Both(folder, "leaves", depth=8)
    scene.add(quad((-9, -1, 9), (18, 0, 0), (0, 0, -18)), (0.4, 0.35, 0.3))
    scene.add(quad((-9, -1, -1.5), (18, 0, 0), (0, 4, 0)), (0.7, 0.7, 0.7))
    path = write_leaf(folder)
    random = np.random.default_rng(4)
    quads = []
    for _ in range(1500):
        along, up = random_edges(random, 0.25)
        quads.append(textured_quad(random.uniform((-3, 0.3, -1.3), (3, 2.2, 3)), along, up))
    scene.add(joined(quads), (0.2, 0.5, 0.1), mask_png=path)
    add_sky(scene)
    return scene


SCENES = {f.__name__: f for f in (cornell, lamps, points, window, glass, thousand, screen, bulb, metal, white, ajar, leaves)}
