#!/usr/bin/env python3
"""Compares `microtrace explain` with pictures of exact quantities, and its numbers with exact rational arithmetic.

usage: explain_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import base64
import json
import math
import random
import re
import struct
import sys
import unittest
from fractions import Fraction
from math import isqrt
from pathlib import Path

sys.dont_write_bytecode = True
from exr import Exr
from program import ProgramTest

SOURCE = Path(sys.argv[2]).resolve()


def float32(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def exactly(vector):
    return [Fraction(x) for x in vector]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def sign(x):
    return (x > 0) - (x < 0)


def square_root(x):
    """Returns the square root of a fraction with an error far below the spacing of doubles."""
    shift = 600
    return Fraction(isqrt(x.numerator * x.denominator << 2 * shift), x.denominator << shift)


def asset(positions, triangles, material, translations=((0, 0, 0),)):
    """Returns a glTF asset with one mesh for each translation. The first mesh has the material, the others are opaque."""
    data = struct.pack(f"{3 * len(positions)}f", *sum(map(list, positions), []))
    data += struct.pack(f"{3 * len(triangles)}I", *sum(map(list, triangles), []))
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    size = 12 * len(positions)
    primitive = {"attributes": {"POSITION": 0}, "indices": 1}
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(translations)))}],
            "nodes": [{"name": f"mesh{i}", "mesh": min(i, 1), "translation": list(t)} for i, t in enumerate(translations)],
            "meshes": [{"primitives": [{**primitive, "material": 0}]}, {"primitives": [primitive]}][:len(translations)],
            "materials": [{"name": "first", **material}],
            "buffers": [{"uri": uri, "byteLength": len(data)}],
            "bufferViews": [{"buffer": 0, "byteLength": size}, {"buffer": 0, "byteOffset": size, "byteLength": len(data) - size}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": len(positions),
                           "min": list(map(min, zip(*positions))), "max": list(map(max, zip(*positions)))},
                          {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": 3 * len(triangles)}]}


def two_squares(material):
    """Returns the square from -1 to 1 in the plane z = 0, which faces +z, and an opaque one behind it."""
    return asset([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2), (0, 2, 3)], material, [(0, 0, 0), (0, 0, -1)])


class Explain(ProgramTest):
    def explain(self, scene, *options):
        result = self.run_program("explain", scene, "--json", "-q", *options)
        self.assertEqual((result.returncode, result.stderr), (0, b""))
        explanation = json.loads(result.stdout)
        self.check(explanation)
        return explanation

    def explain_ray(self, scene, o, d, *interval):
        return self.explain(scene, "--ray=" + ",".join(map(repr, [*o, *d, *interval])))

    def write(self, name, scene):
        (self.folder / name).write_text(json.dumps(scene))
        return name

    def scene_of(self, *objects):
        return self.write("scene.json", {"version": 1, "objects": list(objects)})

    def check(self, e):
        """Makes the checks that apply to every explanation."""
        self.assertEqual(e["version"], 1)
        self.assertEqual(e["hit_count"], len(e["hits"]))
        self.assertEqual(e["crossing_count"], len(e["crossings"]))
        order = [(hit["exact_t"], hit["id"]) for hit in e["hits"]]
        self.assertEqual(order, sorted(order))
        self.assertEqual(len({hit["id"] for hit in e["hits"]}), len(order))
        visible = [i for i, hit in enumerate(e["hits"]) if hit["verdict"] == "visible"]
        self.assertEqual(visible, [] if e["visible"] is None else [e["visible"]])
        low, high = (float(e["ray"][name]) for name in ("t_min", "t_max"))
        for hit in e["hits"]:
            self.assertEqual(float32(hit["exact_t"]), hit["t"])
            self.assertTrue(low <= hit["exact_t"] <= high)
            self.assertTrue(0 <= hit["alpha"]["coverage"] <= 1)
            self.assertEqual(hit["alpha"]["coverage"] == 0, hit["verdict"] in ("culled", "masked", "transparent"))
            if hit["numbers"].get("stretch"):
                continue  # the position of a triangle seen edge-on is on its longest edge
            at = [a + b + hit["t"] * c for a, b, c in zip(e["ray"]["scene_origin"], e["ray"]["origin"], e["ray"]["direction"])]
            for a, b in zip(at, hit["position"]):
                self.assertAlmostEqual(a, b, delta=1e-5 * (1 + abs(hit["t"]) + abs(a)))
            self.assertAlmostEqual(dot(hit["normal"], hit["normal"]), 1)
        for crossing in e["crossings"]:
            self.assertTrue(crossing["t"] <= low if crossing["place"] == "before" else crossing["t"] >= high)
        if e["misses"] is not None:
            met = {x["id"] for x in e["hits"] + e["crossings"]}
            missed = [miss["id"] for miss in e["misses"]]
            self.assertEqual(missed, sorted(set(range(e["primitives"])) - met))
        headings = {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
                    for heading in re.findall(r"(?m)^#+ (.*)$", (SOURCE / "docs/derivations.md").read_text())}
        items = e["hits"] + e["crossings"] + (e["misses"] or [])
        for item in items + ([e["pixel"]] if e["pixel"] else []):
            page, anchor = item["derivation"].split("#")
            self.assertEqual(page, "docs/derivations.md")
            self.assertIn(anchor, headings)

    # Pictures

    def test_all_primitives_count_toward_the_memory_limit(self):
        n = 20000
        scene = self.write("many.gltf", asset([(0, 0, 0), (1, 0, 0), (0, 1, 0)], n * [(0, 1, 2)], {}))
        options = ["explain", scene, "--ray=5,5,5,0,0,1", "--memory-limit", "20M"]
        self.assertEqual(self.run_program(*options).returncode, 0)
        result = self.run_program(*options, "--all")
        self.assertEqual(result.returncode, 6)
        self.assertIn(b"the explanation of all primitives: ", result.stderr)

    def test_pixels_equal_the_channels_of_pictures(self):
        seen = 0
        for scene, *options in (("perspective1.json",), ("orthographic.json",), ("environment.json",), ("ellipsoid.json",),
                                ("mesh.json",), ("calibrated.json", "-c", "2"), ("degenerate/inside_sphere.json",),
                                ("gltf/knot.glb",), ("gltf/textured.glb", "--view", "30,25"), ("gltf/far.glb",),
                                ("gltf/moving.glb", "--time", "0.3"), ("gltf/cube.glb", "--eye", "1,2,3", "--fov", "60")):
            with self.subTest(scene):
                path = SOURCE / "scenes" / scene
                result = self.run_program(path, "--aov", "depth,distance,normal,id", "--spp", "1", "--integrator", "flat",
                                          "--size", "20x15", "-q", "-o", "a.exr", *options)
                self.assertEqual(result.returncode, 0, result.stderr)
                channels = Exr(self.folder / "a.exr").channels
                for x, y in [(10, 7), *random.Random(scene).sample([(x, y) for x in range(20) for y in range(15)], 12)]:
                    seen += self.compare(self.explain(path, "--pixel", f"{x},{y}", "--size", "20x15", *options),
                                         {name: rows[y][x] for name, rows in channels.items()})
        self.assertGreater(seen, 60)

    def compare(self, e, channels):
        """Compares an explanation with the pixel's channels. Returns 1 if anything is visible."""
        if e["visible"] is None:
            self.assertEqual(channels["id.instance"], 0)
            self.assertEqual(channels["depth.Z"], math.inf)
            return 0
        hit = e["hits"][e["visible"]]
        self.assertEqual(hit["object"] + 1, channels["id.instance"])
        self.assertEqual(hit["primitive"] + 1, channels["id.primitive"])
        self.assertEqual(hit["material"]["index"] + 1 if hit["material"] else 0, channels["id.material"])
        self.assertEqual(float32(hit["depth"]), channels["depth.Z"])
        self.assertEqual(float32(hit["distance"]), channels["distance.T"])
        facing = 1 if hit["front"] else -1
        self.assertEqual([float32(facing * x) for x in hit["shading_normal"]], [channels[f"normal.{axis}"] for axis in "XYZ"])
        return 1

    def test_fractions_of_pixels(self):
        path = SOURCE / "scenes/perspective1.json"
        center, right = (self.explain(path, "--pixel", pixel) for pixel in ("320,240", "320.25,240"))
        self.assertEqual((center["pixel"]["x"], right["pixel"]["x"]), (320.5, 320.75))
        self.assertEqual(center["pixel"]["camera"], "camera1")
        d, e = center["ray"]["direction"], right["ray"]["direction"]
        # A pixel is 2 tan(30 degrees) / 480 wide at depth 1.
        self.assertAlmostEqual(e[0] / e[2] - d[0] / d[2], -0.25 * 2 * math.tan(math.pi / 6) / 480, places=6)

    # Numbers

    def random_ray(self, numbers):
        o = [float32(numbers.uniform(-3, 3)) for _ in range(3)]
        to = [numbers.uniform(-1, 1) for _ in range(3)]
        return o, [float32(b - a) for a, b in zip(o, to)]

    def all_items(self, e):
        return {item["name"]: item["numbers"] for item in e["hits"] + e["crossings"] + e["misses"]}

    def check_quadratic(self, numbers, a, b, c):
        self.assertEqual([numbers["a"], numbers["b"], numbers["c"]], [float(a), float(b), float(c)])
        discriminant = b * b - 4 * a * c
        self.assertEqual(numbers["discriminant"], float(discriminant))
        self.assertEqual(numbers["signs"], {"a": sign(a), "b": sign(b), "c": sign(c), "discriminant": sign(discriminant)})
        if a == 0:
            self.assertEqual(numbers["roots"], [float(-c / b)] if b else [])
        elif discriminant < 0:
            self.assertEqual(numbers["roots"], [])
        else:
            root = square_root(discriminant)
            roots = {(-b - root) / (2 * a), (-b + root) / (2 * a)}
            self.assertEqual(numbers["roots"], [float(x) for x in sorted(roots)])

    def check_plane(self, numbers, n, p, o, d):
        slope, height = dot(n, d), dot(n, minus(p, o))
        self.assertEqual((numbers["slope"], numbers["height"]), (float(slope), float(height)))
        self.assertEqual(numbers["signs"], {"slope": sign(slope), "height": sign(height)})
        self.assertEqual(numbers["t"], float(height / slope) if slope else None)
        return slope, height

    def test_numbers_are_exact_and_rounded_once(self):
        numbers = random.Random(1)
        center, radius = [0.1, -0.2, 0.3], 0.7
        coefficients = [1, 0.5, -0.25, 0.1, 0.2, -0.3, 0.4, 0.5, 0.6, -0.7]
        normal, a, b, c = [0.3, 1, -0.4], [-1, 0.1, 0.2], [1, -0.3, 0.4], [0.1, 0.9, -0.8]
        scene = self.scene_of({"name": "sphere", "type": "sphere", "center": center, "radius": radius},
                              {"name": "quadric", "type": "quadric", "coefficients": dict(zip("abcdefghij", coefficients))},
                              {"name": "plane", "type": "plane", "point": center, "normal": normal},
                              {"name": "disc", "type": "disc", "center": center, "normal": normal, "radius": radius},
                              {"name": "triangle", "type": "triangle", "a": a, "b": b, "c": c})
        center, normal, a, b, c = (exactly(map(float32, v)) for v in (center, normal, a, b, c))
        r, k = Fraction(float32(radius)), exactly(map(float32, coefficients))

        def form(p, q):
            """The symmetric form that is twice the quadric's terms of degree two if p = q."""
            return (2 * (k[0] * p[0] * q[0] + k[1] * p[1] * q[1] + k[2] * p[2] * q[2]) + k[3] * (p[0] * q[1] + p[1] * q[0]) +
                    k[4] * (p[0] * q[2] + p[2] * q[0]) + k[5] * (p[1] * q[2] + p[2] * q[1]))

        for _ in range(40):
            ray = self.random_ray(numbers)
            items = self.all_items(self.explain_ray(scene, *ray))
            self.assertEqual(len(items), 5)
            o, d = map(exactly, ray)
            m = minus(o, center)
            self.check_quadratic(items["sphere"], dot(d, d), 2 * dot(d, m), dot(m, m) - r * r)
            self.check_quadratic(items["quadric"], form(d, d) / 2, form(o, d) + dot(k[6:9], d),
                                 form(o, o) / 2 + dot(k[6:9], o) + k[9])
            self.check_plane(items["plane"], normal, center, o, d)
            slope, height = self.check_plane(items["disc"]["plane"], normal, center, o, d)
            at = [x + height / slope * y for x, y in zip(m, d)]
            self.assertEqual(items["disc"]["squared_distance"], float(dot(at, at)))
            self.assertEqual(items["disc"]["squared_radius"], float(r * r))
            self.assertEqual(items["disc"]["side"], sign(dot(at, at) - r * r))
            A, B, C = (minus(corner, o) for corner in (a, b, c))
            volumes = [dot(d, cross(*edge)) for edge in ((B, C), (C, A), (A, B))]
            self.assertEqual(items["triangle"]["volumes"], [float(v) for v in volumes])
            self.assertEqual(items["triangle"]["signs"], [sign(v) for v in volumes])
            slope, _ = self.check_plane(items["triangle"]["plane"], cross(minus(b, a), minus(c, a)), a, o, d)
            self.assertEqual(slope, sum(volumes))
            inside = min(map(sign, volumes)) >= 0 or max(map(sign, volumes)) <= 0
            self.assertEqual(items["triangle"]["place"] == "inside", inside)

    def test_tangent_rays(self):
        scene = self.scene_of({"name": "ball", "type": "sphere", "center": [0, 0, 0], "radius": 1})
        e = self.explain_ray(scene, [1.0, 0.0, 5.0], [0.0, 0.0, -1.0])
        hit, = e["hits"]
        self.assertEqual((hit["numbers"]["discriminant"], hit["numbers"]["roots"], hit["t"]), (0, [5], 5))
        self.assertEqual(hit["decided_by"], "dyadic")
        for x, count in ((1 - 2**-24, 1), (1 + 2**-23, 0)):
            e = self.explain_ray(scene, [x, 0.0, 5.0], [0.0, 0.0, -1.0])
            self.assertEqual(len(e["hits"]), count)
            numbers = (e["hits"] + e["misses"])[0]["numbers"]
            self.assertEqual(numbers["signs"]["discriminant"], 1 if count else -1)
        self.assertEqual(e["misses"][0]["reason"], "the discriminant is negative")

    def test_linear_and_constant_equations(self):
        scene = self.scene_of({"name": "cone", "type": "quadric", "coefficients": {"a": 1, "b": 1, "c": -1}},
                              {"name": "tube", "type": "quadric", "coefficients": {"a": 1, "b": 1, "j": -1}})
        items = self.all_items(self.explain_ray(scene, [1.0, 0.0, 3.0], [1.0, 0.0, 1.0]))
        self.check_quadratic(items["cone"], 0, -4, Fraction(-8))
        e = self.explain_ray(scene, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0])
        tube = next(hit for hit in e["hits"] if hit["name"] == "tube")
        self.assertEqual(tube["numbers"]["signs"], {"a": 0, "b": 0, "c": 0, "discriminant": 0})
        miss = self.explain_ray(scene, [2.0, 0.0, 1.0], [0.0, 0.0, 1.0])["misses"][0]
        self.assertEqual((miss["name"], miss["reason"]), ("tube", "a and b are 0, but c is not"))

    def test_numbers_beyond_float64_are_strings(self):
        # The crossing is at t = 1e152, at a distance of 1e190 from the center.
        scene = self.scene_of({"name": "disc", "type": "disc", "center": [0, 0, 0], "normal": [1e-38, 0, 1e38], "radius": 1})
        e = self.explain_ray(scene, [0.0, 0.0, -1e38], [1e-38, 1e38, 0.0])
        numbers = e["misses"][0]["numbers"]
        self.assertEqual((numbers["squared_distance"], float(numbers["squared_distance"])), ("Infinity", math.inf))
        self.assertAlmostEqual(numbers["plane"]["t"] / 1e152, 1, places=5)
        self.assertEqual(numbers["side"], 1)
        self.assertEqual(e["ray"]["t_max"], "Infinity")

    # Special positions

    def square(self):
        return self.write("square.gltf", asset([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)],
                                               {"doubleSided": True}))

    def test_edges_and_vertices(self):
        e = self.explain_ray(self.square(), [0.5, 0.5, 1.0], [0.0, 0.0, -1.0])
        self.assertEqual([hit["numbers"]["place"] for hit in e["hits"]], ["on edge ca", "on edge ab"])
        self.assertEqual([hit["verdict"] for hit in e["hits"]], ["visible", "hidden"])
        self.assertEqual([hit["order"] for hit in e["hits"]], ["first", "tie"])
        self.assertEqual({hit["decided_by"] for hit in e["hits"]}, {"grid"})
        e = self.explain_ray(self.square(), [0.0, 0.0, 1.0], [0.0, 0.0, -1.0])
        self.assertEqual([hit["numbers"]["place"] for hit in e["hits"]], ["on vertex a", "on vertex a"])
        e = self.explain_ray(self.square(), [1.0, 0.0, 1.0], [0.0, 0.0, -1.0])
        self.assertEqual([hit["numbers"]["place"] for hit in e["hits"]], ["on vertex b"])
        self.assertEqual(e["misses"][0]["numbers"]["place"], "outside of edge ab")
        self.assertEqual(e["misses"][0]["reason"], "the line passes outside of edge ab")
        e = self.explain_ray(self.square(), [0.75, 0.25, 1.0], [0.0, 0.0, -1.0])
        self.assertEqual(e["hits"][0]["barycentrics"], [0.25, 0.5, 0.25])
        self.assertEqual(e["hits"][0]["decided_by"], "float32")
        self.assertEqual(e["stages"], {"edges": 0, "filters": 0, "grid": 0, "dyadic": 0})

    def test_rays_in_planes(self):
        e = self.explain_ray(self.square(), [-1.0, 0.25, 0.0], [1.0, 0.0, 0.0])
        self.assertEqual([hit["numbers"]["stretch"] for hit in e["hits"]], [[1, 1.25], [1.25, 2]])
        self.assertEqual([hit["t"] for hit in e["hits"]], [1, 1.25])
        scene = self.scene_of({"name": "disc", "type": "disc", "center": [0, 0, 0], "normal": [0, 0, 2], "radius": 1})
        hit, = self.explain_ray(scene, [-3.0, 0.0, 0.0], [1.0, 0.0, 0.0])["hits"]
        self.assertEqual(hit["numbers"]["ball"]["roots"], [2, 4])
        miss, = self.explain_ray(scene, [-3.0, 2.0, 0.0], [1.0, 0.0, 0.0])["misses"]
        self.assertEqual(miss["reason"], "the line lies in the plane outside of the radius")
        miss, = self.explain_ray(scene, [-3.0, 0.0, 1.0], [1.0, 0.0, 0.0])["misses"]
        self.assertEqual(miss["reason"], "the ray is parallel to the plane")
        miss, = self.explain_ray(scene, [3.0, 0.0, 1.0], [0.0, 0.0, 1.0])["misses"]
        self.assertEqual(miss["reason"], "the line crosses the plane outside of the radius")

    def test_crossings_outside_of_the_interval(self):
        scene = self.scene_of(*({"name": name, "type": "sphere", "center": [0, 0, z], "radius": 1}
                                for name, z in (("behind", 5), ("around", 0), ("near", -5), ("middle", -10), ("far", -20))))
        e = self.explain_ray(scene, [0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 6.5, 15.0)
        self.assertEqual([(hit["name"], hit["t"]) for hit in e["hits"]], [("middle", 9)])
        self.assertEqual([(c["name"], c["place"], c["t"]) for c in e["crossings"]],
                         [("behind", "before", -4), ("around", "before", -1), ("around", "before", 1), ("near", "before", 4),
                          ("far", "beyond", 19)])
        e = self.explain_ray(scene, [0.0, 0.0, -4.0], [0.0, 0.0, -1.0])
        self.assertEqual([hit["t"] for hit in e["hits"]], [2, 5, 15])  # leaves the sphere that it starts on
        # A hit at an end of the closed interval is not listed as a crossing too.
        e = self.explain_ray(scene, [0.0, 0.0, 0.0], [0.0, 0.0, -1.0], 11.0, 19.0)
        self.assertEqual([(hit["name"], hit["t"]) for hit in e["hits"]], [("middle", 11), ("far", 19)])
        self.assertNotIn("far", {c["name"] for c in e["crossings"]})

    # Visibility

    def verdicts(self, material, z=1.0):
        scene = self.write("quad.gltf", two_squares(material))
        e = self.explain_ray(scene, [0.5, 0.25, z], [0.0, 0.0, -z])
        return {re.match(r"mesh\d", hit["name"])[0]: hit for hit in e["hits"]}

    def test_alpha_and_sides(self):
        def color(alpha):
            return {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, alpha]}, "doubleSided": True}
        hits = self.verdicts({"alphaMode": "MASK", "alphaCutoff": 0.5, **color(0.25)})
        near = hits["mesh0"]
        self.assertEqual((near["verdict"], hits["mesh1"]["verdict"]), ("masked", "visible"))
        self.assertEqual(near["alpha"], {"mode": "mask", "value": 0.25, "cutoff": 0.5, "coverage": 0, "weight": 0})
        self.assertEqual(near["material"], {"index": 0, "name": "first"})
        hits = self.verdicts({"alphaMode": "MASK", "alphaCutoff": 0.25, **color(0.25)})
        self.assertEqual((hits["mesh0"]["verdict"], hits["mesh1"]["verdict"]), ("visible", "hidden"))
        hits = self.verdicts({"alphaMode": "BLEND", **color(0.25)})
        self.assertEqual((hits["mesh0"]["verdict"], hits["mesh1"]["verdict"]), ("visible", "seen_through"))
        self.assertEqual((hits["mesh0"]["alpha"]["coverage"], hits["mesh0"]["alpha"]["weight"]), (0.25, 0.25))
        self.assertEqual((hits["mesh1"]["alpha"]["coverage"], hits["mesh1"]["alpha"]["weight"]), (1, 0.75))
        hits = self.verdicts({"alphaMode": "BLEND", **color(0)})
        self.assertEqual((hits["mesh0"]["verdict"], hits["mesh1"]["verdict"]), ("transparent", "visible"))
        hits = self.verdicts({**color(0.25)})
        self.assertEqual((hits["mesh0"]["verdict"], hits["mesh0"]["alpha"]["coverage"]), ("visible", 1))

    def test_rays_far_from_the_origin_are_read_in_float64(self):
        scene = SOURCE / "scenes/gltf/far.glb"
        ray = self.explain(scene, "--ray=4510731.3,4510732.1,3004.7,0,0,-1")["ray"]
        for given, origin, part in zip((4510731.3, 4510732.1, 3004.7), ray["scene_origin"], ray["origin"]):
            self.assertLess(abs(origin + part - given), 1e-6)

    def test_culled_backs(self):
        scene = self.write("quad.gltf", two_squares({}))
        e = self.explain_ray(scene, [0.5, 0.25, -3.0], [0.0, 0.0, 1.0])
        self.assertEqual([hit["verdict"] for hit in e["hits"]], ["culled", "culled"])
        self.assertEqual([hit["front"] for hit in e["hits"]], [False, False])
        self.assertIsNone(e["visible"])
        self.assertEqual([hit["verdict"] for hit in self.explain_ray(scene, [0.5, 0.25, 3.0], [0.0, 0.0, -1.0])["hits"]],
                         ["visible", "hidden"])

    def test_blended_surfaces_count_once_on_a_common_edge(self):
        scene = self.write("quad.gltf", two_squares({"alphaMode": "BLEND", "doubleSided": True,
                                                   "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5]}}))
        e = self.explain_ray(scene, [0.5, 0.5, 1.0], [0.0, 0.0, -1.0])
        self.assertEqual([hit["verdict"] for hit in e["hits"]], ["visible", "repeated", "seen_through", "hidden"])
        self.assertEqual([hit["alpha"]["weight"] for hit in e["hits"]], [0.5, 0, 0.5, 0])

    # Bounds and errors

    def test_nothing_to_see(self):
        e = self.explain_ray(self.write("empty.gltf", {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{}]}), [0.0, 0.0, 0.0], [1.0, 0.0, 0.0])
        self.assertEqual((e["primitives"], e["hits"], e["crossings"], e["misses"]), (0, [], [], []))
        e = self.explain_ray(self.square(), [5.0, 5.0, 5.0], [1.0, 0.0, 0.5])
        self.assertEqual((e["hits"], e["visible"], len(e["misses"])), ([], None, 2))
        # Pixels beyond the distortion's range have no ray.
        e = self.explain(SOURCE / "scenes/calibrated.json", "-c", "2", "--size", "60x45", "--pixel", "0,0")
        self.assertEqual((e["ray"]["valid"], e["hits"]), (False, []))

    def test_misses_of_large_scenes(self):
        knot = SOURCE / "scenes/gltf/knot.glb"
        ray = [[0.0, 0.0, 1e6], [0.0, 0.0, 1.0]]
        self.assertIsNone(self.explain_ray(knot, *ray)["misses"])
        e = self.explain(knot, "--all", "--ray=" + ",".join(map(repr, ray[0] + ray[1])))
        self.assertEqual(len(e["misses"]) + len({c["id"] for c in e["crossings"]}), e["primitives"])
        self.assertGreater(e["primitives"], 64)

    def test_limit_of_hits(self):
        count = 1100
        scene = self.write("stack.gltf", asset([p for z in range(count) for p in ((-1, -1, -z), (1, -1, -z), (0, 1, -z))],
                                               [(3 * z, 3 * z + 1, 3 * z + 2) for z in range(count)], {"doubleSided": True}))
        result = self.run_program("explain", scene, "--ray=0,0,9,0,0,-1", "--json")
        e = json.loads(result.stdout)
        self.assertEqual((e["hit_count"], len(e["hits"]), e["visible"]), (count, 1000, 0))
        self.assertEqual(len(self.explain(scene, "--all", "--ray=0,0,9,0,0,-1")["hits"]), count)
        text = self.run_program("explain", scene, "--ray=0,0,9,0,0,-1").stdout.decode()
        self.assertIn("1100 hits", text)
        self.assertIn("the first 1000", text)

    def test_text(self):
        path = SOURCE / "scenes/perspective1.json"
        result = self.run_program("explain", path, "--pixel", "200,150")
        self.assertEqual((result.returncode, result.stderr), (0, b""))
        text = result.stdout.decode()
        e = self.explain(path, "--pixel", "200,150")
        for item in e["hits"] + e["misses"]:
            self.assertIn(f'"{item["name"]}"', text)
            self.assertIn(item["derivation"], text)
        self.assertLessEqual(max(map(len, text.splitlines())), 130)
        balls = [{"type": "sphere", "center": [0, 0, z], "radius": 1} for z in (0, 4)]
        for ray, count, heading in [("9,9,9,0,0,1", 1, "No hits among 1 primitive"), ("0,0,0,0,0,1", 1, "1 hit among 1 primitive:"),
                                    ("0,0,9,0,0,-1", 2, "2 hits among 2 primitives, nearest first:")]:
            scene = self.scene_of(*balls[:count])
            self.assertIn(f"\n\n{heading}\n", self.run_program("explain", scene, "--ray=" + ray).stdout.decode())
        # Names can't control the terminal.
        scene = self.scene_of({"name": "\x1b[2J", "type": "sphere", "center": [0, 0, 0], "radius": 1})
        text = self.run_program("explain", scene, "--ray=0,0,5,0,0,-1").stdout
        self.assertNotIn(b"\x1b", text)
        self.assertIn(rb"\x1b", text)

    def test_usage_errors(self):
        scene = SOURCE / "scenes/perspective1.json"
        ray = "--ray=0,0,9,0,0,-1"
        for options, message in (
                ([], "explain needs --pixel or --ray"),
                (["--pixel", "1,2", ray], "--pixel can't be combined with --ray"),
                ([ray, "--size", "20x15"], "can't be combined"),
                ([ray, "--view", "front"], "can't be combined"),
                (["--pixel", "640,0"], "--pixel: must be within the picture, from 0,0 to 639,479"),
                (["--pixel", "0,480"], "within the picture"),
                (["--pixel=-1,0"], "within the picture"),
                (["--pixel", "99999999999999999999,0"], "within the picture"),
                (["--pixel", "1e308,0"], "within the picture"),
                (["--pixel", "1e999,0"], "expects two numbers"),
                (["--pixel", "nan,0"], "expects two numbers"),
                (["--pixel", "inf,0"], "expects two numbers"),
                (["--pixel", "1"], "expects two numbers"),
                (["--pixel", "1,2,3"], "expects two numbers"),
                (["--pixel", "1,2x"], "expects two numbers"),
                (["--pixel", ""], "expects a value"),
                (["--ray", "0,0,0,0,0,0"], "the direction must not be 0"),
                (["--ray=0,0,0,0,-0,0"], "the direction must not be 0"),
                (["--ray", "0,0,0,nan,0,1"], "only t_max may be inf"),
                (["--ray", "inf,0,0,0,0,1"], "only t_max may be inf"),
                (["--ray", "1e39,0,0,0,0,1"], "only t_max may be inf"),
                (["--ray", "0,0,0,0,0,1,inf,inf"], "only t_max may be inf"),
                (["--ray", "0,0,0,0,0,1,0,nan"], "only t_max may be inf"),
                (["--ray", "0,0,0,0,0"], "expects six numbers"),
                (["--ray", "0,0,0,0,0,1,2"], "expects six numbers"),
                (["--ray", ",".join(["1"] * 10000)], "expects six numbers"),
                (["--ray", "0,0,0,0,0,1,2,1"], "0 <= t_min <= t_max"),
                (["--ray", "0,0,0,0,0,1,-1,1"], "0 <= t_min <= t_max"),
                (["--pixel", "1,2", "-c", "nobody"], 'there is no camera "nobody"'),
                (["--pixel", "1,2", "--fov", "40"], "--fov requires"),
                (["--pixel", "1,2", "--spp", "4"], "unknown option --spp")):
            with self.subTest(options=str(options)[:60]):
                result = self.run_program("explain", scene, *options)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(message, result.stderr.decode())
                self.assertEqual(result.stdout, b"")

    def test_other_errors(self):
        self.assertEqual(self.run_program("explain", "missing.json", "--pixel", "0,0").returncode, 5)
        (self.folder / "bad.json").write_text('{"version": 1, "objects": [')
        self.assertEqual(self.run_program("explain", "bad.json", "--pixel", "0,0").returncode, 3)
        with open("/dev/full", "w") as full:
            import subprocess
            from program import PROGRAM
            result = subprocess.run([PROGRAM, "explain", str(SOURCE / "scenes/perspective1.json"), "--pixel", "0,0"], stdout=full,
                                    stderr=subprocess.PIPE)
        self.assertEqual(result.returncode, 5, result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
