#!/usr/bin/env python3
"""Tests the command line: exit codes, messages and written files.

usage: cli_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import base64
import json
import math
import os
import re
import resource
import signal
import struct
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from exr import Exr
from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
SCENE = SOURCE / "scenes/perspective1.json"


def minimal(**changes):
    scene = {
        "version": 1,
        "image": {"width": 4, "height": 3},
        "cameras": [{"type": "perspective", "position": [0, 0, 10], "direction": [0, 0, -1],
                     "vertical_fov": 60}],
        "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1}],
    }
    scene.update(changes)
    return json.dumps(scene)


class CommandLine(ProgramTest):
    def run_and_measure(self, *arguments):
        """Returns the exit code, standard error, and peak memory in KiB."""
        with open(self.folder.parent / f"{self.folder.name}.err", "w+b") as errors:
            os.unlink(errors.name)
            process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stderr=errors)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            errors.seek(0)
            return process.returncode, errors.read().decode(errors="replace"), usage.ru_maxrss

    def write(self, name, text):
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def assert_refused(self, scene_text, code, *fragments, name="scene.json"):
        """Checks that the scene fails with this exit code and one message with all fragments, and that no other file
        appears."""
        self.write(name, scene_text)
        result = self.run_program(name, "-o", "out.ppm")
        message = result.stderr.decode(errors="replace")
        self.assertEqual(result.returncode, code, message)
        self.assertTrue(message.startswith("error: "), message)
        self.assertIn(name, message)
        for fragment in fragments:
            self.assertIn(fragment, message)
        self.assertEqual(os.listdir(self.folder), [name])
        return message

    # Rendering

    def test_json_scenes_have_neither_variants_nor_animations(self):
        scene = SOURCE / "scenes/perspective1.json"
        result = self.run_program(scene, "--variant", "0", "-o", "a.ppm")
        self.assertEqual((result.returncode, b"has no variants" in result.stderr), (2, True))
        result = self.run_program(scene, "--time", "1", "--size", "8x8", "-o", "a.ppm")
        self.assertEqual((result.returncode, b"has no animation" in result.stderr), (0, True))

    def test_renders_to_the_named_file(self):
        result = self.run_program(SCENE, "-o", "a.ppm")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, b"")
        data = (self.folder / "a.ppm").read_bytes()
        self.assertTrue(data.startswith(b"P6\n640 480\n255\n"))
        self.assertEqual(len(data), 15 + 640 * 480 * 3)

    def test_default_output_is_named_after_the_scene(self):
        self.assertEqual(self.run_program(SCENE, "--size", "8x6").returncode, 0)
        self.assertEqual(os.listdir(self.folder), ["perspective1.png"])

    def test_standard_streams(self):
        with open(SCENE, "rb") as scene:
            result = self.run_program("-", "-o", "-", "--size", "8x6", stdin=scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(result.stdout.startswith(b"P6\n8 6\n255\n"))
        self.assertEqual(os.listdir(self.folder), [])

    def test_ascii_holds_the_same_pixels(self):
        binary = self.run_program(SCENE, "-o", "-", "--size", "40x30").stdout
        text = self.run_program(SCENE, "-o", "-", "--size", "40x30", "--ppm", "ascii").stdout
        tokens = text.split()
        self.assertEqual(tokens[:4], [b"P3", b"40", b"30", b"255"])
        self.assertEqual(bytes(map(int, tokens[4:])), binary[len(b"P6\n40 30\n255\n"):])

    def test_cameras_by_name_and_index(self):
        cameras = [{"name": name, "type": "orthographic", "position": [x, 0, 10],
                    "direction": [0, 0, -1], "height": 2} for name, x in (("near", 0), ("far", 50))]
        self.write("two.json", minimal(cameras=cameras))
        pictures = [self.run_program("two.json", "-o", "-", *c).stdout
                    for c in ([], ["-c", "near"], ["-c", "1"], ["--camera", "far"])]
        self.assertEqual(pictures[0], pictures[1])
        self.assertEqual(pictures[2], pictures[3])
        self.assertNotEqual(pictures[0], pictures[2])
        wrong = self.run_program("two.json", "-c", "middle")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn(b"0 (near), 1 (far)", wrong.stderr)

    def test_threads_do_not_change_the_picture(self):
        pictures = {self.run_program(SCENE, "-o", "-", "-t", threads).stdout
                    for threads in (1, 2, 3, 16)}
        self.assertEqual(len(pictures), 1)

    def test_crop_has_the_pixels_of_the_whole_picture(self):
        for samples in (1, 5):
            options = [SCENE, "--size", "100x60", "--spp", samples]
            _, _, whole = self.picture(*options)
            for x0, y0, x1, y1 in ((0, 0, 100, 60), (7, 9, 64, 41), (99, 59, 100, 60)):
                width, height, part = self.picture(*options, "--crop", f"{x0},{y0},{x1},{y1}")
                self.assertEqual((width, height), (x1 - x0, y1 - y0))
                self.assertEqual(part, [row[3 * x0:3 * x1] for row in whole[y0:y1]])
        for crop in ("0,0,641,480", "0,0,640,481", "5,5,5,6", "9,0,2,5"):
            wrong = self.run_program(SCENE, "-o", "a.ppm", "--crop", crop)
            self.assertEqual(wrong.returncode, 2, wrong.stderr)
            self.assertIn(b"crop", wrong.stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_views(self):
        cube = SOURCE / "scenes/gltf/cube.glb"
        for size in ("120x80", "80x120"):
            width, height = map(int, size.split("x"))
            pictures = {}
            for view in (None, "30,25", "front", "back", "left", "right", "top", "bottom", "iso"):
                _, _, rows = self.picture(cube, "--integrator", "flat", "--size", size, *(["--view", view] if view else []))
                pictures[view] = b"".join(rows)
                drawn = [[row[3 * x:3 * x + 3] != b"\0\0\0" for x in range(width)] for row in rows]
                columns = [x for x in range(width) if any(row[x] for row in drawn)]
                lines = [y for y in range(height) if any(drawn[y])]
                filled = max((columns[-1] - columns[0] + 1) / width, (lines[-1] - lines[0] + 1) / height)
                self.assertGreater(filled, 0.87, (size, view))
                self.assertLess(filled, 0.93, (size, view))
            self.assertEqual(pictures[None], pictures["30,25"])
            self.assertNotEqual(pictures["front"], pictures["right"])
        self.assertNotEqual(self.picture(SCENE, "--view", "top"), self.picture(SCENE))
        for view in ("sideways", "1", "1,2,0", "1,2,-3", "1,91,3", "1,2,3,4", "1,2,inf", "0,91", "nan,0", "1;2", ","):
            self.assertEqual(self.run_program(cube, "--view", view).returncode, 2, view)
        self.assertEqual(self.run_program(SCENE, "--view", "top", "-c", "0").returncode, 2)
        none = self.run_program(cube, "-c", "0")
        self.assertEqual(none.returncode, 2)
        self.assertIn(b"--view", none.stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def camera(self, scene, *options):
        """Returns the camera's position, its directions to the right, up and back, and the focal length in picture
        heights."""
        result = self.run_program(scene, "--integrator", "flat", "--size", "40x30", "--sidecar", "s.json", "-o", "s.ppm", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        camera = json.loads((self.folder / "s.json").read_text())["camera"]
        columns = [[row[k] for row in camera["world_from_camera"]] for k in (3, 0, 1, 2)]
        return [columns[0][:3], *[c[:3] for c in columns[1:]], camera["fy"] / 30]

    def assert_near(self, numbers, expected):
        for number, wanted in zip(numbers, expected, strict=True):
            self.assertAlmostEqual(number, wanted, places=9)

    def test_a_camera_around_a_target(self):
        cube = SOURCE / "scenes/gltf/cube.glb"
        theta, phi, r, target = 0.5, 1.1, 4.0, (1.0, -2.0, 0.5)
        position, _, up, back, focal = self.camera(
            cube, "--view", f"{math.degrees(theta)},{90 - math.degrees(phi)},{r}",
            "--target", ",".join(map(str, target)), "--fov", "60")
        away = (math.sin(phi) * math.sin(theta), math.cos(phi), math.sin(phi) * math.cos(theta))
        self.assert_near(back, away)
        self.assert_near(position, [t + r * a for t, a in zip(target, away)])
        self.assertGreater(up[1], 0)
        self.assertAlmostEqual(focal, 0.5 / math.tan(math.radians(30)), places=9)
        # Without --target, the camera looks at the center of the scene's box. Equivalent views have the same direction.
        middle = self.camera(cube, "--view", "90,0,7")[0]
        self.assert_near(self.camera(cube, "--view", "-270,0,9")[0], [middle[0] + 2, *middle[1:]])

    def test_a_camera_at_a_point(self):
        cube = SOURCE / "scenes/gltf/cube.glb"
        position, right, up, back, focal = self.camera(cube, "--eye", "1,2,3", "--target", "1,2,-5")
        self.assertEqual((position, right, up, back), ([1, 2, 3], [1, 0, 0], [0, 1, 0], [0, 0, 1]))
        self.assertAlmostEqual(focal, 0.5 / math.tan(math.radians(22.5)), places=9)
        down = self.camera(cube, "--eye", "0,9,0", "--target", "0,0,0", "--up", "1,0,0", "--fov", "90")
        self.assert_near([*down[1], *down[2], down[4]], [0, 0, 1, 1, 0, 0, 0.5])
        for options in (["--eye", "0,9,0", "--target", "0,0,0"], ["--eye", "1,1,1", "--target", "1,1,1"], ["--eye", "1,1"],
                        ["--eye", "1,1,nan"], ["--eye", "1,1,5", "--view", "front"], ["--target", "0,0,0"],
                        ["--view", "front", "--target", "0,0,0"], ["--view", "1,2,3", "--up", "0,0,1"], ["--fov", "30"],
                        ["--view", "front", "--fov", "180"], ["--view", "front", "--fov", "0"]):
            wrong = self.run_program(cube, "-o", "a.ppm", *options)
            self.assertEqual(wrong.returncode, 2, (options, wrong.stderr))
            self.assertFalse((self.folder / "a.ppm").exists())

    def test_lens(self):
        scene, light = SOURCE / "scenes/light.json", ["--integrator", "path", "--size", "24x18", "--spp", "2"]
        pinhole = self.picture(scene, *light)
        self.assertEqual(self.picture(scene, *light, "--aperture", "0", "--focus", "9"), pinhole)
        blurred = self.picture(scene, *light, "--aperture", "0.3", "--focus", "9", "--sidecar", "s.json")
        self.assertNotEqual(blurred, pinhole)
        camera = json.loads((self.folder / "s.json").read_text())["camera"]
        self.assertEqual((camera["lens_radius"], camera["focus"]), (0.3, 9))
        document = json.loads(scene.read_text())
        document["cameras"][0] |= {"lens_radius": 0.3, "focus": 9}
        for item in document["objects"]:
            if "file" in item:
                mesh = SOURCE / "scenes" / item["file"]
                (self.folder / mesh.name).write_bytes(mesh.read_bytes())
                item["file"] = mesh.name
        (self.folder / "lens.json").write_text(json.dumps(document))
        self.assertEqual(self.picture(self.folder / "lens.json", *light), blurred)
        self.assertNotEqual(self.picture(self.folder / "lens.json", *light, "--focus", "3"), blurred)
        for threads in ("1", "3"):
            self.assertEqual(self.picture(scene, *light, "--aperture", "0.3", "--focus", "9", "-t", threads), blurred)
        flat = ["--integrator", "flat", "--size", "24x18"]
        self.assertEqual(self.picture(self.folder / "lens.json", *flat), self.picture(scene, *flat))
        wrong = self.run_program(scene, *light, "--camera", "flat", "--focus", "3", "-o", "a.ppm")
        self.assertEqual((wrong.returncode, wrong.stderr),
                         (2, b"error: --focus: only perspective cameras have a lens; choose another camera\n"))

    def test_backgrounds(self):
        cube = SOURCE / "scenes/gltf/cube.glb"
        corner = lambda *options: self.picture(cube, "--integrator", "flat", "--size", "40x30", *options)[2][0][:3]
        self.assertEqual(corner(), b"\0\0\0")
        self.assertEqual(corner("--background", "#2b7CfF"), b"\x2b\x7c\xff")
        self.assertEqual(corner("--background", "0.5,0,1"), b"\xbc\x00\xff")  # linear light, which is encoded as sRGB
        for background in ("blue", "#12345", "#12345g", "1,2,0", "1,1", "1,1,1,1", "nan,0,0", "-1,0,0"):
            wrong = self.run_program(cube, "--background", background)
            self.assertEqual(wrong.returncode, 2, background)
            self.assertIn(b"--background", wrong.stderr)
        for output in ("-", "a.ppm", "a.jpg"):
            wrong = self.run_program(cube, "--background", "transparent", "-o", output)
            self.assertEqual(wrong.returncode, 2, wrong.stderr)
            self.assertIn(b"has no alpha; write .png or .exr", wrong.stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_variants(self):
        color = lambda *rgb: {"pbrMetallicRoughness": {"baseColorFactor": [*rgb, 1]}}
        variants = "KHR_materials_variants"
        corners = struct.pack("<9f", -9, -9, 0, 9, -9, 0, 0, 9, 0)
        self.write("a.gltf", json.dumps({
            "asset": {"version": "2.0"}, "extensionsUsed": [variants],
            "extensions": {variants: {"variants": [{"name": "leaf"}, {"name": "sea"}]}},
            "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]}],
            "cameras": [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 1, "zfar": 9}}],
            "materials": [color(1, 0, 0), color(0, 1, 0), color(0, 0, 1)],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0, "extensions": {variants: {
                "mappings": [{"material": 1, "variants": [0]}, {"material": 2, "variants": [1]}]}}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
                           "min": [-9, -9, 0], "max": [9, 9, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,"
                         + base64.b64encode(corners).decode()}]}))
        for options, pixel in (([], b"\xff\0\0"), (["--variant", "leaf"], b"\0\xff\0"),
                               (["--variant", "sea"], b"\0\0\xff"), (["--variant", "0"], b"\0\xff\0")):
            _, _, rows = self.picture("a.gltf", "--integrator", "flat", "--size", "3x3", *options)
            self.assertEqual(rows, [3 * pixel] * 3, options)
        wrong = self.run_program("a.gltf", "--variant", "sand")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn(b"0 (leaf), 1 (sea)", wrong.stderr)
        self.assertEqual(os.listdir(self.folder), ["a.gltf"])
        samples = ["a.gltf", "--size", "3x3", "--spp", "2", "-o", "a.ppm", "--checkpoint", "c", "--variant"]
        self.assertEqual(self.run_program(*samples, "leaf").returncode, 0)
        other = self.run_program(*samples, "sea")
        self.assertEqual((other.returncode, b"c: holds samples of another picture: " in other.stderr), (2, True))

    def test_gltf_is_path_traced_and_json_is_flat(self):
        cube = SOURCE / "scenes/gltf/cube.glb"
        lit = self.picture(cube, "--size", "40x30")
        self.assertEqual(self.picture(cube, "--size", "40x30", "--integrator", "path", "--spp", "64",
                                      "--background", "0.25,0.25,0.25"), lit)
        self.assertNotEqual(self.picture(cube, "--size", "40x30", "--integrator", "flat"), lit)
        self.assertEqual(self.picture(SCENE, "--integrator", "flat", "--spp", "1"), self.picture(SCENE))

    def test_quantities(self):
        cube = SOURCE / "scenes/gltf/cube.glb"
        quantities = ("depth", "distance", "position", "normal", "barycentric", "id")
        options = [cube, "--size", "40x30"]
        flat = self.picture(*options, "--integrator", "flat")
        pictures = [flat] + [self.picture(*options, "--integrator", name) for name in quantities]
        self.assertEqual(len({b"".join(rows) for _, _, rows in pictures}), len(pictures))
        normals = b"".join(self.picture(*options, "--integrator", "face_normal", "--view", "front")[2])
        self.assertEqual({normals[i:i + 3] for i in range(0, len(normals), 3)},
                         {b"\x80\x80\x80", b"\x80\x80\xff"})
        for wrong in (["--integrator", "light"], ["--integrator", "depth", "--spp", "4"],
                      ["--aov", "depth,beauty", "-o", "a.exr"], ["--aov", "depth,depth", "-o", "a.exr"],
                      ["--aov", "", "-o", "a.exr"], ["--aov", "depth", "-o", "a.png"],
                      ["--aov", "depth", "-o", "-"]):
            result = self.run_program(*options, *wrong)
            self.assertEqual(result.returncode, 2, (wrong, result.stderr))
        self.assertIn(b"error: --spp: --integrator normal shows a quantity, which can't be averaged; omit --spp\n",
                      self.run_program(*options, "--integrator", "normal", "--spp", "2").stderr)
        self.assertEqual(os.listdir(self.folder), [])

    def test_samples(self):
        one = self.picture(SCENE, "--size", "64x48")
        self.assertEqual(self.picture(SCENE, "--size", "64x48", "--samples", "1"), one)
        many = [self.picture(SCENE, "--size", "64x48", "--spp", "16", "-t", t) for t in (1, 3)]
        self.assertEqual(many[0], many[1])
        colors = lambda rows: {row[i:i + 3] for row in rows for i in range(0, len(row), 3)}
        self.assertLess(len(colors(one[2])), 10)  # only flat colors
        self.assertGreater(len(colors(many[0][2])), 30)  # blends along edges

    def test_statistics(self):
        result = self.run_program(SCENE, "-o", "a.ppm", "--stats=json", "-t", "2")
        numbers = json.loads(result.stderr)
        self.assertEqual(numbers["primitives"], 6)
        self.assertEqual(numbers["rays"], 640 * 480)
        self.assertEqual(numbers["threads"], 2)
        self.assertIn(b"rays/s", self.run_program(SCENE, "-o", "a.ppm", "--stats").stderr)

    def test_rays_are_counted_by_kind(self):
        def kinds(scene, *options):
            result = self.run_program(scene, "-o", "a.ppm", "--size", "50x40", "--spp", "3", "--integrator", "path", "-q",
                                      "--stats=json", *options)
            return json.loads(result.stderr)["rays_by_kind"]

        rays = lambda kinds: {name: kind["rays"] if name != "beyond" else kind for name, kind in kinds.items()}
        ball, textures = self.folder / "ball.json", SOURCE / "scenes/gltf/textures.glb"
        ball.write_text(json.dumps({"version": 1, "materials": {"matt": {}}, "objects": [
            {"type": "sphere", "center": [0, 0, 0], "radius": 1, "material": "matt"}]}))
        for scene in (ball, textures):
            self.assertEqual(rays(kinds(scene, "-t", "1")), rays(kinds(scene, "-t", "2")))
        found = kinds(ball)
        self.assertEqual(kinds(ball, "--env", "studio", "--background", "env")["camera"]["rays"], 50 * 40 * 3)
        self.assertLess(found["camera"]["rays"], 50 * 40 * 3)  # tiles without hits need no rays
        for name in ("camera", "path", "shadow"):
            self.assertGreater(found[name]["rays"], 0)
            self.assertGreater(found[name]["s"], 0)
        # Rays pass cut-out parts within a query, and continue behind partly transparent surfaces by further queries.
        self.assertEqual(kinds(textures)["beyond"], 0)
        self.assertGreater(kinds(SOURCE / "scenes/gltf/materials.glb")["beyond"], 0)
        stages = json.loads(self.run_program(ball, "-o", "a.ppm", "--size", "50x40", "--integrator", "path", "-q",
                                             "--stats=json").stderr)["stages"]
        self.assertGreater(stages["filters"], 0)  # counted even though a scene of one ball has no tree
        self.assertGreater(stages["origins"], 0)
        self.assertIn(b"missing_origins", self.run_program(ball, "-o", "a.ppm", "--stats").stderr)
        for scene in (ball, textures):  # rays that determine the exposure are not those of the picture
            self.assertEqual(rays(kinds(scene, "--exposure", "auto")), rays(kinds(scene, "--exposure", "0")))
        short = rays(kinds(ball, "--max-depth", "1"))
        self.assertEqual((short["path"], short["shadow"]), (0, 0))
        text = self.run_program(ball, "-o", "a.ppm", "--size", "50x40", "--spp", "1", "--integrator", "path", "-q", "--stats").stderr
        self.assertIn(b"\n  shadow ", text)

    def test_verbose_describes_the_scene(self):
        result = self.run_program(SOURCE / "scenes/gltf/textures.glb", "-o", "a.ppm", "-v", "--integrator", "flat")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stderr.decode().splitlines()
        for text in (": 5 objects: 10 triangles in meshes, 0 other shapes", "6 materials, 3 textures, 3 images, 3",
                     "camera: Front, the first of 1", "picture: 640 x 480, flat"):
            self.assertTrue(any(line.startswith("info: ") and text in line for line in lines), (text, lines))
        self.assertEqual(self.run_program(SCENE, "-v", "-q").returncode, 2)

    def test_only_images_that_the_picture_needs_are_decoded(self):
        def decoded(*options):
            result = self.run_program(SOURCE / "scenes/gltf/textured.glb", "-o", "a.exr", "-v", "--size", "16x12", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
            return int(re.search(r"images?, (\d+) of them decoded", result.stderr.decode())[1])

        self.assertGreater(decoded("--spp", "1"), 3)
        self.assertLess(decoded("--integrator", "depth"), decoded("--integrator", "albedo"))
        self.assertEqual(decoded("--integrator", "albedo"), decoded("--integrator", "depth", "--aov", "albedo"))
        self.assertLess(decoded("--integrator", "albedo"), decoded("--spp", "1"))
        self.assertEqual(decoded("--integrator", "flat", "--aov", "normal"), decoded("--integrator", "flat"))
        # AOVs of exact quantities must not depend on whether textures are decoded.
        for quantity in ("depth", "normal", "uv", "id"):
            pictures = []
            for options in ((), ("--aov", "albedo")):
                decoded("--integrator", quantity, *options)
                pictures.append(Exr(self.folder / "a.exr").channels)
            for name in ("R", "G", "B"):
                self.assertEqual(pictures[0][name], pictures[1][name], quantity)

    def test_times_of_stages(self):
        result = self.run_program(SOURCE / "scenes/gltf/knot.glb", "--integrator", "flat", "-o", "a.ppm", "--stats=json")
        numbers = json.loads(result.stderr)
        for stage in ("read_s", "validate_s", "bake_s", "build_s", "trace_s", "write_s"):
            self.assertGreater(numbers[stage], 0, stage)
        loading = numbers["read_s"] + numbers["validate_s"] + numbers["bake_s"]
        self.assertLessEqual(loading, numbers["load_s"])
        self.assertLessEqual(numbers["build_s"] + numbers["trace_s"], numbers["render_s"])

    def test_progress_as_json(self):
        result = self.run_program(SCENE, "-o", "a.ppm", "--progress", "json")
        lines = [json.loads(line) for line in result.stderr.splitlines()]
        shares = [line["progress"] for line in lines]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual(shares[-1], 1)
        self.assertGreaterEqual(lines[-1]["seconds"], 0)
        self.assertNotIn(b"%", self.run_program(SCENE, "-o", "a.ppm", "--progress=none").stderr)
        self.assertEqual(self.run_program(SCENE, "-o", "a.ppm", "--progress=dots").returncode, 2)

    def test_reports_written_files(self):
        result = self.run_program(SCENE, "-o", "a.png", "--sidecar", "b.json", "--size", "20x10")
        self.assertRegex(result.stderr.decode(),
                         r"^wrote a\.png and b\.json: 20 x 10 pixels, 1 sample each, in \d+\.\d+ s\n$")
        for quiet in (["-q", "-o", "a.png"], ["-o", "-"]):
            self.assertEqual(self.run_program(SCENE, "--size", "20x10", *quiet).stderr, b"", quiet)

    def test_mistyped_commands_suggest_the_nearest_one(self):
        (self.folder / "marge").write_bytes(b"{}")
        for words, message in ((["vieww", "a.glb"], 'unknown command "vieww"; did you mean view?'),
                               (["datset"], 'unknown command "datset"; did you mean dataset?'),
                               (["completoin", "bash"], 'unknown command "completoin"; did you mean completion?'),
                               (["mergee", "a", "b", "--weights"], 'unknown command "mergee"; did you mean merge?'),
                               (["render", "a.glb"], 'unknown command "render"; to render, name only the scene'),
                               (["marge", "a"], 'unexpected argument "a"'),
                               (["lamp", "a"], 'unexpected argument "a"')):
            result = self.run_program(*words)
            self.assertEqual((result.returncode, result.stderr.decode()),
                             (2, f"error: {message}\nRun microtrace --help for the options.\n"))

    def test_mistyped_options_suggest_the_nearest_one(self):
        for wrong, right in (("--smaples", "--samples"), ("--smaples=4", "--samples"), ("--treads", "--threads"),
                             ("--outptu", "--output")):
            result = self.run_program(SCENE, wrong, "4")
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"error: unknown option {wrong.split('=')[0]}; did you mean {right}?\n", result.stderr.decode())
        result = self.run_program("dataset", SCENE, "a.png")
        self.assertIn('error: unexpected argument "a.png"\n', result.stderr.decode(), "its --output is a folder")
        # Tests the message without SCENE too, because CLI11 would report the missing SCENE first.
        self.assertIn(b"did you mean --samples?", self.run_program("--smaples=4").stderr)
        for arguments, message in ((["--nothing-like-it"], "error: unknown option --nothing-like-it\n"),
                                   (["-size", "8x6"], "error: unknown option -size; did you mean --size?\n"),
                                   (["-y"], "error: unknown option -y\n"),
                                   (["--nope", "--", "x.glb"], "error: unknown option --nope\n"),
                                   (["--", "--size", "8x6"], 'error: unexpected argument "--size"\n'),
                                   (["b.json"], 'error: unexpected argument "b.json"\n'),
                                   (["b.json", "--stats=json"], 'error: unexpected argument "b.json"\n'),
                                   (["--stats", "json"], 'error: unexpected argument "json"; the value of --stats follows =, as in --stats=json\n'),
                                   (["--ground", "-1"], 'error: unexpected argument "-1"; the value of --ground follows =, as in --ground=-1\n'),
                                   (["--ground", "1"], 'error: unexpected argument "1"; the value of --ground follows =, as in --ground=1\n'),
                                   # Words that an option before them doesn't take.
                                   (["--ground", "out.png"], 'error: unexpected argument "out.png"; did you mean --output out.png?\n'),
                                   (["a b.PNG"], "error: unexpected argument \"a b.PNG\"; did you mean --output 'a b.PNG'?\n"),
                                   (["it's.webp"], "error: unexpected argument \"it's.webp\"; did you mean --output 'it'\\''s.webp'?\n"),
                                   # Words that are no names of pictures.
                                   (["--background", "0.5", "0.5", "0.5"], 'error: unexpected argument "0.5"\n'),
                                   (["studio.hdr"], 'error: unexpected argument "studio.hdr"\n'),
                                   (["model.obj"], 'error: unexpected argument "model.obj"\n'),
                                   (["a.GLB"], 'error: unexpected argument "a.GLB"\n'),
                                   (["--ground", "--stats", "json"], 'error: unexpected argument "json"; the value of --stats follows =, as in --stats=json\n'),
                                   (["-o", "a.png", "b.png"], 'error: unexpected argument "b.png"\n'),
                                   (["--spp"], "error: --spp expects a value\n"),
                                   (["--checkpoint", "c", "--resume", "--seed", "9"],
                                    "error: --resume expects a value, but is followed by --seed\n"),
                                   (["-o", "--size=8x6"], "error: -o expects a value, but is followed by --size=8x6\n"),
                                   (["--output=--size"], "error: --size: has no extension"),
                                   (["-o", ""], "error: --output: expects a value, is empty\n"),
                                   (["--camera="], "error: --camera: expects a value, is empty\n"),
                                   (["-o=x.png"], "error: -o: omit the = between a short name and its value\n"),
                                   (["--evil\x1b[31m"], "error: unknown option --evil\\x1b[31m\n")):
            result = self.run_program(SCENE, *arguments)
            self.assertEqual((result.returncode, result.stdout), (2, b""))
            self.assertTrue(result.stderr.decode().startswith(message), result.stderr)
            self.assertEqual(os.listdir(self.folder), [])

    def test_other_formats_get_advice(self):
        obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        for name, content in (("a.obj", obj), ("a.OBJ", obj), ("a.stl", b"solid a\nendsolid a\n"), ("a.ply", b"ply\n"),
                              ("a.usd", b"PXR-USDC"), ("a.fbx", b"Kaydara FBX Binary  \0"), ("a.obj", b"")):
            self.write(name, content)
            result = self.run_program(name)
            self.assertEqual(result.returncode, 4, name)
            message = result.stderr.decode()
            self.assertIn(f"error: {name}: microtrace reads JSON scenes and glTF (.gltf, .glb), not .{name[2:].lower()}; convert", message)
        # If the file has the extension of another format, the format is detected from the content.
        self.write("scene.obj", minimal())
        self.assertEqual(self.run_program("scene.obj", "-q", "-o", "a.ppm").returncode, 0)

    def test_validate_prints_the_result_and_renders_nothing(self):
        result = self.run_program(SCENE, "--validate")
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stdout.decode(), f"{SCENE}: valid\n")
        self.assertEqual(os.listdir(self.folder), [])
        asset = {"asset": {"version": "2.1"}, "scenes": []}
        for change, code, expected in (({"scenes": [{}]}, 0, "valid, 2 warnings"),
                                      ({}, 3, "invalid, but drawable: 1 error, 2 warnings"),
                                      ({"scene": 0}, 3, "invalid"),
                                      ({"asset": {"version": "3.0"}}, 4, "unsupported"),
                                      ({"scene": "x" * 10}, 3, "invalid")):
            self.write("asset.gltf", json.dumps({**asset, **change}))
            result = self.run_program("asset.gltf", "--validate")
            self.assertEqual(result.returncode, code)
            self.assertEqual(result.stdout.decode(), f"asset.gltf: {expected}\n")
        self.write("asset.gltf", json.dumps(asset))
        result = self.run_program("asset.gltf", "--validate", "--strict")
        self.assertEqual((result.returncode, result.stdout), (3, b"asset.gltf: invalid\n"))
        self.assertEqual(os.listdir(self.folder), ["asset.gltf"])

    # Points and lines of glTF assets

    def write_line(self, material):
        """Writes line.gltf: a segment from (0, 0, 0) to (1, 2, 3), without normals."""
        positions = base64.b64encode(struct.pack("<6f", 0, 0, 0, 1, 2, 3)).decode()
        self.write("line.gltf", json.dumps({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "buffers": [{"byteLength": 24, "uri": "data:application/octet-stream;base64," + positions}],
            "bufferViews": [{"buffer": 0, "byteLength": 24}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "VEC3", "min": [0, 0, 0],
                           "max": [1, 2, 3]}],
            "materials": [material],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 1, "material": 0}]}]}))

    def test_the_box_of_a_line_excludes_its_rendered_width(self):
        self.write_line({})
        result = self.run_program("line.gltf", "--size", "8x6", "--integrator", "flat", "-o", "a.ppm", "--sidecar", "a.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        line = json.loads((self.folder / "a.json").read_text())["objects"][0]
        self.assertEqual(line["world_box"], {"min": [0, 0, 0], "max": [1, 2, 3]})
        self.assertGreater(line["visible_pixels"], 0)

    def test_a_line_without_normals_shows_the_sum_of_base_color_and_emission(self):
        pictures = []
        for base, emissive in (([0.25, 0, 0.125, 1], [0, 0.5, 0.125]), ([0.25, 0.5, 0.25, 1], [0, 0, 0])):
            self.write_line({"pbrMetallicRoughness": {"baseColorFactor": base}, "emissiveFactor": emissive})
            for light in ("studio", "#808080"):
                result = self.run_program("line.gltf", "--size", "16x12", "--integrator", "path", "--spp", "4", "--env",
                                          light, "--background", "#000000", "-o", "-")
                self.assertEqual(result.returncode, 0, result.stderr)
                pictures.append(result.stdout)
        self.assertEqual(pictures[0], pictures[2])
        self.assertEqual(pictures[1], pictures[3])
        self.assertGreater(max(pictures[1][-16 * 12 * 3:]), 0)

    # Usage

    def test_help_and_version(self):
        for option in ("-h", "--help", "--version"):
            result = self.run_program(option)
            self.assertEqual(result.returncode, 0)
            self.assertIn(b"microtrace", result.stdout)
            self.assertEqual(result.stderr, b"")
        self.assertIn(b"Exit codes", self.run_program("--help").stdout)

    def test_missing_modules(self):
        """Tests that, without the decoder's module, an asset that requires the extension is refused, and that the message
        names the package to install or the target to build."""
        data = {"byteLength": 36, "uri": "data:application/octet-stream;base64," + "A" * 48}
        asset = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}],
                 "bufferViews": [{"buffer": 0, "byteLength": 36}],
                 "accessors": [{"componentType": 5126, "type": "VEC3", "count": 3, "bufferView": 0,
                                "min": [0, 0, 0], "max": [0, 0, 0]},
                               {"componentType": 5121, "type": "SCALAR", "count": 3}],
                 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]}
        draco = {"bufferView": 0, "attributes": {"POSITION": 0}}
        meshopt = {"buffer": 1, "byteLength": 36, "byteStride": 12, "count": 3,
                   "mode": "ATTRIBUTES"}
        for name, remedy, holder, value in [
                ("KHR_draco_mesh_compression", "install libdraco-dev",
                 asset["meshes"][0]["primitives"][0], draco),
                ("EXT_meshopt_compression", "build the target microtrace_meshopt",
                 asset["bufferViews"][0], meshopt),
                ("KHR_meshopt_compression", "build the target microtrace_meshopt",
                 asset["bufferViews"][0], meshopt)]:
            holder["extensions"] = {name: value}
            asset["buffers"] = [{**data, "extensions": {name: {"fallback": True}}} if value is meshopt else data, data]
            asset["extensionsUsed"] = [name]
            for required, code in [([name], 4), ([], 0)]:
                asset["extensionsRequired"] = required
                (self.folder / "a.gltf").write_text(json.dumps(asset))
                result = self.run_program("a.gltf", "--size", "8x8", "-o", "-",
                                          env=environment(MICROTRACE_MODULE_PATH="/nowhere"))
                self.assertEqual(result.returncode, code, result.stderr)
                self.assertIn(remedy.encode(), result.stderr)
                self.assertIn(name.encode(), result.stderr)
                self.assertNotIn(b"nothing is drawn", result.stderr)
            del holder["extensions"]

    def test_usage_errors(self):
        for arguments in ([], ["--no-such-option", SCENE], [SCENE, "--size", "640"],
                          [SCENE, "--size", "0x4"], [SCENE, "--size", "1000000000x1000000000"],
                          [SCENE, "--size", "-3x4"], [SCENE, "--threads", "0"],
                          [SCENE, "--threads", "many"], [SCENE, "--ppm", "p7"], [SCENE, "--size", ""],
                          [SCENE, "--spp", "0"], [SCENE, "--spp", "65537"],
                          [SCENE, "--filter", "gauss"], [SCENE, "--seed", "-1"], [SCENE, "--seed", "4294967296"], [SCENE, "--crop", "1,2,3"],
                          [SCENE, "--crop", "1,2,3,4,5"], [SCENE, "--crop", "0,0,-1,4"],
                          [SCENE, "--stats=xml"], [SCENE, "-o", "picture.xyz"], [SCENE, SCENE], ["-"]):
            result = self.run_program(*arguments, stdin=subprocess.DEVNULL)
            self.assertEqual(result.returncode, 2, (arguments, result.stderr))
            self.assertNotEqual(result.stderr, b"", arguments)
            self.assertEqual(os.listdir(self.folder), [], arguments)

    def test_a_switch_takes_no_value(self):
        for word in ("--quiet=0", "--quiet=1", "--quiet=true", "-q=0", "--quiet=", "--progressive=false", "--help=0", "--version=1"):
            result = self.run_program(SCENE, word, "-o", "a.ppm")
            self.assertEqual((result.returncode, result.stdout), (2, b""), word)
            self.assertIn(f"error: {word.split('=')[0]}: takes no value\n".encode(), result.stderr)
        for word in ("--stats=", "--ground="):
            result = self.run_program(SCENE, word, "--integrator", "path", "-o", "a.ppm")
            self.assertEqual(result.returncode, 2, word)
            self.assertIn(b"expects a value, is empty", result.stderr)
        self.assertEqual(os.listdir(self.folder), [])
        # Words after these are names of files or values.
        self.assertIn(b"--quiet=0: can't be opened", self.run_program("-o", "a.ppm", "--", "--quiet=0").stderr)
        self.assertNotIn(b"FOLDER FOLDER", self.run_program("verify", "--help").stdout)

    # Broken scenes

    def test_not_json(self):
        self.assert_refused("", 3, "empty")
        self.assert_refused("   \n", 3, "empty")
        self.assert_refused("sphere 1 2 3", 3, "scene.json:1:1")
        self.assert_refused('{"version": 1,}', 3, "scene.json:1:14", "^")
        self.assert_refused('{"version": NaN}', 3, "scene.json:1:13")
        self.assert_refused(b'{"version": 1, "a": "\xff"}', 3, "UTF-8")
        self.assert_refused('{"version": 1', 3, "scene.json:1:")

    def test_invalid_values_name_their_json_pointer(self):
        sphere = {"type": "sphere", "center": [0, 0, 0], "radius": 1}
        camera = {"type": "perspective", "position": [0, 0, 10], "direction": [0, 0, -1],
                  "vertical_fov": 60}
        for changes, pointer in (
            ({"objects": [dict(sphere, radius=-1)]}, "/objects/0/radius: "),
            ({"objects": [sphere, {"type": "sphere", "center": [0, 0, 0]}]}, "/objects/1"),
            ({"objects": [dict(sphere, radius="1")]}, "/objects/0/radius: "),
            ({"objects": [dict(sphere, center=[0, 0])]}, "/objects/0/center: "),
            ({"objects": [{"type": "plane", "point": [0, 0, 0], "normal": [0, 0, 0]}]},
             "/objects/0/normal: "),
            ({"cameras": [dict(camera, direction=[0, 0, 0])]}, "/cameras/0/direction: "),
            ({"cameras": [dict(camera, up=[0, 0, 5])]}, "/cameras/0/up: "),
            ({"cameras": [dict(camera, vertical_fov=180)]}, "/cameras/0/vertical_fov: "),
            ({"image": {"width": 0, "height": 0}}, "/image/width: "),
            ({"version": 99}, "/version: "),
        ):
            message = self.assert_refused(minimal(**changes), 3, pointer, "^")
            self.assertRegex(message, r"^error: scene\.json:1:\d+: /")

    def test_number_beyond_range(self):
        text = minimal().replace('"radius": 1', '"radius": 1e999')
        self.assert_refused(text, 3, "scene.json:1:")
        text = minimal().replace('"radius": 1', '"radius": 1e39')
        self.assert_refused(text, 3, "/objects/0/radius: ")

    def test_unknown_key_suggests_the_nearest(self):
        text = minimal().replace('"radius"', '"raduis"')
        self.assert_refused(text, 3, "/objects/0", "raduis", '"radius"')

    def test_huge_picture(self):
        text = minimal(image={"width": 10**9, "height": 10**9})
        self.write("scene.json", text)
        code, message, peak_kib = self.run_and_measure("scene.json")
        self.assertIn(code, (3, 6))
        self.assertIn("/image/width: ", message)
        self.assertLess(peak_kib, 400 * 1024)

    def test_mesh_file_missing(self):
        text = minimal(objects=[{"type": "mesh", "file": "not/there.glb"}])
        self.assert_refused(text, 5, "/objects/0/file: ", "not/there.glb")

    def test_100_mb_of_garbage(self):
        with open(self.folder / "scene.json", "wb") as file:
            file.write(os.urandom(1 << 20) * 100)
        code, message, peak_kib = self.run_and_measure("scene.json", "-o", "out.ppm")
        self.assertEqual(code, 3, message)
        self.assertLess(peak_kib, 400 * 1024)
        self.assertEqual(os.listdir(self.folder), ["scene.json"])

    def test_nesting(self):
        self.assert_refused("[" * 10000 + "]" * 10000, 6, "scene.json:1:")
        self.assert_refused('{"a":' * 10000, 6, "scene.json:1:")

    # Files

    def test_scene_that_cannot_be_read(self):
        for scene in ("missing.json", ".", "/proc/self/mem/x"):
            result = self.run_program(scene, "-o", "out.ppm")
            self.assertEqual(result.returncode, 5, result.stderr)
            self.assertIn(scene.encode(), result.stderr)
            self.assertEqual(os.listdir(self.folder), [])

    def test_output_that_cannot_be_written(self):
        for output in ("/dev/full", "missing/folder/out.ppm", "/proc/out.ppm", "."):
            result = self.run_program(SCENE, "-o", output)
            self.assertIn(result.returncode, (2, 5), (output, result.stderr))
            self.assertNotEqual(result.stderr, b"")
            self.assertEqual(os.listdir(self.folder), [])
        self.assertEqual(self.run_program(SCENE, "-o", "/dev/full").returncode, 5)
        with open("/dev/full", "wb") as full:
            result = subprocess.run([PROGRAM, SCENE, "-o", "-"], stdout=full, stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, 5)

    def test_short_write_leaves_the_old_picture(self):
        self.write("out.ppm", "precious")
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))
        result = self.run_program(SCENE, "-o", "out.ppm", preexec_fn=limit)
        self.assertEqual(result.returncode, 5, result.stderr)
        self.assertEqual(os.listdir(self.folder), ["out.ppm"])
        self.assertEqual((self.folder / "out.ppm").read_text(), "precious")

    def test_closed_pipe(self):
        reader, writer = os.pipe()
        os.close(reader)
        result = subprocess.run([PROGRAM, SCENE, "-o", "-"], stdout=writer, stderr=subprocess.PIPE)
        os.close(writer)
        self.assertEqual(result.returncode, 5)

    def test_interrupt_leaves_nothing(self):
        # Without the interruption, this rendering would take much longer than any test.
        process = subprocess.Popen([PROGRAM, SCENE, "--size", "8000x8000", "--spp", "256", "-t", "1", "--progress", "json"],
                                   cwd=self.folder, stderr=subprocess.PIPE)
        self.assertIn(b"progress", process.stderr.readline())
        process.send_signal(signal.SIGINT)
        _, message = process.communicate()
        self.assertEqual(process.returncode, 130, message)
        self.assertEqual(os.listdir(self.folder), [])

    # Start-up

    def test_json_to_ppm_loads_no_picture_library_and_png_only_libpng(self):
        for picture, others in (("/dev/null", (b"libpng", b"libjpeg")), ("a.png", ())):
            result = self.run_program(SCENE, "-o", picture, env=environment(LD_DEBUG="files"))
            self.assertEqual(result.returncode, 0)
            self.assertIn(b"libstdc++", result.stderr)  # the list of loaded files works
            for library in (b"OpenImageIO", b"OpenEXR", b"Imath", b"tinygltf", b"libstb", *others):
                self.assertNotIn(library, result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
