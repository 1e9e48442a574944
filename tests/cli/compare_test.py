#!/usr/bin/env python3
"""Tests `microtrace compare`. OpenImageIO's idiff is the judge of the numbers.

usage: compare_test.py PROGRAM SOURCE_FOLDER
"""

import json
import math
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import unittest
import zlib
from pathlib import Path

from program import PROGRAM, ProgramTest

SCENES = Path(sys.argv[2]).absolute() / "scenes"


class Compare(ProgramTest):
    def compare(self, *arguments, code=None):
        result = self.run_program("compare", *arguments)
        if code is not None:
            self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def difference(self, *arguments, code=7):
        return json.loads(self.compare(*arguments, "--json", code=code).stdout)

    def draw(self, name, *arguments, scene="perspective1.json"):
        result = self.run_program(SCENES / scene, "--size", "64x48", *arguments, "-o", name, "-q")
        self.assertEqual(result.returncode, 0, result.stderr)

    def write(self, name, data):
        (self.folder / name).write_bytes(data)

    def tga(self, name, gray, alpha):
        """Writes 2 x 1 gray pixels with alpha."""
        self.write(name, struct.pack("<3B5x4H2B", 0, 0, 3, 0, 0, 2, 1, 16, 8) + bytes([gray, alpha] * 2))

    def gif(self, name, transparent=None, frames=1):
        """Writes 2 x 1 pixels of the colors 0 and 1. Codes of 8 bits need no compression."""
        control = bytes([0x21, 0xF9, 4, 0 if transparent is None else 1, 0, 0, transparent or 0, 0])
        frame = control + struct.pack("<B4HB", 0x2C, 0, 0, 2, 1, 0) + bytes([7, 4, 128, 0, 1, 129, 0])
        palette = bytes([9, 9, 9, 200, 100, 50]) + bytes(3 * 126)
        self.write(name, b"GIF89a" + struct.pack("<2H3B", 2, 1, 0xF6, 0, 0) + palette + frames * frame + b";")

    def tiff(self, name, extra_samples, pages=1, later_kind=0):
        """Writes one pixel of floats, with premultiplied (1) or unassociated (2) alpha. `later_kind` is the NewSubfileType of all
        pages but the first."""
        pixel = (0.25, 0.125, 0.0625, 0.5) if extra_samples == 1 else (0.5, 0.25, 0.125, 0.5)
        data = b"II*\0" + struct.pack("<I4H4H4f", 40, *[32] * 4, *[3] * 4, *pixel)
        tags = [(254, 0), (256, 1), (257, 1), (258, 8), (259, 1), (262, 2), (273, 24), (277, 4), (278, 1), (279, 16), (338, extra_samples), (339, 16)]
        for page in range(pages):
            after = len(data) + 2 + 12 * len(tags) + 4 if page + 1 < pages else 0
            tags[0] = (254, later_kind if page > 0 else 0)
            entries = [struct.pack("<2H2I", tag, 3, 4 if tag in (258, 339) else 1, value) for tag, value in tags]
            data += struct.pack("<H", len(tags)) + b"".join(entries) + struct.pack("<I", after)
        self.write(name, data)

    def ppm(self, name, width, height, samples, maximum=255, text=False):
        head = f"{'P3' if text else 'P6'}\n# a comment\n{width} {height}\n{maximum}\n".encode()
        if text:
            body = " ".join(map(str, samples)).encode() + b"\n"
        else:
            body = struct.pack(f">{len(samples)}{'B' if maximum < 256 else 'H'}", *samples)
        self.write(name, head + body)

    def test_results_that_can_not_be_written(self):
        for name, size in (("a.ppm", (2, 1)), ("b.ppm", (1, 1))):
            self.ppm(name, *size, [0] * 3 * size[0])
        for other in ("a.ppm", "b.ppm"):
            with open("/dev/full", "w") as full:
                result = subprocess.run([PROGRAM, "compare", "a.ppm", other], cwd=self.folder, stdout=full, stderr=subprocess.PIPE)
            self.assertEqual(result.returncode, 5, result.stderr)
            self.assertIn(b"standard output: can't be written: No space left on device", result.stderr)
            reader, writer = os.pipe()
            os.close(reader)
            result = subprocess.run([PROGRAM, "compare", "a.ppm", other], cwd=self.folder, stdout=writer, stderr=subprocess.PIPE)
            os.close(writer)
            self.assertEqual(result.returncode, 5, result.stderr)
            self.assertEqual(result.stderr, b"error: standard output: can't be written: Broken pipe; the program that reads the pipe has ended\n")

    def test_formats_of_one_rendering_are_equal(self):
        for extension in ("ppm", "png", "exr", "tif"):
            self.draw(f"a.{extension}")
        self.draw("ascii.ppm", "--ppm", "ascii")
        names = ["a.ppm", "a.png", "a.exr", "a.tif", "ascii.ppm"]
        for a in names:
            for b in names:
                result = self.compare(a, b, code=0)
                self.assertEqual(result.stdout, b"equal\n")

    def test_light_is_converted_as_in_pictures(self):
        for alpha in ([], ["--background", "transparent"]):
            for extension in ("png", "exr"):
                self.draw(f"l.{extension}", "--spp", "4", "--exposure", "0.5", "--tonemap", "aces", *alpha, scene="gltf/materials.glb")
            self.compare("l.png", "l.exr", "--exposure", "0.5", "--tonemap", "aces", code=0)
            self.compare("l.exr", "l.png", "--exposure", "0.5", "--tonemap", "aces", code=0)
            self.assertGreater(self.difference("l.png", "l.exr")["differing"], 1000)
            self.compare("l.exr", "l.exr", code=0)

    def test_alpha(self):
        self.draw("opaque.png")
        self.draw("alpha.png", "--background", "transparent")
        difference = self.difference("opaque.png", "alpha.png")
        self.assertEqual(difference["maximum"], 1)
        self.draw("alpha.exr", "--background", "transparent")
        self.compare("alpha.png", "alpha.exr", code=0)
        # The background of opaque.png is black, so that only alpha differs.
        self.assertGreater(difference["differing"], 100)
        self.compare("opaque.png", "alpha.png", "-o", "d.ppm", code=7)
        pixels = (self.folder / "d.ppm").read_bytes().removeprefix(b"P6\n64 48\n255\n")
        self.assertEqual(pixels.count(b"\xff"), 3 * difference["differing"])

    def test_alpha_of_other_formats(self):
        for alpha in (255, 0):
            self.tga(f"gray{alpha}.tga", 100, alpha)
        self.assertEqual(self.difference("gray255.tga", "gray0.tga")["maximum"], 1)
        self.gif("opaque.gif")
        self.gif("transparent.gif", transparent=1)
        difference = self.difference("opaque.gif", "transparent.gif")
        self.assertEqual((difference["maximum"], difference["at_maximum"], difference["differing"]), (1, [1, 0], 1))
        # Floats are premultiplied, whatever the file has.
        self.tiff("premultiplied.tif", 1)
        self.tiff("unassociated.tif", 2)
        self.compare("premultiplied.tif", "unassociated.tif", code=0)
        # Environments ignore alpha.
        for kind in ("premultiplied", "unassociated"):
            self.draw(f"{kind}.exr", "--env", f"{kind}.tif", "--background", "env", "--integrator", "path", "--spp", "1", scene="sky.json")
        values = self.difference("premultiplied.exr", "unassociated.exr")["first"]["values"]
        for stored, multiplied in zip(values[1][:3], values[0][:3]):
            self.assertAlmostEqual(stored, 2 * multiplied, 6)

    @unittest.skipUnless(shutil.which("oiiotool"), "openimageio-tools")
    def test_alpha_of_gray_exr(self):
        for alpha in (255, 0):
            self.tga("gray.tga", 100, alpha)
            subprocess.run(["oiiotool", "gray.tga", "--chnames", "Y,A", "-o", f"gray{alpha}.exr"], cwd=self.folder, check=True)
        self.assertEqual(self.difference("gray255.exr", "gray0.exr")["maximum"], 1)

    def test_files_of_several_pictures(self):
        self.ppm("a.ppm", 1, 1, [1, 2, 3])
        frame = (self.folder / "a.ppm").read_bytes()
        self.write("cut.ppm", frame + frame[:9])
        self.write("two.ppm", frame + frame)
        self.write("line.ppm", frame + b"\n")
        self.compare("a.ppm", "line.ppm", code=0)
        self.gif("two.gif", frames=2)
        self.tiff("two.tif", 1, pages=2)
        self.draw("a.png")
        png = (self.folder / "a.png").read_bytes()
        for name, frames in (("one.png", 1), ("two.png", 2)):
            chunks = b""
            for chunk in (b"tEXtTitle\0acTL IDAT", b"acTL" + struct.pack(">2I", frames, 0)):
                chunks += struct.pack(">I", len(chunk) - 4) + chunk + struct.pack(">I", zlib.crc32(chunk))
            self.write(name, png[:33] + chunks + png[33:])
        self.compare("a.png", "one.png", code=0)
        self.tiff("thumbnail.tif", 1, pages=2, later_kind=1)
        self.compare("thumbnail.tif", "thumbnail.tif", code=0)
        self.write("two.webp", b"RIFF" + struct.pack("<I", 22) + b"WEBPVP8X" + struct.pack("<2I", 10, 2) + bytes(6))
        for name in ("cut.ppm", "two.ppm", "two.gif", "two.tif", "two.png", "two.webp"):
            refused = self.compare(name, name, code=4)
            self.assertIn(b"in a file of its own", refused.stderr)
            self.assertEqual(refused.stdout, b"")
        self.ppm("more.ppm", 1, 1, [1, 2, 3, 4], text=True)
        self.assertIn(b"further text", self.compare("a.ppm", "more.ppm", code=5).stderr)

    def test_equal_steps_are_equal_differences(self):
        for maximum in (255, 65535):
            for step in (1, 2, 3, 5, 8, 21):
                lower = [k * ((maximum - step) // 251) for k in range(252)]
                self.ppm("a.ppm", 84, 1, lower, maximum)
                self.ppm("b.ppm", 84, 1, [k + step for k in lower], maximum)
                self.assertEqual(self.difference("a.ppm", "b.ppm")["maximum"], step / maximum)
                self.compare("a.ppm", "b.ppm", "--threshold", repr(step / maximum), code=0)
                self.compare("a.ppm", "b.ppm", "--threshold", repr(math.nextafter(step / maximum, 0)), code=7)
                self.assertEqual(self.difference("a.ppm", "b.ppm", "--threshold", repr(math.nextafter(step / maximum, 0)))["differing"], 84)

    def test_memory_of_both_pictures_counts(self):
        self.ppm("a.ppm", 2000, 1500, bytes(9_000_000))
        self.compare("a.ppm", "a.ppm", "--memory-limit", "120M", code=0)
        self.compare("a.ppm", "a.ppm", "--memory-limit", "90M", code=6)
        self.compare("a.ppm", "a.ppm", "--memory-limit", "120M", "-o", "d.ppm", code=6)
        self.assertFalse((self.folder / "d.ppm").exists())

    def test_neighboring_integers_differ_by_exactly_one_step(self):
        for maximum in (255, 65535):
            samples = [3 * (k // 3) * (maximum // 255) % maximum for k in range(3 * 256)]
            self.ppm("a.ppm", 256, 1, samples, maximum)
            self.ppm("b.ppm", 256, 1, [k + 1 for k in samples], maximum)
            self.assertAlmostEqual(self.difference("a.ppm", "b.ppm")["maximum"], 1 / maximum, 14)
            self.compare("a.ppm", "b.ppm", "--threshold", repr(1 / maximum * (1 + 1e-11)), code=0)
            self.compare("a.ppm", "b.ppm", "--threshold", repr(1 / maximum * (1 - 1e-11)), code=7)

    def test_one_changed_sample(self):
        choices = random.Random(1)
        width, height = 31, 17
        samples = [choices.randrange(256) for _ in range(3 * width * height)]
        self.ppm("a.ppm", width, height, samples)
        for _ in range(10):
            at = choices.randrange(len(samples))
            other = list(samples)
            other[at] ^= 1 << choices.randrange(8)
            self.ppm("b.ppm", width, height, other)
            x, y = at // 3 % width, at // 3 // width
            expected = abs(samples[at] - other[at]) / 255
            for names in (("a.ppm", "b.ppm"), ("b.ppm", "a.ppm")):
                d = self.difference(*names)
                self.assertEqual((d["pixels"], d["differing"], d["first"]["at"], d["at_maximum"]), (width * height, 1, [x, y], [x, y]))
                self.assertAlmostEqual(d["maximum"], expected, 6)
                self.assertAlmostEqual(d["mean"], expected / len(samples), 9)
                self.assertAlmostEqual(d["root_mean_square"], expected / len(samples)**0.5, 7)
                values = d["first"]["values"]
                self.assertAlmostEqual(values[0][at % 3] * 255, (samples if names[0] == "a.ppm" else other)[at], 4)
            self.compare("a.ppm", "b.ppm", "--threshold", expected + 1e-6, code=0)
            self.compare("a.ppm", "b.ppm", "--threshold", expected - 1e-6, code=7)

    def test_sixteen_bits(self):
        samples = [0, 257, 65535, 1000, 2000, 3000]
        self.ppm("a.ppm", 2, 1, samples, 65535)
        self.ppm("text.ppm", 2, 1, samples, 65535, text=True)
        self.compare("a.ppm", "text.ppm", code=0)
        self.ppm("b.ppm", 2, 1, [0, 1, 255, 4, 8, 12])
        self.assertEqual(self.difference("a.ppm", "b.ppm")["first"]["at"], [1, 0])
        self.ppm("c.ppm", 2, 1, [0, 1, 1, 0, 1, 1], 1)
        self.ppm("d.ppm", 2, 1, [0, 255, 255, 0, 255, 255])
        self.compare("c.ppm", "d.ppm", code=0)

    def test_gray_files(self):
        for maximum in (255, 1000, 65535):
            gray = [maximum * k // 63 for k in range(64)]
            self.ppm("color.ppm", 8, 8, [k for k in gray for _ in range(3)], maximum)
            color = (self.folder / "color.ppm").read_bytes()
            head = b"P5" + color[2:len(color) - 64 * (3 if maximum < 256 else 6)]
            self.write("gray.pgm", head + struct.pack(f">64{'B' if maximum < 256 else 'H'}", *gray))
            self.write("text.pgm", b"P2" + head[2:] + " ".join(map(str, gray)).encode())
            for name in ("gray.pgm", "text.pgm"):
                self.compare("color.ppm", name, code=0)

    @unittest.skipUnless(shutil.which("idiff"), "openimageio-tools")
    def test_numbers_are_those_of_idiff(self):
        self.draw("a.exr", "--spp", "2", scene="gltf/materials.glb")
        self.draw("b.exr", "--spp", "2", "--seed", "7", scene="gltf/materials.glb")
        self.draw("a.png", "--spp", "2", scene="gltf/materials.glb")
        self.draw("b.png", "--spp", "2", "--seed", "7", scene="gltf/materials.glb")
        for extension in ("exr", "png"):
            d = self.difference(f"a.{extension}", f"b.{extension}")
            judge = subprocess.run(["idiff", "-fail", "0", f"a.{extension}", f"b.{extension}"], cwd=self.folder, capture_output=True, text=True)
            def figure(name, text=judge.stdout):
                return float(re.search(name + r"\s*=\s*([\d.e+-]+)", text)[1])
            self.assertAlmostEqual(d["mean"] / figure("Mean error"), 1, 3)
            self.assertAlmostEqual(d["root_mean_square"] / figure("RMS error"), 1, 3)
            self.assertAlmostEqual(d["maximum"] / figure("Max error"), 1, 3)
            self.assertIn(f"@ ({d['at_maximum'][0]}, {d['at_maximum'][1]},", judge.stdout)

    def test_difference_picture(self):
        self.ppm("a.ppm", 2, 1, [10, 20, 30, 40, 50, 60])
        self.ppm("b.ppm", 2, 1, [10, 25, 30, 0, 50, 61])
        self.compare("a.ppm", "b.ppm", "-o", "d.ppm", code=7)
        self.assertEqual((self.folder / "d.ppm").read_bytes(), b"P6\n2 1\n255\n" + bytes([0, 40, 0, 255, 0, 8]))
        before = (self.folder / "a.ppm").read_bytes()
        self.assertIn(b"would overwrite", self.compare("a.ppm", "b.ppm", "-o", "a.ppm", code=2).stderr)
        self.assertEqual((self.folder / "a.ppm").read_bytes(), before)
        self.compare("a.ppm", "b.ppm", "-o", "d.unknown", code=2)
        self.compare("a.ppm", "b.ppm", "-o", "missing/d.png", code=5)

    def test_sizes(self):
        self.ppm("a.ppm", 2, 1, [0] * 6)
        self.ppm("b.ppm", 1, 2, [0] * 6)
        self.assertEqual(self.compare("a.ppm", "b.ppm", "-o", "d.png", code=7).stdout, b"the sizes differ: 2 x 1 and 1 x 2 pixels\n")
        self.assertFalse((self.folder / "d.png").exists())
        self.assertEqual(self.difference("a.ppm", "b.ppm"), {"sizes": [[2, 1], [1, 2]]})

    def test_bad_input(self):
        self.draw("a.png")
        whole = (self.folder / "a.png").read_bytes()
        self.draw("a.exr")
        jpeg = (SCENES.parent / "tests/golden/images/jpeg/444_progressive.jpg").read_bytes()
        (self.folder / "whole.jpg").write_bytes(jpeg)
        self.compare("whole.jpg", "whole.jpg", code=0)
        cases = {"empty.png": b"", "cut.jpg": jpeg[:len(jpeg) * 2 // 3], "cut.png": whole[:200], "half.png": whole[:len(whole) * 2 // 3],
                 "cut.exr": (self.folder / "a.exr").read_bytes()[:300], "text.png": b"hello",
                 "short.ppm": b"P6\n9 9\n255\nabc", "big.ppm": b"P6\n99999 99999\n255\nabc", "zero.ppm": b"P6\n0 9\n255\n",
                 "letters.ppm": b"P3\n1 1\n255\n1 2 x\n", "above.ppm": b"P3\n1 1\n255\n1 2 256\n", "huge.ppm": b"P6\n99999999999999999999 1\n255\n",
                 "head.ppm": b"P6", "comment.ppm": b"P6 #"}
        for name, content in cases.items():
            (self.folder / name).write_bytes(content)
            result = self.compare("a.png", name)
            self.assertIn(result.returncode, (5, 6), (name, result.stderr))
            self.assertIn(name.encode(), result.stderr)
        for arguments, code in ((["a.png"], 2), (["a.png"] * 3, 2), (["a.png", "missing.png"], 5), (["a.png", "."], 5), ([], 2),
                                (["a.png", "a.png", "--threshold", "-1"], 2), (["a.png", "a.png", "--threshold", "nan"], 2)):
            self.compare(*arguments, code=code)

    def test_the_comparison_keeps_standard_output(self):
        self.draw("a.ppm")
        self.assertEqual(self.compare("a.ppm", "a.ppm", "-o", "-", code=2).stdout, b"")

    def test_beginnings_of_riff_files_are_no_pictures(self):
        self.draw("a.ppm")
        for size in range(4, 12):
            (self.folder / "b.webp").write_bytes(b"RIFF\0\0\0\0WEB"[:size])
            self.assertNotEqual(self.compare("a.ppm", "b.webp").returncode, 1, size)

    def test_infinities(self):
        self.draw("a.exr", "--integrator", "depth")  # infinite where nothing is visible
        self.compare("a.exr", "a.exr", code=0)
        self.draw("b.exr", "--integrator", "flat")
        d = self.difference("a.exr", "b.exr")
        self.assertEqual((d["maximum"], d["mean"]), ("Infinity", "Infinity"))
        # The result is printed even if the picture of the differences can't be stored.
        failed = self.compare("a.exr", "b.exr", "-o", "d.hdr", code=2)
        self.assertEqual(failed.stdout, self.compare("a.exr", "b.exr").stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
