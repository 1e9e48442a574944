"""Tests the page of `microtrace view` in Chromium.

usage: page_test.py PROGRAM SOURCE_FOLDER [unittest options]

MICROTRACE_TURNS=SECONDS turns the camera for that time and checks that memory doesn't grow (default: 5 s).
MICROTRACE_SCREENSHOTS=FOLDER keeps screenshots.
"""

import base64
import json
import math
import os
import random
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from playwright.sync_api import sync_playwright
from viewer import Viewer, wait_until

PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), Path(sys.argv[2]).absolute()
SCENES = SOURCE / "scenes"
TURNS = float(os.environ.get("MICROTRACE_TURNS", "5"))
SCREENSHOTS = os.environ.get("MICROTRACE_SCREENSHOTS")
# The policy of the page forbids scripts as text, so that functions are passed.
PIXELS = """canvas => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let text = "";
  for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
  return btoa(text);
}"""


def write_two_animations(source, path):
    """Writes the asset with another animation, "Second", which has only one channel of the first one."""
    def add(asset):
        first = asset["animations"][0]
        asset["animations"].append({**first, "name": "Second", "channels": first["channels"][:1]})

    write_changed(source, path, add)


def write_variants(source, path):
    """Writes the asset with the variants "Red" and "Green", which change the color of its meshes."""
    def add(asset):
        extension = "KHR_materials_variants"
        asset["extensionsUsed"] = [*asset.get("extensionsUsed", []), extension]
        asset.setdefault("extensions", {})[extension] = {"variants": [{"name": "Red"}, {"name": "Green"}]}
        first = len(asset.setdefault("materials", []))
        asset["materials"] += [{"pbrMetallicRoughness": {"baseColorFactor": [*color, 1]}} for color in ((1, 0, 0), (0, 1, 0))]
        for mesh in asset["meshes"]:
            for primitive in mesh["primitives"]:
                primitive.setdefault("extensions", {})[extension] = {"mappings": [{"material": first + i, "variants": [i]} for i in (0, 1)]}

    write_changed(source, path, add)


def write_changed(source, path, change):
    """Writes a copy of a .glb file after change(asset) has changed its JSON."""
    data = source.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    asset = json.loads(data[20:20 + length])
    change(asset)
    text = json.dumps(asset).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length:]
    path.write_bytes(struct.pack("<4s2I", b"glTF", 2, 20 + len(text) + len(rest)) + struct.pack("<I4s", len(text), b"JSON") + text + rest)


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        playwright = sync_playwright().start()
        cls.addClassCleanup(playwright.stop)
        path = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
        # Containers run as root, for which Chromium has no sandbox.
        cls.browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        cls.addClassCleanup(cls.browser.close)

    def setUp(self):
        self.complaints = []
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def viewer(self, *arguments):
        viewer = Viewer(PROGRAM, *arguments)
        self.addCleanup(viewer.__exit__)
        return viewer

    def open(self, viewer, width=1280, height=900, **options):
        context = self.browser.new_context(viewport={"width": width, "height": height}, **options)
        self.addCleanup(context.close)
        page = context.new_page()
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("request", lambda request: self.complaints.append(request.url)
                if not request.url.startswith((viewer.address, "data:", "blob:")) else None)
        page.goto(viewer.address)
        self.wait_done(page)
        return page

    def wait_done(self, page, state="done"):
        page.wait_for_selector(f"body[data-state={state}]", timeout=60000)

    def change(self, page, action):
        """Carries out an action and waits until the picture that it requests is done."""
        before = int(page.get_attribute("body", "data-request"))
        action()
        wait_until(lambda: int(page.get_attribute("body", "data-request")) > before
                   and page.get_attribute("body", "data-state") == "done", 60)

    def keep(self, page, name):
        if SCREENSHOTS:
            page.screenshot(path=f"{SCREENSHOTS}/{name}.png")

    def words(self, page):
        """The words of the command line that the page shows, after the scene's name."""
        return shlex.split(page.inner_text("#command"))[2:]

    def drawn_by_program(self, scene, words):
        """Returns width, height and the samples of the picture, three a pixel."""
        result = subprocess.run([PROGRAM, scene, *words, "-o", "-", "-q"], capture_output=True)
        self.assertEqual(result.returncode, 0, result.stderr)
        _, size, _, samples = result.stdout.split(b"\n", 3)
        return (*map(int, size.split()), samples)

    def shown(self, page, canvas="#picture"):
        """Returns the samples of an opaque picture on the page, three a pixel."""
        samples = bytearray(base64.b64decode(page.eval_on_selector(canvas, PIXELS)))
        self.assertEqual(set(samples[3::4]), {255})
        del samples[3::4]
        return bytes(samples)

    def assert_shows(self, page, scene, canvas="#picture"):
        """The canvas has the pixels of the picture that the command line draws."""
        width, height, expected = self.drawn_by_program(scene, self.words(page))
        shown = self.shown(page, canvas)
        self.assertEqual(len(shown), 3 * width * height)
        self.assertTrue(shown == expected, self.words(page))

    def tearDown(self):
        self.assertEqual(self.complaints, [])

    def test_opens_and_turns(self):
        scene = SCENES / "perspective1.json"
        page = self.open(self.viewer(scene))
        self.assert_shows(page, scene)
        self.keep(page, "opened")
        box = page.locator("#picture").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

        def drag(dx, dy, shift=False):
            def action():
                if shift:
                    page.keyboard.down("Shift")
                page.mouse.move(x, y)
                page.mouse.down()
                for step in range(1, 6):
                    page.mouse.move(x + dx * step / 5, y + dy * step / 5)
                page.mouse.up()
                if shift:
                    page.keyboard.up("Shift")
            self.change(page, action)

        eyes = [None]
        for action in (lambda: drag(120, 40), lambda: drag(60, -80, shift=True),
                       lambda: self.change(page, lambda: page.mouse.wheel(0, 300)),
                       lambda: self.change(page, lambda: page.keyboard.press("ArrowLeft")),
                       lambda: self.change(page, lambda: page.keyboard.press("Shift+ArrowUp")),
                       lambda: self.change(page, lambda: page.keyboard.press("+"))):
            action()
            page.wait_for_timeout(300)  # the wheel ends 150 ms after its last step
            self.wait_done(page)
            words = self.words(page)
            self.assertEqual(words[::2][:2], ["--eye", "--target"])
            self.assertNotEqual(words[1], eyes[-1])
            eyes.append(words[1])
            self.assert_shows(page, scene)
        self.keep(page, "turned")
        self.change(page, lambda: page.keyboard.press("f"))
        self.assertEqual(self.words(page), [])
        self.assert_shows(page, scene)
        # Turning there and back again leads to the first picture.
        self.change(page, lambda: page.keyboard.press("ArrowRight"))
        self.change(page, lambda: page.keyboard.press("ArrowLeft"))
        eye = [float(number) for number in self.words(page)[1].split(",")]
        for number, expected in zip(eye, (0, 0, 10), strict=True):
            self.assertAlmostEqual(number, expected, 5)

    def test_pictures_fit_the_window(self):
        for size, window in (("300x900", (1280, 700)), ("900x300", (1280, 700)), ("640x480", (1000, 400)), ("300x900", (390, 800))):
            with self.subTest(size=size, window=window):
                page = self.open(self.viewer(SCENES / "sphere.json", "--size", size), *window)
                page.click("#compare")
                wait_until(lambda page=page: "equal" in page.inner_text("#difference-text"))
                stage, picture = (page.locator(name).bounding_box() for name in ("#stage", "#picture"))
                self.assertLessEqual(stage["y"] + stage["height"], window[1])
                for place, length in (("x", "width"), ("y", "height")):
                    self.assertGreaterEqual(picture[place], stage[place] - 1)
                    self.assertLessEqual(picture[place] + picture[length], stage[place] + stage[length] + 1)
                width, height = map(int, size.split("x"))
                self.assertAlmostEqual(picture["width"] / picture["height"], width / height, delta=0.02)
                self.assertLessEqual(page.evaluate("() => document.documentElement.scrollWidth"), window[0])
                self.keep(page, f"window-{window[0]}x{window[1]}-{size}")

    def test_marker_and_wiper_follow_the_window(self):
        page = self.open(self.viewer(SCENES / "sphere.json", "--size", "64x48"))
        page.click("#compare")
        wait_until(lambda: "equal" in page.inner_text("#difference-text"))
        page.fill("#x", "40")
        page.press("#x", "Enter")
        wait_until(lambda: "pixel\t40, 0" in page.inner_text("#explanation"))
        for window in ((1280, 900), (1000, 300), (600, 900)):
            page.set_viewport_size({"width": window[0], "height": window[1]})
            page.wait_for_timeout(100)
            picture, line, marker = (page.locator(name).bounding_box() for name in ("#picture", "#wiper-line", "#marker"))
            self.assertAlmostEqual(line["x"], picture["x"] + picture["width"] / 2, delta=2)
            self.assertAlmostEqual(line["height"], picture["height"], delta=2)
            self.assertAlmostEqual(marker["x"] + marker["width"] / 2, picture["x"] + 40.5 / 64 * picture["width"], delta=2)

    def test_held_keys_show_pictures(self):
        page = self.open(self.viewer(SCENES / "gltf/knot.glb", "--size", "320x240", "--spp", "64"))
        shown = []
        page.on("response", lambda response: shown.append(response.url) if "pictures/" in response.url
                and response.request.method == "GET" and response.status == 200 else None)
        page.focus("#stage")
        for _ in range(40):
            page.keyboard.down("ArrowLeft")  # repeats while it is down
            page.wait_for_timeout(30)
        page.keyboard.up("ArrowLeft")
        self.assertGreater(len(shown), 8)
        page.wait_for_timeout(300)
        self.wait_done(page)
        self.assert_shows(page, SCENES / "gltf/knot.glb")

    def test_two_fingers_zoom_and_shift(self):
        scene = SCENES / "perspective1.json"
        page = self.open(self.viewer(scene, "--size", "64x48"), has_touch=True)
        touch = page.context.new_cdp_session(page)
        box = page.locator("#picture").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

        def send(kind, *places):
            points = [{"x": x + dx, "y": y + dy, "id": i} for i, (dx, dy) in enumerate(places)]
            touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        def spread():
            send("touchStart", (-50, 0))
            send("touchStart", (-50, 0), (50, 0))
            for step in range(1, 11):
                send("touchMove", (-50 - 5 * step, 0), (50 + 5 * step, 0))
            send("touchEnd")

        self.change(page, spread)
        self.wait_done(page)
        words = self.words(page)
        eye, target = ([float(number) for number in words[words.index(name) + 1].split(",")] for name in ("--eye", "--target"))
        # The camera at z = 10 turns about the scene's center, which is at z = -0.4. Twice the distance of the fingers is half
        # the distance from the center. The fingers move one after the other, which shifts the camera to and fro.
        for number, expected in zip(eye + target, (0, 0, 4.8, 0, 0, -0.4), strict=True):
            self.assertAlmostEqual(number, expected, delta=0.02)
        self.assert_shows(page, scene)

    def test_camera_far_from_the_origin(self):
        scene = SCENES / "gltf/far.glb"
        page = self.open(self.viewer(scene, "--size", "60x40", "--spp", "1"))
        page.focus("#stage")
        distances = []
        for key in ("ArrowLeft", "ArrowUp", "Shift+ArrowRight"):
            self.change(page, lambda key=key: page.keyboard.press(key))
            words = self.words(page)
            eye, target = ([float(number) for number in words[words.index(name) + 1].split(",")] for name in ("--eye", "--target"))
            self.assertGreater(math.hypot(*target), 1e6)
            distances.append(math.dist(eye, target))
            self.assert_shows(page, scene)
        for distance in distances:
            self.assertAlmostEqual(distance / distances[0], 1, 6)

    def test_controls(self):
        scene = SCENES / "gltf/materials.glb"
        page = self.open(self.viewer(scene, "--size", "80x60", "--spp", "4"))
        self.assertEqual(self.words(page), ["--size", "80x60", "--spp", "4"])
        self.assert_shows(page, scene)
        for selector, value in (("#spp", "6"), ("[data-option='--env']", "#80a0ff"), ("[data-option='--background']", "env"),
                                ("[data-option='--env-intensity']", "2"), ("[data-option='--max-depth']", "3"), ("#width", "90")):
            def fill(selector=selector, value=value):
                page.fill(selector, value)
                page.press(selector, "Enter")
                page.locator(selector).blur()
            self.change(page, fill)
            self.assertIn(value, " ".join(self.words(page)))
            self.assert_shows(page, scene)
        for selector, value in (("[data-option='--exposure']", "1.5"), ("[data-option='--env-rotation']", "-40")):
            self.change(page, lambda selector=selector, value=value: page.locator(selector).fill(value))
            self.wait_done(page)
            self.assert_shows(page, scene)
        for selector, value in (("#tonemap", "agx"), ("#camera", "--view top")):
            self.change(page, lambda selector=selector, value=value: page.select_option(selector, value))
            self.assert_shows(page, scene)
        self.change(page, lambda: page.fill("[data-option='--background']", "") or page.locator("[data-option='--background']").blur())
        for name in ("flat", "depth", "normal", "uv", "id", "albedo", "variance"):
            self.change(page, lambda name=name: page.select_option("#integrator", name))
            if name == "variance":
                self.assertIn("--aov variance", " ".join(self.words(page)))
                # The default format has no channels.
                self.assertEqual(self.words(page)[-2:], ["-o", "materials.exr"])
                command = shlex.split(page.inner_text("#command"))
                subprocess.run([PROGRAM, *command[1:], "-q"], check=True, cwd=self.folder)
                self.assertTrue((self.folder / "materials.exr").exists())
            else:
                self.assert_shows(page, scene)

    def test_controls_show_what_applies(self):
        scene = SCENES / "sky.json"
        page = self.open(self.viewer(scene, "--size", "64x48", "--spp", "1", "--integrator", "path", "--bsdf", "conserving", "--view", "30,25"))
        rotation = "[data-option='--env-rotation']"
        self.assertEqual(page.input_value("[data-option='--bsdf']"), "conserving")
        self.assertEqual(page.input_value("#camera"), "--view 30,25")
        self.assertEqual(page.input_value(rotation), "20")  # the scene's own
        self.change(page, lambda: page.locator(rotation).fill("0"))
        self.wait_done(page)
        self.assertIn("--env-rotation 0", " ".join(self.words(page)))
        self.assert_shows(page, scene)
        page = self.open(self.viewer(scene, "--size", "64x48", "--spp", "1", "--env-rotation", "200", "--exposure", "20"))
        self.assertEqual(page.input_value(rotation), "200")
        self.assertEqual(page.input_value("[data-option='--exposure']"), "20")
        # Without both lengths, the size is that of the scene, also in the fields.
        self.change(page, lambda: page.fill("#width", "") or page.locator("#width").blur())
        self.assertNotIn("--size", self.words(page))
        self.assertEqual([page.input_value("#width"), page.input_value("#height")], page.inner_text("#status").split(",")[0].split(" x "))

    def test_channels_return_after_the_variance(self):
        page = self.open(self.viewer(SCENES / "gltf/cube.glb", "--aov", "depth,variance", "--size", "64x48", "--spp", "2"))
        for name, expected in (("normal", None), ("path", "depth,variance"), ("variance", "variance"), ("path", "depth,variance")):
            self.change(page, lambda name=name: page.select_option("#integrator", name))
            words = self.words(page)
            if expected is not None:
                self.assertEqual(words[words.index("--aov") + 1], expected)

    def test_only_the_last_question_is_answered(self):
        page = self.open(self.viewer(SCENES / "perspective1.json", "--size", "64x48"))
        waiting = []
        page.route("**/explanation?*", lambda route: waiting.append(route))
        for x in ("10", "20"):
            page.fill("#x", x)
            page.press("#x", "Enter")
        wait_until(lambda: page.wait_for_timeout(20) or len(waiting) == 2)
        waiting[1].continue_()
        wait_until(lambda: "pixel\t20, 0" in page.inner_text("#explanation"))
        waiting[0].continue_()
        page.wait_for_timeout(300)
        self.assertIn("pixel\t20, 0", page.inner_text("#explanation"))

    def test_options_that_a_quantity_cannot_apply(self):
        scene = SCENES / "gltf/materials.glb"
        page = self.open(self.viewer(scene, "--size", "80x60", "--spp", "4", "--bsdf", "spec"))
        self.assertEqual(self.words(page), ["--size", "80x60", "--spp", "4", "--bsdf", "spec"])
        self.change(page, lambda: page.select_option("#integrator", "depth"))
        self.assertIn(", without --bsdf, --spp", page.inner_text("#status"))
        self.assertEqual(self.words(page), ["--size", "80x60", "--integrator", "depth"])
        self.assert_shows(page, scene)
        # The options are back when they apply again.
        self.change(page, lambda: page.select_option("#integrator", "path"))
        self.assertNotIn("without", page.inner_text("#status"))
        self.assertEqual(self.words(page), ["--size", "80x60", "--spp", "4", "--bsdf", "spec", "--integrator", "path"])
        self.assert_shows(page, scene)

    def test_the_command_line_has_the_options_of_the_awaited_picture(self):
        page = self.open(self.viewer(SCENES / "gltf/materials.glb", "--size", "80x60", "--spp", "4", "--bsdf", "spec"))
        self.change(page, lambda: page.select_option("#integrator", "depth"))
        requests = []
        page.route("**/pictures/*", lambda route: requests.append(route) if route.request.method == "PUT" else route.continue_())
        page.select_option("#integrator", "path")
        wait_until(lambda: page.inner_text("#command") and requests, 60)  # reading the text lets the page send the request
        self.assertEqual(self.words(page), ["--size", "80x60", "--spp", "4", "--bsdf", "spec", "--integrator", "path"])
        self.change(page, requests[0].continue_)
        self.assertEqual(self.words(page), ["--size", "80x60", "--spp", "4", "--bsdf", "spec", "--integrator", "path"])

    def test_warning_about_the_ground(self):
        scene = self.folder / "planes.json"
        scene.write_text('{"version": 1, "objects": [{"type": "plane", "point": [0, -1, 0], "normal": [0, 1, 0]}]}')
        page = self.open(self.viewer(scene, "--size", "16x16", "--integrator", "path", "--spp", "1"))
        self.assertFalse(page.is_visible("#warnings-section"))
        self.change(page, lambda: page.check("[data-option='--ground']"))
        self.assertIn("no lowest point for --ground", page.inner_text("#warnings"))
        self.change(page, lambda: page.uncheck("[data-option='--ground']"))
        self.assertFalse(page.is_visible("#warnings-section"))

    def test_animation(self):
        scene = SCENES / "gltf/moving.glb"
        page = self.open(self.viewer(scene, "--size", "80x60", "--spp", "2"))
        self.assertTrue(page.is_visible("#animation-section"))
        self.change(page, lambda: page.locator("#time").fill("0.5"))
        self.wait_done(page)
        self.assertIn("--time 0.5", " ".join(self.words(page)))
        self.assert_shows(page, scene)
        page.click("#play")
        page.wait_for_timeout(1000)
        page.click("#play")
        page.wait_for_timeout(300)
        self.wait_done(page)
        self.assert_shows(page, scene)
        # "none" ends playing.
        page.click("#play")
        page.select_option("#animation", "")
        page.wait_for_timeout(300)
        self.wait_done(page)
        self.assertNotIn("--time", self.words(page))
        self.assertEqual(page.inner_text("#play"), "Play")

    def test_scenes_without_animation_are_not_played(self):
        page = self.open(self.viewer(SCENES / "sphere.json", "--size", "64x48"))
        request = page.get_attribute("body", "data-request")
        page.focus("#stage")
        page.keyboard.press("p")
        page.wait_for_timeout(300)
        self.assertEqual(page.get_attribute("body", "data-request"), request)
        self.assertEqual(page.get_attribute("body", "data-state"), "done")

    def test_cameras_are_selected_by_name(self):
        page = self.open(self.viewer(SCENES / "perspective1.json", "--size", "60x40", "--camera", "camera1"))
        self.assertEqual(page.input_value("#camera"), "--camera 0")
        self.assertEqual(self.words(page), ["--size", "60x40", "--camera", "camera1"])

    def test_variants_are_selected_by_name_and_index(self):
        scene = self.folder / "variants.glb"
        write_variants(SCENES / "gltf/cube.glb", scene)
        for given, shown in (("Green", "Green"), ("0", "Red"), (None, "as in the file")):
            with self.subTest(given=given):
                words = ["--size", "60x40", "--spp", "1", *(["--variant", given] if given else [])]
                page = self.open(self.viewer(scene, *words))
                self.assertEqual(page.eval_on_selector("#variant", "e => e.selectedOptions[0].text"), shown)
                self.assert_shows(page, scene)
                self.change(page, lambda page=page: page.select_option("#variant", label="Green" if shown == "Red" else "Red"))
                self.assertIn("--variant 1" if shown == "Red" else "--variant 0", " ".join(self.words(page)))
                self.assert_shows(page, scene)

    def test_animations_are_selected_by_name(self):
        scene = self.folder / "two.glb"
        write_two_animations(SCENES / "gltf/moving.glb", scene)
        for given, shown in (("Second", "Second"), ("1", "Second"), ("all", "all")):
            with self.subTest(given=given):
                page = self.open(self.viewer(scene, "--size", "60x40", "--spp", "1", "--animation", given, "--time", "0.25"))
                self.assertEqual(page.eval_on_selector("#animation", "e => e.selectedOptions[0].text"), shown)
                self.change(page, lambda page=page: page.locator("#time").fill("0.5"))
                self.wait_done(page)
                self.assertIn(f"--time 0.5 --animation {given}", " ".join(self.words(page)))
                self.assert_shows(page, scene)
                self.change(page, lambda page=page: page.select_option("#animation", "1"))
                self.assertIn("--time 0 --animation 1", " ".join(self.words(page)))
                self.change(page, lambda page=page: page.select_option("#animation", ""))
                self.assertNotIn("--animation", self.words(page))
                self.assertNotIn("--time", self.words(page))

    def test_pixels_are_explained_as_by_the_program(self):
        for name in ("perspective1.json", "gltf/textures.glb"):
            scene = SCENES / name
            page = self.open(self.viewer(scene, "--spp", "1"))
            choices = random.Random(name)
            for _ in range(6):
                x, y = choices.randrange(640), choices.randrange(480)
                expected = json.loads(subprocess.run([PROGRAM, "explain", scene, "--pixel", f"{x},{y}", "--json"], capture_output=True).stdout)
                box = page.locator("#picture").bounding_box()
                page.mouse.click(box["x"] + (x + 0.5) * box["width"] / 640, box["y"] + (y + 0.5) * box["height"] / 480)
                pixel = f"pixel\t{x}, {y}"
                wait_until(lambda pixel=pixel: pixel in page.inner_text("#explanation"))
                hits = page.locator("#explanation details[data-t]")
                shown = [(float(hit.get_attribute("data-t")), hit.get_attribute("data-verdict")) for hit in hits.all()]
                self.assertEqual(shown, [(hit["t"], hit["verdict"]) for hit in expected["hits"]])
                if expected["visible"] is not None:
                    self.assertIn(f"Hit {expected['visible'] + 1} is visible.", page.inner_text("#explanation"))
            # The same by the keyboard alone.
            page.fill("#x", "320")
            page.fill("#y", "240")
            page.press("#y", "Enter")
            wait_until(lambda page=page: "pixel\t320, 240" in page.inner_text("#explanation"))
            self.keep(page, f"explained-{scene.stem}")

    def test_crop(self):
        scene = SCENES / "perspective1.json"
        page = self.open(self.viewer(scene, "--size", "80x60", "--crop", "20,10,40,20"))
        self.assertIn("20 x 10", page.inner_text("#status"))
        self.assert_shows(page, scene)
        box = page.locator("#picture").bounding_box()
        for x, y in ((20, 10), (33, 14), (39, 19)):
            place = (box["x"] + (x - 20 + 0.5) * box["width"] / 20, box["y"] + (y - 10 + 0.5) * box["height"] / 10)
            page.mouse.click(*place)
            wait_until(lambda pixel=f"pixel\t{x}, {y}": pixel in page.inner_text("#explanation"))
            marker = page.locator("#marker").bounding_box()
            for center, length, expected in zip((marker["x"], marker["y"]), (marker["width"], marker["height"]), place, strict=True):
                self.assertAlmostEqual(center + length / 2, expected, delta=2)
        page.click("#compare")
        wait_until(lambda: "equal" in page.inner_text("#difference-text"))
        page.select_option("#integrator", "depth")
        wait_until(lambda: "differ" in page.inner_text("#difference-text"))
        first = re.search(r"the first is (\d+),(\d+)", page.inner_text("#difference-text"))
        page.click("#ask-first")
        wait_until(lambda: "Right picture" in page.inner_text("#explanation"))
        self.assertGreaterEqual(int(first[1]), 20)
        self.assertGreaterEqual(int(first[2]), 10)
        self.assertIn(f"pixel\t{first[1]}, {first[2]}", page.inner_text("#explanation"))

    def test_comparison(self):
        scene = SCENES / "perspective1.json"
        page = self.open(self.viewer(scene))
        page.click("#compare")
        wait_until(lambda: "equal" in page.inner_text("#difference-text"))
        page.select_option("#integrator", "albedo")
        wait_until(lambda: "--integrator albedo" in page.inner_text("#command"))
        page.wait_for_timeout(500)
        self.wait_done(page)
        self.assert_shows(page, scene, "#other")
        a, b = self.drawn_by_program(scene, []), self.drawn_by_program(scene, ["--integrator", "albedo"])
        differing = [i // 3 for i in range(0, len(a[2]), 3) if a[2][i:i + 3] != b[2][i:i + 3]]
        text = page.inner_text("#difference-text")
        if differing:
            self.assertIn(f"{len(differing)} pixels differ", text)
        else:
            self.assertIn("equal", text)
        page.select_option("#integrator", "depth")
        wait_until(lambda: "differ" in page.inner_text("#difference-text"))
        b = self.drawn_by_program(scene, ["--integrator", "depth"])
        first = next(i // 3 for i in range(0, len(a[2]), 3) if a[2][i:i + 3] != b[2][i:i + 3])
        place = f"{first % 640},{first // 640}"
        wait_until(lambda: f"the first is {place}" in page.inner_text("#difference-text"))
        page.click("#ask-first")
        wait_until(lambda: "Right picture" in page.inner_text("#explanation"))
        page.locator("#wiper").fill("30")
        page.check("#difference")
        self.assertTrue(page.is_visible("#difference-picture"))
        self.keep(page, "difference")
        page.uncheck("#difference")
        self.keep(page, "comparison")
        page.click("#compare")
        self.assertFalse(page.is_visible("#other"))

    def test_two_scenes(self):
        scenes = [SCENES / "gltf/moving.glb", SCENES / "gltf/cube.glb"]
        page = self.open(self.viewer(scenes[0], "--compare", scenes[1], "--size", "64x48", "--spp", "1"))
        wait_until(lambda: "differ" in page.inner_text("#difference-text"))
        for side, canvas in (("0", "#picture"), ("1", "#other")):
            page.select_option("#side", side)
            scene = scenes[int(side)]
            self.assertEqual(shlex.split(page.inner_text("#command"))[1], str(scene))
            self.assertEqual(page.inner_text("#name"), str(scene))
            self.assertEqual(page.is_visible("#animation-section"), scene.stem == "moving")
            self.assert_shows(page, scene, canvas)
        # Only the scene that has the animation moves.
        page.select_option("#side", "0")
        self.change(page, lambda: page.locator("#time").fill("0.5"))
        self.wait_done(page)
        self.assertIn("--time 0.5", page.inner_text("#command"))
        self.assert_shows(page, scenes[0])
        page.select_option("#side", "1")
        self.assertNotIn("--time", page.inner_text("#command"))
        self.change(page, lambda: page.select_option("#camera", "--view top"))
        self.assert_shows(page, scenes[1], "#other")
        # Ending the comparison and opening it again shows the same scenes.
        for _ in range(2):
            page.click("#compare")
        wait_until(lambda: page.inner_text("#name") == str(scenes[1]))

    def test_errors_of_two_scenes(self):
        scenes = [self.folder / "a.json", self.folder / "b.json"]
        for scene in scenes:
            shutil.copy(SCENES / "perspective1.json", scene)
        text = scenes[1].read_text()
        page = self.open(self.viewer(scenes[0], "--compare", scenes[1], "--size", "64x48"))
        self.wait_done(page)
        page.select_option("#side", "0")
        descriptions = []
        page.on("request", lambda request: descriptions.append(request.url) if "/scene?" in request.url else None)
        page.focus("#stage")
        scenes[1].write_text(text + " ")
        wait_until(lambda: page.wait_for_timeout(50) or descriptions)
        for _ in range(3):
            self.change(page, lambda: page.keyboard.press("ArrowLeft"))
        self.assertEqual([url.split("?")[1] for url in descriptions], ["scene=1"])
        # An error of the right scene stays while the left picture is drawn.
        scenes[1].write_text(text[:-20])
        page.wait_for_selector("#error:not([hidden])")
        self.assertRegex(page.inner_text("#error"), r"^Right picture: .*b\.json")
        before = int(page.get_attribute("body", "data-request"))
        page.keyboard.press("ArrowLeft")
        wait_until(lambda: int(page.get_attribute("body", "data-request")) > before)
        self.wait_done(page, "error")
        page.wait_for_timeout(300)
        self.assertIn("b.json", page.inner_text("#error"))
        self.assertEqual(page.get_attribute("body", "data-state"), "error")
        scenes[1].write_text(text)
        self.wait_done(page)
        self.assertFalse(page.is_visible("#error"))
        self.assert_shows(page, scenes[0])
        page.click("#compare")
        self.assertEqual(shlex.split(page.inner_text("#command"))[1], str(scenes[0]))

    def test_file_changes_and_errors(self):
        scene = self.folder / "scene.json"
        shutil.copy(SCENES / "perspective1.json", scene)
        text = scene.read_text()
        page = self.open(self.viewer(scene))
        before = self.shown(page)
        scene.write_text(text.replace('"radius"', '"radiu"', 1))
        page.wait_for_selector("#error:not([hidden])", timeout=20000)
        self.assertIn("^", page.inner_text("#error"))
        self.assertRegex(page.inner_text("#error"), r"scene\.json:\d+:\d+: /objects")
        self.assertTrue(self.shown(page) == before)  # the last good picture stays
        self.keep(page, "error")
        scene.write_text(re.sub(r'"radius": 2,', '"radius": 0.5,', text))
        wait_until(lambda: not page.is_visible("#error"))
        self.wait_done(page)
        self.assert_shows(page, scene)
        self.assertFalse(self.shown(page) == before)
        # A refused option doesn't end the page either.
        page.fill("[data-option='--background']", "blau")
        page.locator("[data-option='--background']").blur()
        page.wait_for_selector("#error:not([hidden])")
        self.assertIn("--background", page.inner_text("#error"))
        self.change(page, lambda: page.fill("[data-option='--background']", "#0000ff") or page.locator("[data-option='--background']").blur())
        self.assertFalse(page.is_visible("#error"))
        self.assert_shows(page, scene)

    def test_reload_while_the_scene_is_broken(self):
        scene, other = self.folder / "scene.glb", self.folder / "other.glb"
        shutil.copy(SCENES / "gltf/lamps.glb", scene)
        shutil.copy(SCENES / "gltf/lamps.glb", other)
        data = scene.read_bytes()
        options = ["--size", "60x40", "--spp", "2", "--env", "studio"]
        page = self.open(self.viewer(scene, *options, "--compare", other))
        self.wait_done(page)
        words = self.words(page)
        self.assertIn("--exposure", words)
        scene.write_bytes(data[:200])
        page.wait_for_selector("#error:not([hidden])")
        page.reload()
        page.wait_for_selector("#error:not([hidden])")
        page.select_option("#side", "0")
        self.assertEqual(shlex.split(page.inner_text("#command")), ["microtrace", str(scene), *options])
        self.assertIn("scene.glb", page.inner_text("#error"))
        self.assertIn(str(scene), page.title())
        page.fill("#spp", "3")
        page.press("#spp", "Enter")
        scene.write_bytes(data)
        self.wait_done(page)
        wait_until(lambda: "--exposure" in self.words(page))
        self.assertEqual(self.words(page), ["3" if word == "2" else word for word in words])
        self.assert_shows(page, scene)
        page.select_option("#side", "1")
        self.assertEqual(self.words(page), words)
        self.assert_shows(page, other, "#other")

    def test_reload_and_two_pages(self):
        viewer = self.viewer(SCENES / "perspective1.json")
        first, second = self.open(viewer), self.open(viewer)
        self.change(first, lambda: first.select_option("#integrator", "normal"))
        self.change(second, lambda: second.select_option("#camera", "--view top"))
        self.assert_shows(first, SCENES / "perspective1.json")
        self.assert_shows(second, SCENES / "perspective1.json")
        for _ in range(12):  # more than the server keeps pictures
            first.reload()
            self.wait_done(first)
        self.assert_shows(first, SCENES / "perspective1.json")
        self.change(second, lambda: second.select_option("#camera", "--view front"))
        self.assert_shows(second, SCENES / "perspective1.json")

    def test_warnings_are_listed(self):
        with self.subTest("a scene with warnings"):
            scene = self.folder / "scene.gltf"
            asset = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "extensionsUsed": ["VENDOR_unknown"]}
            scene.write_text(json.dumps(asset))
            page = self.open(self.viewer(scene, "--size", "16x16", "--spp", "1"))
            self.assertIn("VENDOR_unknown", page.inner_text("#warnings"))
            self.assertIn("/extensionsUsed", page.inner_text("#warnings"))
        with self.subTest("a warning without a position"):
            scene.write_text(json.dumps({**asset, "extensionsUsed": [f"VENDOR_{i}" for i in range(120)]}))
            page = self.open(self.viewer(scene, "--size", "16x16", "--spp", "1"))
            self.assertRegex(page.inner_text("#warnings li:last-child"), r"^\d+ more warnings are left out$")

    def test_saves_and_copies(self):
        scene = SCENES / "gltf/cube.glb"
        page = self.open(self.viewer(scene, "--size", "60x40", "--spp", "4"), accept_downloads=True, permissions=["clipboard-read", "clipboard-write"])
        for extension in ("png", "exr"):
            page.select_option("#format", extension)
            with page.expect_download() as download:
                page.click("#save")
            expected = self.folder / f"expected.{extension}"
            subprocess.run([PROGRAM, scene, *self.words(page), "-o", expected, "-q"], check=True)
            self.assertEqual(Path(download.value.path()).read_bytes(), expected.read_bytes())
            self.assertEqual(download.value.suggested_filename, f"cube.{extension}")
        page.click("#copy")
        self.assertEqual(page.evaluate("() => navigator.clipboard.readText()"), page.inner_text("#command"))

    def test_color_schemes(self):
        viewer = self.viewer(SCENES / "sphere.json")
        colors = [self.open(viewer, color_scheme=scheme).eval_on_selector("aside", "e => getComputedStyle(e).backgroundColor")
                  for scheme in ("light", "dark")]
        self.assertNotEqual(*colors)

    def test_turning_needs_no_more_memory(self):
        viewer = self.viewer(SCENES / "gltf/knot.glb")
        page = self.open(viewer)
        box = page.locator("#picture").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        choices = random.Random(1)
        page.mouse.move(x, y)
        page.mouse.down()
        samples, end = [], time.monotonic() + TURNS
        while time.monotonic() < end:
            for _ in range(20):
                page.mouse.move(x + choices.randint(-200, 200), y + choices.randint(-100, 100))
                page.wait_for_timeout(10)
            samples.append(viewer.memory())
        page.mouse.up()
        page.wait_for_timeout(300)
        self.wait_done(page)
        half = len(samples) // 2
        print(f"turning for {TURNS} s: {min(samples) >> 20} to {max(samples) >> 20} MiB", file=sys.stderr)
        self.assertLess(max(samples[half:]), max(samples[:half + 1]) + (16 << 20))

    def test_end(self):
        viewer = self.viewer(SCENES / "sphere.json")
        page = self.open(viewer)
        page.click("#end")
        self.assertEqual(viewer.process.wait(timeout=20), 0)
        wait_until(lambda: "ended" in page.inner_text("#status"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
