#!/usr/bin/env python3
"""Tests lists of views in .npz files.

usage: npz_views_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import itertools
import json
import math
import struct
import sys
import unittest
import zipfile
from pathlib import Path
from random import Random

sys.dont_write_bytecode = True
from program import ProgramTest

SOURCE = Path(sys.argv[2]).resolve()
SCENE = SOURCE / "scenes/perspective1.json"
K = [[20, 0, 11.5], [0, 21, 7.5], [0, 0, 1]]
CODES = {"<f8": "d", "<f4": "f", "<i8": "q", "<i4": "i", "<u8": "Q", "<u4": "I"}


def extrinsic(angle, distance):
    """Returns the matrix of a camera that looks at the origin from this angle about the vertical axis."""
    c, s = math.cos(angle), math.sin(angle)
    return [[c, 0, -s, 0], [0, -1, 0, 0], [-s, 0, -c, distance], [0, 0, 0, 1]]


def shape_of(values):
    return (len(values), *(shape_of(values[0]) if values else ())) if isinstance(values, list) else ()


def npy(values, kind="<f8", fortran=False, version=1, header=None):
    """Returns the .npy file of nested lists."""
    shape = shape_of(values)
    indices = itertools.product(*(range(extent) for extent in (reversed(shape) if fortran else shape)))
    data = bytearray()
    for index in indices:
        value = values
        for i in (reversed(index) if fortran else index):
            value = value[i]
        data += struct.pack("<" + CODES.get(kind, "d"), value)
    text = (header or f"{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {shape}, }}").encode() + b"\n"
    size = struct.pack("<H" if version == 1 else "<I", len(text))
    return b"\x93NUMPY" + bytes([version, 0]) + size + text + data


class NpzViews(ProgramTest):
    def write(self, arrays, compression=zipfile.ZIP_STORED, name="views.npz"):
        """Writes arrays, or bytes of .npy files, as numpy.savez does."""
        with zipfile.ZipFile(self.folder / name, "w", compression) as archive:
            for key, values in arrays.items():
                with archive.open(key + ".npy", "w", force_zip64=True) as file:
                    file.write(values if isinstance(values, bytes) else npy(values))

    def dataset(self, *arguments, code=0, output="out", views="views.npz"):
        result = self.run_program("dataset", SCENE, "-o", output, "--views", views, "--formats", "exr", "--aov", "depth",
                                  *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr.decode()

    def pictures(self, output="out"):
        return [path.read_bytes() for path in sorted((self.folder / output).glob("*.exr"))]

    def test_views_equal_those_of_json(self):
        transforms = [extrinsic(angle, 8) for angle in (0, 0.5, 2)]
        lens = [0.1, -0.05, 0.002, -0.003, 0.01]
        names = dict(zip(("k1", "k2", "p1", "p2", "k3"), lens))
        image = {"width": 24, "height": 16}
        views = [{"size": image, "camera": {"type": "calibrated", "image": image, "fx": 20, "fy": 21, "cx": 11.5, "cy": 7.5,
                                            "extrinsic": transform, "distortion": {"type": "rational", **names}}}
                 for transform in transforms]
        (self.folder / "views.json").write_text(json.dumps({"views": views}))
        self.dataset(views="views.json")
        whole = self.pictures()
        self.assertEqual(len(set(whole)), 3)
        arrays = {
            "separate": {"K": [K] * 3, "T": transforms, "distortion": [lens] * 3, "size": [[24, 16]] * 3},
            "shared": {"K": K, "T": transforms, "distortion": lens, "size": [24, 16]},
            "types": {"K": npy([K] * 3, "<f4", True), "T": npy(transforms, "<f8", True, 2),
                      "distortion": npy([lens] * 3, fortran=True), "size": npy([24, 16], "<i8")},
            "integers": {"K": K, "T": transforms, "distortion": lens, "size": npy([[24, 16]] * 3, "<u4", version=3)},
        }
        for name, content in arrays.items():
            for compression in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                self.write(content, compression)
                self.dataset(output=f"{name}{compression}")
                self.assertEqual(self.pictures(f"{name}{compression}"), whole, name)
        del arrays["shared"]["size"]
        self.write(arrays["shared"])
        self.dataset("--size", "24x16", output="option")
        self.assertEqual(self.pictures("option"), whole)
        self.assertIn("array size is missing", self.dataset(code=3, output="none"))

    def test_fisheye_lenses_and_times(self):
        self.write({"K": K, "T": [extrinsic(0, 8)], "fisheye": [0.1, 0.02, 0, 0], "size": [24, 16]})
        self.dataset()
        self.write({"K": K, "T": [extrinsic(0, 8)], "size": [24, 16]})
        self.dataset(output="pinhole")
        self.assertNotEqual(self.pictures(), self.pictures("pinhole"))
        self.write({"K": K, "T": [extrinsic(0, 8)], "size": [24, 16], "time": [0.5]})
        message = self.dataset("--frames", "0:1", code=2, output="times")
        self.assertIn("already have times", message)

    def test_errors(self):
        good = {"K": K, "T": [extrinsic(0, 8), extrinsic(1, 8)], "size": [24, 16]}
        scaled = [[2 * x for x in row] for row in extrinsic(0, 8)[:3]] + [[0, 0, 0, 1]]
        mirrored = [[-x for x in extrinsic(0, 8)[0]], *extrinsic(0, 8)[1:]]
        big = "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 4, 4), }"
        for change, reason in (
                ({"T": None}, "array T is missing"),
                ({"K": None}, "array K is missing"),
                ({"pose": K}, "array pose is unknown"),
                ({"T": extrinsic(0, 8)}, "T: must have the shape (N, 4, 4) for N views, has (4, 4)"),
                ({"T": []}, "T: must have the shape (N, 4, 4) for N views, has (0,)"),
                ({"K": [K] * 3}, "K: must have the shape (2, 3, 3) or (3, 3), has (3, 3, 3)"),
                ({"time": 1.5}, "time: must have the shape (2,), has ()"),
                ({"time": [1.0]}, "time: must have the shape (2,), has (1,)"),
                ({"time": [1.0, -1.0]}, "time[1]: must not be negative"),
                ({"size": [24, 16.5]}, "size: must be two positive whole numbers"),
                ({"size": [[24, 16], [0, 16]]}, "size[1]: must be two positive whole numbers"),
                ({"size": [1e6, 1e6]}, "size: "),
                ({"distortion": [1, 2, 3]}, "distortion: must have the shape (2, 4) or (4,) or (2, 5)"),
                ({"distortion": [0] * 4, "fisheye": [0] * 4}, "must not be combined"),
                ({"K": [[20, 1, 11], *K[1:]]}, "K: must have no skew"),
                ({"K": [K[0], K[1], [0, 0, 2]]}, "K: must have the form"),
                ({"K": [[-20, 0, 11], *K[1:]]}, "view 0: fx"),
                ({"K": [[math.nan, 0, 11], *K[1:]]}, "K: must be finite"),
                ({"T": [extrinsic(0, 8), scaled]}, "T[1]: must be a rotation"),
                ({"T": [mirrored]}, "T[0]: must be a rotation, is a reflection"),
                ({"T": [[*extrinsic(0, 8)[:3], [0, 0, 1, 1]]]}, "T[0]: must have the last row"),
                ({"K": npy(K, ">f8")}, "array K: has the type >f8; convert it"),
                ({"K": npy(K, "|O")}, "array K: has the type |O"),
                ({"K": npy(K)[:-8]}, "array K: has the shape (3, 3), but another number of values"),
                ({"K": npy(K) + b"12345678"}, "array K: has the shape (3, 3), but another number of values"),
                ({"T": npy([extrinsic(0, 8)], header=big)}, "array T: is cut off"),
                ({"K": npy(K, header="[1, 2]")}, "array K: has a header that is not understood"),
                ({"K": b"text"}, "array K: is not in the format .npy")):
            self.write({name: value for name, value in {**good, **change}.items() if value is not None})
            message = self.dataset(code=6 if change == {"size": [1e6, 1e6]} else 3)
            self.assertIn("views.npz: " + ("" if reason.startswith("must") else reason), message)
            self.assertIn(reason, message)
            self.assertFalse((self.folder / "out").exists())

    def test_archives_that_claim_much_memory_are_refused(self):
        self.write({"K": K, "T": [extrinsic(0, 8)], "size": [24, 16]}, zipfile.ZIP_DEFLATED)
        content = bytearray((self.folder / "views.npz").read_bytes())
        entry = content.index(b"PK\1\2")
        content[entry + 24:entry + 28] = struct.pack("<I", 1 << 29)
        (self.folder / "views.npz").write_bytes(content)
        self.assertIn("is not a whole ZIP archive", self.dataset(code=5))
        self.write({"K": npy([[[0.0] * 3] * 3] * 40000), "T": [extrinsic(0, 8)]}, zipfile.ZIP_DEFLATED)
        self.assertIn("--memory-limit", self.dataset("--memory-limit", "1M", code=6))

    def test_damaged_archives_are_refused(self):
        random = Random(1)
        for compression in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            self.write({"K": K, "T": [extrinsic(0, 8)], "size": [24, 16]}, compression)
            self.dataset(output=f"good{compression}")
            content = (self.folder / "views.npz").read_bytes()
            cuts = [content[:random.randrange(4, len(content))] for _ in range(20)]
            for _ in range(60):
                flipped = bytearray(content)
                flipped[random.randrange(len(content))] ^= 1 << random.randrange(8)
                cuts.append(bytes(flipped))
            for number, damaged in enumerate(cuts):
                (self.folder / "views.npz").write_bytes(damaged)
                result = self.run_program("dataset", SCENE, "-o", "out", "--views", "views.npz", "--formats", "exr", "-q")
                if number < 20:
                    self.assertEqual(result.returncode, 5, result.stderr)
                # Some bits don't matter, such as those of dates.
                self.assertIn(result.returncode, (0, 2, 3, 4, 5, 6), result.stderr)
                if result.returncode not in (0, 2):
                    self.assertIn(b"views.npz", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
