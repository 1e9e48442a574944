#!/usr/bin/env python3
"""Tests animated assets on the command line.

usage: animation_test.py PROGRAM [unittest arguments]
"""

import base64
import json
import os
import signal
import struct
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True
from program import PROGRAM, ProgramTest


def moving_square(start=0, way=4):
    """Returns a glTF file with a square of side 1. Its first animation moves the square along x from `start` in two
    seconds. The second one, "up", moves it along y."""
    parts = [
        struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0),
        struct.pack("<6H", 0, 1, 2, 2, 1, 3),
        struct.pack("<2f", 0, 2),
        struct.pack("<6f", start, 0, 0, start + way, 0, 0),
        struct.pack("<6f", 0, 0, 0, 0, 4, 0),
    ]
    views, data = [], b""
    for part in parts:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
        data += part
    floats = lambda view, count, kind, **more: dict(bufferView=view, componentType=5126, count=count, type=kind, **more)
    move = lambda output: {
        "samplers": [{"input": 2, "output": output}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
    }
    return json.dumps({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [2, 2, 10]}],
        "cameras": [{"type": "orthographic",
                     "orthographic": {"xmag": 4, "ymag": 3, "znear": 1, "zfar": 100}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "animations": [move(3), dict(move(4), name="up")],
        "accessors": [
            floats(0, 4, "VEC3", min=[0, 0, 0], max=[1, 1, 0]),
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            floats(2, 2, "SCALAR", min=[0], max=[2]),
            floats(3, 2, "VEC3"),
            floats(4, 2, "VEC3"),
        ],
        "bufferViews": views,
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    })


def lower_left(picture):
    """Returns column and row of the square's lower left pixel, counted from the picture's lower left corner."""
    magic, size, _, pixels = picture.split(b"\n", 3)
    assert magic == b"P6"
    width, height = map(int, size.split())
    lit = [(i % width, height - 1 - i // width) for i in range(width * height)
           if pixels[3 * i:3 * i + 3] != b"\0\0\0"]
    return min(lit) if lit else None


FLAT = ("--integrator", "flat")


class Animation(ProgramTest):
    def setUp(self):
        super().setUp()
        (self.folder / "move.gltf").write_text(moving_square())

    def square_at(self, *arguments):
        # A unit is ten pixels long, and the picture's lower left corner is at (-2, -1).
        result = self.run_program("move.gltf", *FLAT, "--size", "80x60", "-o", "-", *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, b""))
        column, row = lower_left(result.stdout)
        return (column - 20) / 10, (row - 10) / 10

    def test_time_poses_the_first_animation(self):
        self.assertEqual(self.square_at(), (0, 0))
        self.assertEqual(self.square_at("--time", "0.5"), (1, 0))
        self.assertEqual(self.square_at("--time", "1e2"), (4, 0))
        self.assertEqual(self.square_at("--time=-3"), (0, 0))

    def test_animation_by_name_index_or_all(self):
        self.assertEqual(self.square_at("--time", "1", "--animation", "up"), (0, 2))
        self.assertEqual(self.square_at("--time", "1", "--animation", "1"), (0, 2))
        self.assertEqual(self.square_at("--time", "1", "--animation", "0"), (2, 0))
        # If two channels have the same target, the later one is used.
        self.assertEqual(self.square_at("--time", "1", "--animation", "all"), (0, 2))

    def test_invalid_animation_options_are_usage_errors(self):
        for arguments, fragment in (
            (["--time", "soon"], "--time"), (["--time", "nan"], "--time"), (["--time", "inf"], "--time"),
            (["--time", ""], "--time"), (["--time", "1s"], "--time"),
            (["--animation", "up"], "--time"),
            (["--time", "1", "--animation", "down"], "0 (unnamed), 1 (up)"),
        ):
            result = self.run_program("move.gltf", "-o", "out.ppm", *arguments)
            self.assertEqual(result.returncode, 2, (arguments, result.stderr))
            self.assertIn(fragment, result.stderr.decode(), arguments)
            self.assertEqual(os.listdir(self.folder), ["move.gltf"], arguments)

    def frames(self, *arguments):
        return self.run_program("move.gltf", *FLAT, "--size", "80x60", *arguments)

    def test_frames_equal_stills_at_their_times(self):
        result = self.frames("--frames", "2:5", "--fps", "4", "-o", "out_%03d.ppm")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([line.split(b":")[0] for line in result.stderr.splitlines()],
                         [f"wrote out_{k:03}.ppm".encode() for k in range(2, 6)])
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["move.gltf", *(f"out_{k:03}.ppm" for k in range(2, 6))])
        for k in range(2, 6):
            single = self.frames("--time", k / 4, "-o", "-").stdout
            self.assertEqual((self.folder / f"out_{k:03}.ppm").read_bytes(), single, k)

    def test_frames_whose_tree_is_kept_equal_stills(self):
        asset = json.loads((self.folder / "move.gltf").read_text())
        places = [[0.3 * (i % 5), 0.4 * (i // 5), 0.01 * i] for i in range(20)]
        asset["nodes"][0]["children"] = list(range(2, 22))
        asset["nodes"] += [{"mesh": 0, "translation": place, "scale": [0.2, 0.2, 1]} for place in 2 * places]
        asset["scenes"][0]["nodes"] += range(22, 42)
        (self.folder / "many.gltf").write_text(json.dumps(asset))
        for options in (["--integrator", "flat"], ["--integrator", "path", "--spp", "2"]):
            run = lambda *more: self.run_program("many.gltf", *options, "--size", "80x60", *more).stdout
            frames = run("--frames", "0:5", "--fps", "4", "-o", "-")
            stills = [run("--time", k / 4, "-o", "-") for k in range(6)]
            self.assertEqual(len(set(stills)), 6, "it moves")
            self.assertEqual(frames, b"".join(stills), options)

    def test_default_frame_names(self):
        self.assertEqual(self.frames("--frames", "24:24").returncode, 0)
        self.assertEqual(sorted(os.listdir(self.folder)), ["move.gltf", "move_0024.png"])
        self.frames("--time", "1", "-o", "single.png")
        self.assertEqual((self.folder / "move_0024.png").read_bytes(), (self.folder / "single.png").read_bytes())

    def test_frames_of_a_scene_with_a_percent_sign_have_its_name(self):
        (self.folder / "move.gltf").rename(self.folder / "100%.gltf")
        result = self.run_program("100%.gltf", "--frames", "3:3", "--size", "8x8", "--spp", "1")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.folder / "100%_0003.png").exists())

    def test_frames_to_standard_output_follow_each_other(self):
        result = self.frames("--frames", "0:2", "--fps", "1", "--animation", "up", "-o", "-")
        singles = [self.frames("--time", k, "--animation", "up", "-o", "-").stdout for k in range(3)]
        self.assertEqual(result.stdout, b"".join(singles))

    def test_frames_are_validated(self):
        asset = json.loads((self.folder / "move.gltf").read_text())
        asset["extensionsUsed"] = ["VENDOR_unknown"]
        (self.folder / "warned.gltf").write_text(json.dumps(asset))
        asset["scenes"][0]["nodes"] *= 2
        (self.folder / "odd.gltf").write_text(json.dumps(asset))
        asset["animations"][0]["channels"][0]["sampler"] = 99
        (self.folder / "wrong.gltf").write_text(json.dumps(asset))
        for name, code, verdict in (("move.gltf", 0, "valid"), ("warned.gltf", 0, "valid, 1 warning"),
                                    ("odd.gltf", 3, "invalid, but drawable: 1 error, 1 warning"),
                                    ("wrong.gltf", 3, "invalid")):
            result = self.run_program(name, "--frames", "0:3", "--validate")
            self.assertEqual((result.returncode, result.stdout.decode()), (code, f"{name}: {verdict}\n"))
        self.assertEqual(len(os.listdir(self.folder)), 4)

    def test_invalid_frame_options_are_usage_errors(self):
        for arguments, fragment in (
            (["--frames", "0:1", "-o", "out.ppm"], "out_%04d.png"),
            (["--frames", "0:1", "-o", "%d_%d.ppm"], "%d_%d.ppm"),
            (["--frames", "0:1", "-o", "%s%d.ppm"], "%s%d.ppm"),
            (["--frames", "0:1", "-o", "%0d.ppm"], "%0d.ppm"),
            (["--frames", "0:1", "-o", "%4d.ppm"], "%4d.ppm"),
            (["--frames", "0:1", "-o", "a%d.ppm%"], "a%d.ppm%"),
            (["--frames", "0:1", "-o", "a%%d.ppm"], "a%%d.ppm"),
            (["--frames", "0:1", "-o", "%d.ppm", "--sidecar", "a.json"], "--sidecar"),
            (["--frames", "1:0"], "--frames"), (["--frames", "3"], "--frames"),
            (["--frames", "-1:3"], "--frames"), (["--frames", "0:1000000"], "--frames"),
            (["--frames", ""], "--frames"), (["--frames", "0:1", "--time", "1"], "--time"),
            (["--frames", "0:1", "--fps", "0"], "--fps"), (["--frames", "0:1", "--fps", "nan"], "--fps"),
            (["--fps", "24"], "--frames"),
        ):
            result = self.frames(*arguments)
            self.assertEqual(result.returncode, 2, (arguments, result.stderr))
            self.assertIn(fragment, result.stderr.decode(), arguments)
            self.assertEqual(os.listdir(self.folder), ["move.gltf"], arguments)

    def blurred(self, *arguments, code=0):
        """Returns the picture with motion blur, or the error."""
        output = [] if {"-o", "--shard"} & set(arguments) else ["-o", "-"]
        result = self.run_program("move.gltf", "--integrator", "path", "--env", "1,1,1", "--size", "40x30", "--spp", "5",
                                  "-q", *arguments, *output)
        self.assertEqual(result.returncode, code, (arguments, result.stderr))
        return result.stdout if code == 0 else result.stderr.decode()

    def test_shutter_without_motion_is_the_still_picture(self):
        still = self.blurred("--time", "0.5")
        self.assertEqual(self.blurred("--time", "0.25", "--shutter", "0.25:0.25"), still)
        self.assertEqual(self.blurred("--shutter", "0.5:0.5"), still)
        # The animation ends after two seconds.
        self.assertEqual(self.blurred("--shutter", "2:3", "--shutter-times", "4"), self.blurred("--time", "2"))
        self.assertNotEqual(self.blurred("--time", "0.25", "--shutter", "0.24:0.26"), self.blurred("--time", "0.25"))

    def test_shutter_is_relative_to_the_time_of_the_picture(self):
        blurred = self.blurred("--shutter", "0.5:1")
        for options in (["--time", "0.75", "--shutter", "-0.25:0.25"],
                        ["--frames", "3:3", "--fps", "4", "--shutter", "-0.25:0.25"],
                        ["--shutter", "0.5:1", "--shutter-times", "64", "-t", "3"]):
            self.assertEqual(self.blurred(*options), blurred, options)
        self.assertNotEqual(self.blurred("--shutter", "0.5:1", "--shutter-times", "2"), blurred)
        self.blurred("--shutter", "0:1", "--sidecar", "a.json", "--time", "0.5", "-o", "a.ppm")
        sidecar = json.loads((self.folder / "a.json").read_text())
        self.assertEqual(sidecar["shutter"], {"open": 0.5, "close": 1.5, "times": 64})

    def test_a_still_view_and_a_moving_camera(self):
        asset = json.loads((self.folder / "move.gltf").read_text())
        # The camera moves with the square, so that nothing moves in the picture.
        asset["animations"][0]["channels"].append({"sampler": 1, "target": {"node": 1, "path": "translation"}})
        asset["animations"][0]["samplers"].append(dict(asset["animations"][0]["samplers"][0]))
        asset["nodes"] = [{"mesh": 0}, {"children": [2]}, {"camera": 0, "translation": [2, 2, 10]}]
        (self.folder / "move.gltf").write_text(json.dumps(asset))
        still = self.blurred("--time", "0")
        self.assertEqual(self.blurred("--shutter", "0:1", "--shutter-times", "8"), still)
        view = ["--view", "front"]
        self.assertNotEqual(self.blurred("--shutter", "0:1", "--shutter-times", "8", *view), self.blurred("--time", "0", *view))

    def test_parts_of_a_blurred_picture(self):
        shutter = ["--shutter", "0:1", "--shutter-times", "8"]
        whole = self.blurred(*shutter)
        for shard in (1, 2):
            self.blurred(*shutter, "--shard", f"{shard}/2", "--checkpoint", f"{shard}.c")
        merged = self.run_program("merge", "1.c", "2.c", "-q", "-o", "-")
        self.assertEqual((merged.returncode, merged.stdout), (0, whole), merged.stderr)
        few = self.run_program("move.gltf", "--integrator", "path", "--env", "1,1,1", "--size", "40x30", "--spp", "3", "-q",
                               *shutter, "--checkpoint", "c", "-o", "a.ppm")
        self.assertEqual(few.returncode, 0, few.stderr)
        self.assertEqual(self.blurred(*shutter, "--resume", "c"), whole)
        error = self.blurred("--shutter", "0:1.5", "--shutter-times", "8", "--resume", "1.c", code=2)
        self.assertIn("1.c: holds samples of another picture: ", error)

    def test_shutter_errors(self):
        for arguments, message in (
            (["--shutter", "1:0"], "--shutter: expects OPEN:CLOSE"), (["--shutter", "1"], "--shutter: expects OPEN:CLOSE"),
            (["--shutter", "0:nan"], "--shutter: expects a number"), (["--shutter", "0:"], "--shutter: expects a number"),
            (["--shutter-times", "4"], "--shutter-times requires --shutter"),
            (["--shutter", "0:1", "--shutter-times", "5"], "--shutter-times: expects a power of two, not 5"),
            (["--shutter", "0:1", "--shutter-times", "0"], "--shutter-times: must be a whole number"),
            (["--shutter", "0:1", "--aov", "denoise_albedo", "-o", "a.exr"], "--aov: denoise_albedo can't be combined"),
            (["--shutter", "0:1", "--denoise"], "--denoise can't be combined with --shutter"),
        ):
            self.assertIn(message, self.blurred(*arguments, code=2), arguments)
        flat = self.run_program("move.gltf", *FLAT, "--shutter", "0:1", "-o", "a.ppm")
        self.assertEqual((flat.returncode, flat.stderr.split(b"\n")[0]),
                         (2, b"error: --shutter: motion blur needs path tracing; use --integrator path"))

    def test_percent_signs_in_file_names(self):
        self.assertEqual(self.frames("--frames", "7:7", "-o", "100%%_%d.ppm").returncode, 0)
        self.assertIn("100%_7.ppm", os.listdir(self.folder))

    def test_warnings_are_printed_once(self):
        asset = json.loads((self.folder / "move.gltf").read_text())
        asset["extensionsUsed"] = ["VENDOR_unknown"]
        (self.folder / "move.gltf").write_text(json.dumps(asset))
        result = self.frames("--frames", "0:3")
        self.assertEqual(result.stderr.count(b"VENDOR_unknown"), 2)  # once in the message, once in the quoted line

    def test_one_camera_frames_all_poses(self):
        asset = json.loads((self.folder / "move.gltf").read_text())
        asset["scenes"][0]["nodes"] = [0]
        (self.folder / "move.gltf").write_text(json.dumps(asset))
        self.assertEqual(self.frames("--frames", "0:2", "--fps", "1", "--view", "front", "-o", "move_%04d.ppm").returncode, 0)
        # The camera frames all poses. The square moves from the left edge of the picture to the
        # right edge, across a width of five squares.
        left = [lower_left((self.folder / f"move_000{k}.ppm").read_bytes())[0] for k in range(3)]
        self.assertTrue(3 <= left[0] <= 5, left)  # 5 % of 80 pixels
        self.assertAlmostEqual(left[1] - left[0], 29, delta=1)
        self.assertAlmostEqual(left[2] - left[1], 29, delta=1)

    def test_static_camera_far_from_the_origin(self):
        asset = json.loads(moving_square(start=1e6, way=64))
        asset["scenes"][0]["nodes"] = [0]
        (self.folder / "move.gltf").write_text(json.dumps(asset))
        for camera in (["--view", "front"], ["--view", "0,0,60", "--fov", "50", "--target", "1000032.5,0.5,0"],
                       ["--eye", "1000032.5,0.5,60", "--fov", "50", "--target", "1000032.5,0.5,0"]):
            self.assertEqual(self.frames("--frames", "0:2", "--fps", "1", "-o", "move_%04d.ppm", *camera).returncode, 0)
            left = [lower_left((self.folder / f"move_000{k}.ppm").read_bytes())[0] for k in range(3)]
            self.assertLess(left[0], 12, camera)
            self.assertAlmostEqual(left[1], 39, delta=2)
            self.assertAlmostEqual(left[2] - left[1], left[1] - left[0], delta=1)
            self.assertGreater(left[2], 65)

    def test_progress_covers_all_frames(self):
        result = self.frames("--frames", "0:9", "--progress", "json")
        shares = [json.loads(line)["progress"] for line in result.stderr.splitlines()]
        self.assertEqual(shares, sorted(shares))
        self.assertEqual(shares[-1], 1)

    def test_interrupt_leaves_only_complete_frames(self):
        process = subprocess.Popen([PROGRAM, "move.gltf", *FLAT, "--size", "800x600", "--frames", "0:9999",
                                    "-o", "move_%04d.ppm"],
                                   cwd=self.folder, stderr=subprocess.PIPE)
        while not (self.folder / "move_0003.ppm").exists() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, message = process.communicate()
        self.assertEqual(process.returncode, 130, message)
        for name in set(os.listdir(self.folder)) - {"move.gltf"}:
            self.assertRegex(name, r"^move_\d{4}\.ppm$")
            self.assertEqual((self.folder / name).stat().st_size, 15 + 800 * 600 * 3)

    def test_meshes_of_json_scenes_are_posed(self):
        camera = {"type": "orthographic", "position": [2, 2, 10], "direction": [0, 0, -1], "height": 6}
        (self.folder / "scene.json").write_text(json.dumps({
            "version": 1, "cameras": [camera], "objects": [{"type": "mesh", "file": "move.gltf"}]}))
        pictures = [self.run_program(scene, *FLAT, "--size", "80x60", "-o", "-", "--time", "1.5").stdout
                    for scene in ("scene.json", "move.gltf")]
        self.assertEqual(pictures[0], pictures[1])
        self.assertEqual(lower_left(pictures[0]), (50, 10))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
