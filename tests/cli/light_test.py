#!/usr/bin/env python3
"""Tests the options for light and display: accepted values, exit codes for refused values, and warnings about dark
pictures.

usage: light_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import base64
import json
import os
import re
import struct
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from program import ProgramTest

SOURCE = Path(sys.argv[2]).resolve()
CUBE = SOURCE / "scenes/gltf/cube.glb"


def wall(rotation):
    """Returns an asset with a one-sided white square, which faces +z before the rotation by a quaternion."""
    corners = struct.pack("<12f", -1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0)
    uri = "data:application/octet-stream;base64," + base64.b64encode(corners).decode()
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "rotation": rotation}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": len(corners)}],
        "buffers": [{"byteLength": len(corners), "uri": uri}]})


class Environments(ProgramTest):
    def draw(self, *options):
        return self.run_program(CUBE, "--size", "40x30", "-o", "out.ppm", *options)

    def assert_refused(self, code, fragment, *options):
        result = self.draw(*options)
        self.assertEqual(result.returncode, code, (options, result.stderr))
        self.assertIn(fragment.encode(), result.stderr)
        self.assertFalse((self.folder / "out.ppm").exists())

    def test_flat_pictures_do_not_depend_on_them(self):
        (self.folder / "map.ppm").write_bytes(b"P6\n2 1\n255\n\x80\x01\xff\x02\x00\x7f")
        pictures = set()
        for options in ((), ("--env", "studio"), ("--env", "#ffe0c0"), ("--env", "0,2.5,1e3"),
                        ("--env", "map.ppm", "--env-rotation", "-90", "--env-intensity", "0.5")):
            result = self.draw("--integrator", "flat", *options)
            self.assertEqual(result.returncode, 0, options)
            self.assertNotIn(b"warning", result.stderr)
            pictures.add((self.folder / "out.ppm").read_bytes())
        self.assertEqual(len(pictures), 1)

    def test_usage(self):
        for light in ("", "#12345", "#12345g"):
            self.assert_refused(2, "--env", "--env", light)
        for numbers in ("2,2", "1", "1,2,-3", "1,2,3,4"):  # neither a color nor likely a file
            self.assert_refused(2, f"--env: expects studio, #rrggbb (sRGB), three numbers from 0 up (linear light) such as 0.2,0.4,1, "
                                f"or a file, not {numbers}\n", "--env", numbers)
        for turn in ("x", "nan", "inf", ""):
            self.assert_refused(2, "--env-rotation", "--env", "studio", "--env-rotation", turn)
        for factor in ("x", "nan", "-1", "2e9"):
            self.assert_refused(2, "--env-intensity", "--env", "studio", "--env-intensity", factor)
        for integrator in ("flat", "normal"):
            self.assert_refused(2, "--integrator path", "--background", "env", "--integrator", integrator)
            for option in (["--guiding"], ["--bsdf", "spec"], ["--ground"]):
                self.assert_refused(2, "--integrator path", *option, "--integrator", integrator)
        self.assert_refused(2, "--ground", "--ground=1e39", "--integrator", "path")

    def test_environment_as_background(self):
        corner = lambda *options: self.picture(CUBE, "--size", "40x30", "--integrator", "path", "--spp", 1, "--tonemap",
                                               "none", *options)[2][0][:3]
        self.assertEqual(corner("--env", "0.5,0,1"), b"\x89\x89\x89")  # the default background, linear 0.25
        self.assertEqual(corner("--env", "0.5,0,1", "--background", "env"), b"\xbc\x00\xff")
        self.assertEqual(corner("--env", "0.5,0,1", "--background", "env", "--env-intensity", "0"), b"\0\0\0")
        self.assertEqual(corner("--env", "0.5,0,1", "--background", "#102030"), b"\x10\x20\x30")
        self.assertEqual(corner("--background", "env"), corner("--background", "env", "--env", "studio"))
        self.assertNotEqual(corner("--background", "env"), corner("--background", "env", "--env-intensity", "0.5"))

    def test_default_background_contrasts_with_white_surfaces(self):
        for rotation in ([0, 0, 0, 1], [-0.5**0.5, 0, 0, 0.5**0.5], [0, 0.5**0.5, 0, 0.5**0.5]):  # faces the front, up, right
            (self.folder / "wall.gltf").write_text(wall(rotation))
            rows = self.picture("wall.gltf", "--size", "40x30")[2]
            self.assertGreater(rows[15][3 * 20] - rows[0][0], 40, rotation)

    def test_ground(self):
        def picture(*options):
            return self.picture(CUBE, "--size", "40x30", "--integrator", "path", "--spp", 4, "--background", "#ffffff", *options)

        plain, ground = picture(), picture("--ground")
        self.assertNotEqual(plain, ground)
        self.assertLess(sum(map(sum, ground[2])), sum(map(sum, plain[2])))
        self.assertEqual(ground, picture("--ground=lowest"))
        self.assertEqual(plain, picture("--ground=1e30"))  # above the camera
        self.assertNotEqual(ground, picture("--ground=-30"))
        for height in ("high", "nan", "inf", "1e400"):
            self.assert_refused(2, "--ground", "--ground=" + height)
        for integrator in ("flat", "normal"):
            self.assert_refused(2, "--integrator path", "--ground", "--integrator", integrator)

    def test_files(self):
        self.assert_refused(5, "missing.exr", "--env", "missing.exr")
        self.assert_refused(5, "1,2,x", "--env", "1,2,x")
        (self.folder / "text.hdr").write_text("no picture")
        self.assert_refused(5, "can't be decoded", "--env", "text.hdr")
        (self.folder / "wide.hdr").write_text("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 70000\n")
        self.assert_refused(6, "70000 x 1", "--env", "wide.hdr")
        (self.folder / "square.ppm").write_bytes(b"P6\n1 1\n255\n\x80\x80\x80")
        self.assert_refused(3, "twice as wide as high", "--env", "square.ppm", "--strict")
        result = self.draw("--env", "square.ppm")
        self.assertEqual(result.returncode, 0)
        self.assertIn(b"warning: square.ppm: ", result.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ["out.ppm", "square.ppm", "text.hdr", "wide.hdr"])


class Exposure(ProgramTest):
    def corner(self, *options, light=0.25):
        """Returns a background pixel of a flat picture."""
        return self.picture(CUBE, "--integrator", "flat", "--size", "40x30", "--background", f"{light},{light},{light}", *options)[2][0][:3]

    def test_values(self):
        self.assertEqual(self.corner(), b"\x89" * 3)
        self.assertEqual(self.corner("--exposure", "1"), b"\xbc" * 3)  # linear 0.5
        self.assertEqual(self.corner("--exposure", "-2.5", "--tonemap", "none"),
                         self.corner(light=0.25 * 2**-2.5))
        self.assertEqual(self.corner("--exposure", "9"), b"\xff" * 3)
        self.assertEqual(self.corner("--tonemap", "khronos-pbr-neutral"),
                         self.corner(light=0.21))
        pixels = {self.corner("--tonemap", name) for name in ("none", "khronos-pbr-neutral", "aces", "agx")}
        self.assertEqual(len(pixels), 4)

    def test_float_formats_contain_linear_light(self):
        for options, name in (((), "a.exr"), (("--exposure", "2", "--tonemap", "agx"), "b.exr")):
            self.run_program(CUBE, "--size", "40x30", "-o", name, *options)
        difference = subprocess.run(["idiff", "-fail", "0", self.folder / "a.exr", self.folder / "b.exr"],
                                    stdout=subprocess.DEVNULL)
        self.assertEqual(difference.returncode, 0)

    def test_files_name_exposure_and_tone_map(self):
        def notes(name, *options):
            self.run_program(CUBE, "--size", "8x6", "-o", name, *options)
            info = subprocess.run(["oiiotool", "--info", "-v", self.folder / name], stdout=subprocess.PIPE)
            return {line.strip() for line in info.stdout.decode().splitlines() if "microtrace:" in line}

        exposed = ("--exposure", "-0.5", "--tonemap", "aces")
        self.assertEqual(notes("a.png", "--integrator", "flat"), set())
        self.assertEqual(notes("b.png", *exposed), {'microtrace:exposure: "-0.5"', 'microtrace:tonemap: "aces"'})
        self.assertEqual(notes("b.exr", *exposed), {'microtrace:exposure: "0"', 'microtrace:tonemap: "none"'})
        self.assertEqual(notes("c.png", "--integrator", "normal", *exposed), set())

    def test_usage(self):
        for option, values in (("--exposure", ("x", "nan", "65", "")), ("--tonemap", ("filmic", "")),
                               ("--backfaces", ("cull", ""))):
            for value in values:
                result = self.run_program(CUBE, option, value)
                self.assertEqual(result.returncode, 2)
                self.assertIn(option.encode(), result.stderr)
        self.assertEqual(os.listdir(self.folder), [])


class AutomaticExposure(ProgramTest):
    """Tests --exposure auto, the default for path-traced glTF assets with lights."""

    def lit(self, intensity, animated=False):
        """Writes an asset: a white square of two units that a light of this intensity in lux lights from in front. An
        animation turns the light away in the first second."""
        corners = struct.pack("<12f", -1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
        data = corners + struct.pack("<2f", 0, 1) + struct.pack("<8f", 0, 0, 0, 1, 0, 1, 0, 0)
        views = [(0, 48), (48, 12), (60, 8), (68, 32)]
        kinds = [(5126, 4, "VEC3"), (5123, 6, "SCALAR"), (5126, 2, "SCALAR"), (5126, 2, "VEC4")]
        document = {
            "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": intensity}]}},
            "scenes": [{"nodes": [0, 1, 2]}], "scene": 0,
            "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}, {"camera": 0, "translation": [0, 0, 1]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0}}],
            "buffers": [{"uri": "data:;base64," + base64.b64encode(data).decode(), "byteLength": len(data)}],
            "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": size} for start, size in views],
            "accessors": [{"bufferView": k, "componentType": kind, "count": count, "type": name}
                          for k, (kind, count, name) in enumerate(kinds)]}
        document["accessors"][0].update(min=[-1, -1, 0], max=[1, 1, 0])
        document["accessors"][2].update(min=[0], max=[1])
        if animated:
            document["animations"] = [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}],
                                       "samplers": [{"input": 2, "output": 3}]}]
        (self.folder / "lit.gltf").write_text(json.dumps(document))

    def center(self, *options):
        """Returns the least and the greatest shown value of the pixel in the middle, and the line about the file."""
        result = self.run_program("lit.gltf", "--size", "41x31", "--spp", "4", "--tonemap", "none", "-o", "out.ppm",
                                  *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        pixel = (self.folder / "out.ppm").read_bytes()[-41 * 31 * 3:][(41 * 15 + 20) * 3:][:3]
        return min(pixel), max(pixel), result.stderr.decode()

    def test_lights_of_files_are_not_blown_out(self):
        for intensity, blown in ((3, False), (3e3, True), (1e5, True)):
            self.lit(intensity)
            low, high, text = self.center()
            self.assertTrue(99 <= low and high < 255, (intensity, low, high))
            self.assertEqual("exposure -" in text, blown, text)
            self.assertEqual(self.center("--exposure", "auto")[:2], (low, high))
            self.assertEqual(self.center("--exposure", "0")[0] == 255, blown)
        self.lit(1e-3)
        self.assertIn(self.center()[0], range(97, 104))

    def test_scaled_lights_give_the_same_picture(self):
        pictures = set()
        for intensity in (2.0 ** 12, 2.0 ** 17, 2.0 ** 20):
            self.lit(intensity)
            self.center()
            pictures.add((self.folder / "out.ppm").read_bytes())
        self.assertEqual(len(pictures), 1)

    def test_frames_share_an_exposure(self):
        self.lit(1e4, animated=True)
        result = self.run_program("lit.gltf", "--size", "16x12", "--spp", "4", "--frames", "0:2", "--fps", "4",
                                  "-o", "f%d.png")
        self.assertEqual(result.returncode, 0, result.stderr)
        stops = re.findall(rb"exposure (-[0-9.]+),", result.stderr)
        self.assertEqual(len(stops), 3, result.stderr)
        self.assertEqual(len(set(stops)), 1)

    def test_other_pictures_keep_their_brightness(self):
        self.lit(1e5)
        self.assertEqual(self.center("--integrator", "flat")[2].count("exposure"), 0)
        self.assertEqual(self.center("--integrator", "flat", "--exposure", "auto")[2].count("exposure"), 0)
        self.assertNotIn("exposure", self.run_program(CUBE, "--size", "8x6", "-o", "cube.ppm").stderr.decode())
        self.assertIn("exposure -1.5,", self.run_program(CUBE, "--size", "8x6", "--exposure", "-1.5", "-o", "cube.ppm").stderr.decode())
        self.assertNotIn("exposure", self.run_program(CUBE, "--size", "8x6", "--aov", "depth", "--exposure", "3",
                                                      "-o", "depth.ppm").stderr.decode())

    def test_commands_without_it(self):
        for command in (("merge", "a", "-o", "b.png"), ("compare", "a.png", "b.png"), ("dataset", CUBE, "-o", "d")):
            result = self.run_program(*command, "--exposure", "auto")
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(f"--exposure: {command[0]} doesn't support auto".encode(), result.stderr)


class DarkPictures(ProgramTest):
    """Tests warnings about pictures that are black or nearly black."""

    def warnings(self, document, *options, code=0):
        (self.folder / "scene.json").write_text(json.dumps({
            "version": 1,
            "cameras": [{"name": "front", "type": "perspective", "position": [0, 0, 4], "direction": [0, 0, -1],
                         "vertical_fov": 40},
                        {"name": "away", "type": "perspective", "position": [0, 0, 4], "direction": [0, 0, 1],
                         "vertical_fov": 40}],
            "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1}], **document}))
        result = self.run_program("scene.json", "--size", "20x20", "--spp", "4",
                                  *(() if "--integrator" in options else ("--integrator", "path")), *options)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual((self.folder / "scene.png").exists(), code == 0)
        (self.folder / "scene.png").unlink(missing_ok=True)
        kind = "warning: " if code == 0 else "error: "
        return "".join(line for line in result.stderr.decode().splitlines(True) if line.startswith(kind))

    def lamp(self, intensity, kind="point", **more):
        place = {"direction": [0, 0, -1]} if kind == "directional" else {"position": [0, 0, 4]}
        return {"name": f"{kind} {intensity}", "type": kind, "intensity": intensity, **place, **more}

    def test_lights_of_intensity_zero(self):
        for lights, words in (([self.lamp(0)], "1 light of intensity 0, no environment"),
                              ([self.lamp(0), self.lamp(0, "directional")], "2 lights of intensity 0, no environment"),
                              ([self.lamp(0), self.lamp(1e-9)], "2 lights (1 of intensity 0), no environment")):
            text = self.warnings({"lights": lights})
            self.assertIn("scene.json: most of the visible scene is black; it is lit by " + words, text)
            self.assertIn("the studio lights only scenes without lights", text)
            self.assertIn("; add light with --env studio", text)
            self.assertEqual("--exposure" in text, "(1 of" in text, text)
        self.assertIn("0 lights, a black environment; add light",
                      self.warnings({"environment": {"type": "uniform", "color": [0, 0, 0]}}))

    def test_cameras_inside_of_closed_objects(self):
        room = {"objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 90}]}
        for options in ((), ("--env", "studio"), ("--env", "1,1,1")):
            text = self.warnings(room, *options)
            self.assertIn("the camera may be inside a closed object; look from outside with --view 30,25", text)
            self.assertNotIn("add light", text)
        self.assertEqual(self.warnings(room, "--view", "30,25"), "")

    def test_the_suggested_exposure_brightens_the_picture(self):
        document = {"lights": [self.lamp(1e-5, "directional")]}
        stops = re.search(r"--exposure (\d+)\n", self.warnings(document)).group(1)
        self.assertEqual(self.warnings(document, "--exposure", stops), "")
        self.assertEqual(self.warnings(document, "--env", "studio"), "")

    def test_lit_pictures_have_no_warning(self):
        for document in ({}, {"lights": [self.lamp(3, "directional")]}, {"lights": [self.lamp(30)]},
                         {"lights": [self.lamp(0)], "environment": {"type": "studio"}},
                         {"background": [1, 0, 0], "lights": [self.lamp(30)]}):
            self.assertEqual(self.warnings(document), "", document)
        # A small, distant sphere on a black background is not considered dark.
        small = {"objects": [{"type": "sphere", "center": [0, 0, -20], "radius": 1}]}
        self.assertEqual(self.warnings(small), "")
        self.assertEqual(self.warnings({"lights": [self.lamp(0)]}, "--max-depth", "1"), "")
        self.assertEqual(self.warnings({"lights": [self.lamp(0)]}, "-q"), "")
        self.assertEqual(self.warnings({"lights": [self.lamp(0)]}, "--integrator", "flat"), "")

    def test_a_ground_without_a_lowest_point(self):
        plane = {"objects": [{"type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}]}
        words = "scene.json: no object is bounded, so the scene has no lowest point for --ground; give a height, as in --ground=0\n"
        self.assertEqual(self.warnings(plane, "--ground"), "warning: " + words)
        self.assertEqual(self.warnings(plane, "--ground", "--strict", code=3), "error: " + words)
        for document, option in ((plane, "--ground=0"), ({}, "--ground"), ({"objects": plane["objects"] + [{"type": "sphere", "center": [0, 0, 0], "radius": 1}]}, "--ground")):
            self.assertEqual(self.warnings(document, option), "", option)
        (self.folder / "plane.json").write_text((self.folder / "scene.json").read_text().replace("sphere", "disc").replace('"radius"', '"normal": [0, 1, 0], "radius"'))
        self.assertEqual(self.run_program("plane.json", "--ground", "--integrator", "path", "--spp", "1", "--size", "8x8", "-q").stderr, b"")

    def test_other_backgrounds(self):
        for options in (("--background", "#808080"), ("--background", "transparent")):
            self.assertIn("most of the visible scene is black", self.warnings({"lights": [self.lamp(0)]}, *options))
            self.assertEqual(self.warnings({}, *options), "")
            self.assertIn("sees nothing", self.warnings({}, "--camera", "away", *options))

    def test_cameras_that_see_nothing(self):
        for integrator in ("path", "flat"):
            self.assertIn("scene.json: the camera away sees nothing of the scene; choose another one with --camera",
                          self.warnings({}, "--camera", "away", "--integrator", integrator))
        self.assertEqual(self.warnings({}, "--camera", "away", "--background", "env"), "")
        self.assertEqual(self.warnings({}, "--camera", "away", "--crop", "0,0,5,5"), "")
        self.assertIn("the camera sees nothing", self.warnings({}, "--eye", "0,0,9", "--target", "0,0,18"))

    def test_framed_scenes_that_face_away(self):
        (self.folder / "wall.gltf").write_text(wall([0, 1, 0, 0]))  # faces -z

        def warnings(*options):
            return self.run_program("wall.gltf", "--size", "16x12", "--spp", 1, "-o", "out.ppm", *options).stderr.decode()

        self.assertIn("face away; look from the opposite side with --view 210,-25", warnings())
        self.assertIn("face away; look from another side with --view", warnings("--view", "front"))
        self.assertIn("with --camera", warnings("--eye", "0,0,9", "--target", "0,0,18"))
        self.assertNotIn("warning", warnings("--view", "210,-25"))

    def test_framed_scenes_without_points(self):
        for shape in ({"type": "quadric", "coefficients": {"a": 1, "b": 1, "c": 1, "j": 1}},
                      {"type": "triangle", "a": [0, 0, 0], "b": [0, 0, 0], "c": [0, 0, 0]}):
            (self.folder / "empty.json").write_text(json.dumps({"version": 1, "objects": [shape]}))
            text = self.run_program("empty.json", "--size", "16x12", "-o", "out.ppm").stderr.decode()
            self.assertIn("sees nothing of the scene; its objects may be empty", text)
            self.assertNotIn("one-sided", text)

    def test_strict_refuses(self):
        self.assertIn("most of the visible scene is black", self.warnings({"lights": [self.lamp(0)]}, "--strict", code=3))
        self.assertIn("sees nothing", self.warnings({}, "--strict", "-q", "--camera", "away", code=3))

    def test_verbose_lists_the_lights(self):
        for document, words in (({}, "light: the built-in studio"),
                                ({"lights": [self.lamp(3)]}, "light: 1 light, no environment"),
                                ({"environment": {"type": "studio"}}, "light: 0 lights, an environment")):
            (self.folder / "scene.json").unlink(missing_ok=True)
            self.warnings(document)
            said = self.run_program("scene.json", "--size", "8x8", "--spp", "1", "--integrator", "path", "-v").stderr
            self.assertIn(("info: " + words + "\n").encode(), said)
            (self.folder / "scene.png").unlink()


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
