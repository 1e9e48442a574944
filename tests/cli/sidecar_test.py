#!/usr/bin/env python3
"""Renders scenes with AOVs, and compares the sidecar with the EXR file by an independent reader and independent formulas.

usage: sidecar_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import json
import math
import os
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from exr import Exr
from program import ProgramTest

SOURCE = Path(sys.argv[2]).resolve()
ALL = "depth,distance,position,normal,face_normal,uv,barycentric,albedo,id"


def distorted(camera, x, y, z):
    """Returns the pixel that shows a point. The point is given by its distances to the right of, below and in front of the
    camera. Uses the formulas of OpenCV's documentation, with powers summed directly."""
    k = camera["distortion"]
    if k["type"] == "fisheye":
        across = math.hypot(x, y)
        angle = math.atan2(across, z)
        theta = angle + sum(k[f"k{i}"] * angle ** (2 * i + 1) for i in range(1, 5))
        u, v = x * theta / across, y * theta / across
    else:
        a, b = x / z, y / z
        r2 = a * a + b * b
        factor = (1 + sum(k[f"k{i}"] * r2 ** i for i in range(1, 4))) / (1 + sum(k[f"k{i + 3}"] * r2 ** i for i in range(1, 4)))
        u = a * factor + 2 * k["p1"] * a * b + k["p2"] * (r2 + 2 * a * a)
        v = b * factor + k["p1"] * (r2 + 2 * b * b) + 2 * k["p2"] * a * b
    return camera["fx"] * u + camera["cx"], camera["fy"] * v + camera["cy"]


def transformed(rows, point):
    return [sum(r[k] * point[k] for k in range(3)) + r[3] for r in rows[:3]]


class Sidecar(ProgramTest):
    def draw(self, scene, *options):
        """Renders a scene and makes the checks that apply to every scene. Returns the sidecar and the picture."""
        result = self.run_program(SOURCE / "scenes" / scene, "--aov", ALL, "-o", "a.exr", "--size", "60x45", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.exr", "a.exr.json"])
        sidecar = json.loads((self.folder / "a.exr.json").read_text())
        picture = Exr(self.folder / "a.exr")
        self.assertEqual(sidecar["version"], 1)
        self.assertEqual(sidecar["picture"], "a.exr")
        self.assertEqual(picture.display_window, (0, 0, sidecar["width"], sidecar["height"]))
        self.assertEqual(list(picture.data_window), sidecar["crop"])
        for name, kind in picture.types.items():
            self.assertEqual(kind, "I" if name.startswith("id.") else "f", name)
        self.check_objects(sidecar, picture)
        self.check_camera(sidecar, picture)
        return sidecar, picture

    def pixels(self, picture, *names):
        """Yields x and y in the whole picture, followed by the channels' numbers."""
        x0, y0, _, _ = picture.data_window
        for row in range(picture.height):
            for column in range(picture.width):
                yield (x0 + column, y0 + row, *(picture.channels[name][row][column] for name in names))

    def check_objects(self, sidecar, picture):
        objects = sidecar["objects"]
        self.assertEqual([o["id"] for o in objects], list(range(1, len(objects) + 1)))
        self.assertEqual(len({o["name"] for o in objects}), len(objects))
        seen = {}
        for x, y, instance, primitive, material, depth, *p in self.pixels(
                picture, "id.instance", "id.primitive", "id.material", "depth.Z", "position.X", "position.Y",
                "position.Z"):
            if instance == 0:
                self.assertEqual((primitive, material, *p), (0, 0, 0, 0, 0))
                self.assertEqual(depth, math.inf)
                continue
            self.assertGreater(primitive, 0)
            thing = objects[instance - 1]
            self.assertEqual(material, thing["material"])
            seen.setdefault(instance, []).append((x, y))
            if thing["world_box"]:
                for k in range(3):
                    low, high = thing["world_box"]["min"][k], thing["world_box"]["max"][k]
                    slack = 1e-6 * max(abs(low), abs(high))
                    self.assertTrue(low - slack <= p[k] <= high + slack, (thing, p))
        for thing in objects:
            pixels = seen.get(thing["id"], [])
            self.assertEqual(thing["visible_pixels"], len(pixels))
            columns, rows = [x for x, _ in pixels], [y for _, y in pixels]
            box = [min(columns), min(rows), max(columns) + 1, max(rows) + 1] if pixels else None
            self.assertEqual(thing["box"], box)
        self.assertLessEqual({o["material"] for o in objects}, {0} | {m["id"] for m in sidecar["materials"]})

    def check_camera(self, sidecar, picture):
        """Checks that each visible position projects to the center of its pixel and has the pixel's depth."""
        camera = sidecar["camera"]
        there, back = camera["world_from_camera"], camera["camera_from_world"]
        for a in range(4):
            for b in range(4):
                product = sum(there[a][k] * back[k][b] for k in range(4))
                self.assertAlmostEqual(product, 1 if a == b else 0, places=9)
        checked = 0
        for x, y, instance, depth, distance, *p in self.pixels(
                picture, "id.instance", "depth.Z", "distance.T", "position.X", "position.Y", "position.Z"):
            if instance == 0:
                continue
            checked += 1
            cx, cy, cz = transformed(back, p)
            place = [row[3] for row in there[:3]]
            size = 1e-6 * (max(map(abs, place + p)) + 1)
            if camera["type"] == "environment":
                length = math.sqrt(cx * cx + cy * cy + cz * cz)
                self.assertAlmostEqual(depth, length, delta=size)
                u = math.atan2(cx, -cz) / (2 * math.pi) + 0.5
                v = 0.5 - math.asin(cy / length) / math.pi
                self.assertAlmostEqual(u * sidecar["width"], x + 0.5, delta=1e-2)
                self.assertAlmostEqual(v * sidecar["height"], y + 0.5, delta=1e-2)
                continue
            self.assertAlmostEqual(depth, -cz, delta=size)
            if camera["type"] == "perspective":
                self.assertAlmostEqual(distance, math.sqrt(cx * cx + cy * cy + cz * cz), delta=size)
                u, v = camera["cx"] - camera["fx"] * cx / cz, camera["cy"] + camera["fy"] * cy / cz
            elif camera["type"] == "calibrated":
                self.assertAlmostEqual(distance, math.sqrt(cx * cx + cy * cy + cz * cz), delta=size)
                u, v = distorted(camera, cx, -cy, -cz)
            else:
                self.assertAlmostEqual(distance, -cz, delta=size)
                u = camera["cx"] + camera["pixels_per_unit"] * cx
                v = camera["cy"] - camera["pixels_per_unit"] * cy
            self.assertAlmostEqual(u, x + 0.5, delta=1e-3)
            self.assertAlmostEqual(v, y + 0.5, delta=1e-3)
            is_fisheye = camera.get("distortion", {}).get("type") == "fisheye"
            self.assertGreaterEqual(distance if is_fisheye else depth, camera["near"])
            self.assertTrue(camera["far"] is None or depth <= camera["far"])
        self.assertGreater(checked, 50)

    def test_scenes(self):
        for scene in ("perspective1.json", "orthographic.json", "environment.json", "ellipsoid.json", "framed.json",
                      "mesh.json", "gltf/cube.glb", "gltf/knot.glb"):
            with self.subTest(scene):
                self.draw(scene)

    def test_calibrated_cameras(self):
        scene = json.loads((SOURCE / "scenes/calibrated.json").read_text())
        for index, written in enumerate(scene["cameras"]):
            with self.subTest(written["name"]):
                sidecar, picture = self.draw("calibrated.json", "-c", written["name"])
                camera, image = sidecar["camera"], written["image"]
                # A picture of 60 x 45 pixels shows the whole calibrated image at another size. In OpenCV, pixel centers
                # have integer coordinates.
                self.assertAlmostEqual(camera["fx"], written["fx"] * 60 / image["width"], places=12)
                self.assertAlmostEqual(camera["fy"], written["fy"] * 45 / image["height"], places=12)
                self.assertAlmostEqual(camera["cx"], (written["cx"] + 0.5) * 60 / image["width"], places=12)
                self.assertAlmostEqual(camera["cy"], (written["cy"] + 0.5) * 45 / image["height"], places=12)
                for name, value in camera["distortion"].items():
                    self.assertEqual(value, written["distortion"].get(name, 0))
                if index == 1:  # OpenCV's axes differ in sign
                    for r in range(3):
                        for c in range(4):
                            sign = 1 if r == 0 else -1
                            self.assertAlmostEqual(camera["camera_from_world"][r][c] * sign, written["extrinsic"][r][c], places=12)
                if index == 2:  # the picture shows points behind the camera, and its corners have no rays
                    depths = picture.channels["depth.Z"]
                    self.assertLess(min(min(row) for row in depths), -5)
                    self.assertTrue(all(math.isinf(depths[y][x]) for y in (0, 44) for x in (0, 59)))

    def test_views_and_crops(self):
        self.draw("gltf/cube.glb", "--view", "-33,71")
        sidecar, _ = self.draw("gltf/knot.glb", "--crop", "7,9,52,40", "--spp", "3", "--background", "transparent")
        self.assertEqual(sidecar["crop"], [7, 9, 52, 40])
        self.assertEqual((sidecar["width"], sidecar["height"]), (60, 45))

    def test_closed_forms(self):
        """Compares a unit sphere in front of a wall, seen along -z, with closed-form results."""
        scene = {"version": 1,
                 "cameras": [{"type": "perspective", "position": [0, 0, 4], "direction": [0, 0, -1], "vertical_fov": 60}],
                 "objects": [{"name": "ball", "type": "sphere", "center": [0, 0, 0], "radius": 1},
                             {"name": "wall", "type": "plane", "point": [0, 0, -2], "normal": [0, 0, 1], "color": [1, 0, 0]}]}
        (self.folder / "s.json").write_text(json.dumps(scene))
        result = self.run_program("s.json", "--aov", ALL, "-o", "a.exr", "--size", "80x60")
        self.assertEqual(result.returncode, 0, result.stderr)
        sidecar, picture = json.loads((self.folder / "a.exr.json").read_text()), Exr(self.folder / "a.exr")
        ball, wall = sidecar["objects"]
        self.assertEqual((ball["name"], wall["name"]), ("ball", "wall"))
        self.assertEqual(ball["world_box"], {"min": [-1, -1, -1], "max": [1, 1, 1]})
        self.assertIsNone(wall["world_box"])
        focal = 30 / math.tan(math.radians(30))
        self.assertAlmostEqual(sidecar["camera"]["fx"], focal, places=9)
        radius = focal / math.sqrt(15)  # radius of the ball's outline
        self.assertAlmostEqual(ball["visible_pixels"], math.pi * radius * radius, delta=0.02 * math.pi * radius * radius)
        self.assertEqual(ball["visible_pixels"] + wall["visible_pixels"], 80 * 60)
        self.assertEqual(wall["box"], [0, 0, 80, 60])
        x0, y0, x1, y1 = ball["box"]
        self.assertEqual((x0 + x1, y0 + y1), (80, 60))
        for x, y, instance, depth, *n in self.pixels(picture, "id.instance", "depth.Z", "normal.X", "normal.Y", "normal.Z"):
            right, up = (x + 0.5 - 40) / focal, (30 - y - 0.5) / focal
            if instance == 2:
                self.assertEqual((depth, *n), (6, 0, 0, 1))
                continue
            # Solves |(right, up, -1) d + (0, 0, 4)| = 1 for d.
            a, b, c = right * right + up * up + 1, -4, 15
            d = (-b - math.sqrt(b * b - a * c)) / a
            self.assertAlmostEqual(depth, d, delta=1e-6)
            for got, wanted in zip(n, (right * d, up * d, 4 - d)):
                self.assertAlmostEqual(got, wanted, delta=1e-6)

    def test_named_sidecars(self):
        cube = SOURCE / "scenes/gltf/cube.glb"
        options = [cube, "--size", "20x15"]
        result = self.run_program(*options, "-o", "a.png", "--sidecar", "b.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.png", "b.json"])
        sidecar = json.loads((self.folder / "b.json").read_text())
        self.assertEqual(sidecar["picture"], "a.png")
        self.assertGreater(sum(o["visible_pixels"] for o in sidecar["objects"]), 50)
        self.assertEqual(self.run_program(*options, "-o", "c.exr", "--sidecar", "d.json").returncode, 0)
        self.assertEqual(set(Exr(self.folder / "c.exr").types), {"R", "G", "B"})
        first = (self.folder / "d.json").read_bytes()
        self.assertEqual(self.run_program(*options, "-o", "c.exr", "--sidecar", "d.json", "-t", "3").returncode, 0)
        self.assertEqual((self.folder / "d.json").read_bytes(), first)

    def test_names_that_are_not_utf8(self):
        name = os.fsdecode(b"a\xffb.ppm")
        self.assertEqual(self.run_program(SOURCE / "scenes/perspective1.json", "-o", name, "--sidecar", "s.json", "--size", "8x6").returncode, 0)
        self.assertEqual(json.loads((self.folder / "s.json").read_text())["picture"], "a\ufffdb.ppm")

    def test_picture_and_sidecar_are_not_mixed_in_a_pipe(self):
        for sidecar in ("-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"):
            result = self.run_program(SOURCE / "scenes/gltf/cube.glb", "--size", "20x15", "-o", "-", "--sidecar", sidecar)
            self.assertEqual((result.returncode, result.stdout), (2, b""), sidecar)

    def test_all_or_nothing(self):
        cube = SOURCE / "scenes/gltf/cube.glb"
        (self.folder / "a.exr").write_text("precious")
        for sidecar, code in (("missing/b.json", 5), ("/dev/full", 5), ("a.exr", 2), ("./a.exr", 2), (".", 5)):
            result = self.run_program(cube, "-o", "a.exr", "--sidecar", sidecar)
            self.assertEqual(result.returncode, code, (sidecar, result.stderr))
            self.assertEqual(os.listdir(self.folder), ["a.exr"])
            self.assertEqual((self.folder / "a.exr").read_text(), "precious")
        (self.folder / "full.exr").symlink_to("/dev/full")
        result = self.run_program(cube, "-o", "full.exr", "--sidecar", "b.json")
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertFalse((self.folder / "b.json").exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
