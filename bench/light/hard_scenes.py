"""Writes scenes in which light is hard to find, once for microtrace and once for Mitsuba 3."""
import numpy as np

from agreement_scenes import Both, add_room, ball, box, quad


def add_lamp(scene, center, size, emission):
    """Adds a square lamp that shines down, and a black square above it."""
    x, y, z = np.subtract(center, (size / 2, 0, size / 2))
    scene.add(quad((x, y, z), (size, 0, 0), (0, 0, size)), (0, 0, 0), emission=emission)
    scene.add(quad((x, y + 0.005, z), (size, 0, 0), (0, 0, size)), (0, 0, 0))


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


SCENES = {f.__name__: f for f in (cornell, lamps, points, window, glass)}
