"""Tests the server of `microtrace view` without a browser: what it refuses, and that its pictures are the program's.

usage: server_test.py PROGRAM SOURCE_FOLDER [unittest options]
"""

import array
import json
import os
import random
import re
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from viewer import Viewer, read_png, wait_until

PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), Path(sys.argv[2]).absolute()
SCENES = SOURCE / "scenes"
SMALL = ["--size", "64x48", "--spp", "4"]
FUZZ_SECONDS = float(os.environ.get("MICROTRACE_FUZZ_SECONDS", "20"))


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, **options)


def raw(viewer, request, timeout=30):
    """Sends bytes and returns what comes back until the server closes the connection or the time is over."""
    with socket.create_connection(("127.0.0.1", viewer.port), timeout=timeout) as connection:
        try:
            connection.sendall(request)
            connection.shutdown(socket.SHUT_WR)
        except OSError:
            pass  # the server has already refused
        answer = b""
        try:
            while part := connection.recv(65536):
                answer += part
        except OSError:
            pass
        return answer


def status(answer):
    return int(answer.split()[1]) if answer.startswith(b"HTTP/1.1 ") else None


def write_color(path, number):
    """Writes a PNG file with one pixel, under another name first."""
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    color = bytes([0, 7 * number % 256, 100, 255 - number % 256])
    temporary = path.with_suffix(".new")
    temporary.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", 1, 1, 8, 2, 0, 0, 0)) +
                          chunk(b"IDAT", zlib.compress(color)) + chunk(b"IEND", b""))
    os.replace(temporary, path)


def write_textured_grid(path, n):
    """Writes a glTF asset of 2 (n - 1)^2 triangles with the texture t.png, which takes some time to load."""
    points = array.array("f", (x for i in range(n * n) for x in (i % n / n, i // n / n, 0)))
    coordinates = array.array("f", (x for i in range(n * n) for x in (i % n / n, i // n / n)))
    corners = array.array("I", (x for i in range(n * (n - 1)) if i % n < n - 1 for x in (i, i + 1, i + n, i + 1, i + n + 1, i + n)))
    parts = [part.tobytes() for part in (points, coordinates, corners)]
    path.with_suffix(".bin").write_bytes(b"".join(parts))
    kinds = [(5126, n * n, "VEC3"), (5126, n * n, "VEC2"), (5125, len(corners), "SCALAR")]
    accessors = [{"bufferView": i, "componentType": kind, "count": count, "type": name} for i, (kind, count, name) in enumerate(kinds)]
    accessors[0].update(min=[0, 0, 0], max=[max(points), max(points), 0])
    primitive = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}], "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"uri": "t.png"}], "accessors": accessors,
        "bufferViews": [{"buffer": 0, "byteOffset": sum(map(len, parts[:i])), "byteLength": len(part)} for i, part in enumerate(parts)],
        "buffers": [{"uri": path.with_suffix(".bin").name, "byteLength": sum(map(len, parts))}]}))


def write_copies(path, count):
    """Writes a glTF asset that contains a mesh of 200 triangles several times."""
    points = array.array("f", (x for i in range(600) for x in (i % 7, i % 11, i % 13)))
    path.with_suffix(".bin").write_bytes(points.tobytes())
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(count))}],
        "nodes": [{"mesh": 0, "translation": [20 * (i % 200), 20 * (i // 200), 0]} for i in range(count)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 600, "min": [0, 0, 0], "max": [6, 10, 12]}],
        "bufferViews": [{"buffer": 0, "byteLength": 7200}], "buffers": [{"uri": path.with_suffix(".bin").name, "byteLength": 7200}]}))


class Access(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.viewer = Viewer(PROGRAM, SCENES / "perspective1.json")
        cls.addClassCleanup(cls.viewer.__exit__)

    def test_page_and_all_files_that_it_names(self):
        page = self.viewer.request("GET", "")
        self.assertEqual((page.status, page.headers["Content-Type"]), (200, "text/html; charset=utf-8"))
        names = set(re.findall(r'(?:src|href)="([^":]+)"', page.body.decode()))
        self.assertIn("app.js", names)
        seen = set()
        while names - seen:
            name = (names - seen).pop()
            seen.add(name)
            file = self.viewer.request("GET", name)
            self.assertEqual(file.status, 200, name)
            names |= set(re.findall(r'from "\./([^"]+)"', file.body.decode()))
        self.assertGreaterEqual(len(seen), 7)
        self.assertNotIn("http", re.sub(r"http://www\.w3\.org", "", page.body.decode()))
        policy = page.headers["Content-Security-Policy"]
        self.assertTrue(policy.startswith("default-src 'none'; script-src 'self';"), policy)
        self.assertEqual(page.headers["Referrer-Policy"], "no-referrer")
        self.assertEqual(page.headers["Cache-Control"], "no-store")

    def test_only_the_loopback_listens(self):
        listening = [line.split()[1] for line in Path("/proc/net/tcp").read_text().splitlines()[1:]
                     if line.split()[3] == "0A" and line.split()[1].endswith(f":{self.viewer.port:04X}")]
        self.assertEqual(listening, [f"0100007F:{self.viewer.port:04X}"])

    def test_token(self):
        token = self.viewer.token
        self.assertRegex(token, "^[0-9a-f]{32}$")
        wrong = [f"/{token[:-1]}{'0' if token[-1] != '0' else '1'}/", f"/{token[:-1]}/", f"/{token}0/", "/", "//", f"//{token}/",
                 f"/x/{token}/", "/favicon.ico", f"/{token.upper()}x/", f"{token}/", "*", f"/%30{token[1:]}/"]
        for path in wrong:
            for method, body in (("GET", None), ("POST", "")):
                answer = self.viewer.request(method, "", body, whole_path=path)
                self.assertIn(answer.status, (400, 403), path)
                self.assertNotIn(token.encode(), answer.body)
        redirection = self.viewer.request("GET", "", whole_path=f"/{token}")
        self.assertEqual((redirection.status, redirection.headers["Location"]), (301, f"{token}/"))
        with Viewer(PROGRAM, SCENES / "sphere.json") as other:
            self.assertNotEqual(other.token, token)

    def test_host(self):
        def answer(*headers):
            lines = "".join(f"{header}\r\n" for header in headers)
            return status(raw(self.viewer, f"GET /{self.viewer.token}/ HTTP/1.1\r\n{lines}Connection: close\r\n\r\n".encode()))
        for host in ("localhost", "127.0.0.1", "[::1]", "LocalHost:99", f"127.0.0.1:{self.viewer.port}", "[::1]:80"):
            self.assertEqual(answer(f"Host: {host}"), 200, host)
        for host in ("example.org", "127.0.0.1.example.org", "localhost.", "localhost:80:80", "localhost:", "localhost:x", "", "127.1", "[::1",
                     "localhost@example.org", "example.org:80"):
            self.assertEqual(answer(f"Host: {host}"), 403, host)
        self.assertEqual(answer(), 403)
        self.assertEqual(answer("Host: localhost", "Host: example.org"), 403)

    def test_origin(self):
        own = f"http://127.0.0.1:{self.viewer.port}"
        for origin, expected in ((own, 200), ("http://localhost:1", 403), ("http://example.org", 403), ("null", 403), (own + ".org", 403),
                                 ("ftp://127.0.0.1", 403)):
            answer = self.viewer.request("POST", "scene", "", {"Origin": origin})
            self.assertEqual(answer.status, expected, origin)

    def test_allowed_host(self):
        with Viewer(PROGRAM, SCENES / "sphere.json", "--allow-host", "hub.example.org") as viewer:
            for host, expected in (("hub.example.org", 200), ("hub.example.org:443", 200), ("localhost", 200), ("example.org", 403)):
                self.assertEqual(viewer.request("GET", "", headers={"Host": host}).status, expected, host)

    def test_origin_of_a_proxy(self):
        def answers(viewer, host, *origins):
            headers = {} if host is None else {"Host": host}
            return [viewer.request("POST", "scene", "", {**headers, "Origin": origin}).status for origin in origins]
        # Host is None if the proxy replaces the header by the server's own address, as nginx does by default.
        with Viewer(PROGRAM, SCENES / "sphere.json", "--allow-host", "Hub.example.org") as viewer:
            self.assertEqual(answers(viewer, None, "https://hub.example.org", "http://hub.example.org", "https://hub.example.org:443"), [200] * 3)
            self.assertEqual(answers(viewer, None, "https://hub.example.org:8443", "https://example.org", "https://hub.example.org.org", "null",
                                     "https://xhub.example.org", "https://hub.example.org:", "ftp://hub.example.org", "http://localhost"), [403] * 8)
            self.assertEqual(answers(viewer, "hub.example.org:8443", "https://hub.example.org:8443"), [200])
            self.assertEqual(answers(viewer, "example.org", "https://hub.example.org", "https://example.org"), [403] * 2)
        with Viewer(PROGRAM, SCENES / "sphere.json", "--allow-host", "hub.example.org:8443") as viewer:
            for host in (None, "hub.example.org", "hub.example.org:8443"):
                self.assertEqual(answers(viewer, host, "https://hub.example.org:8443"), [200])
            self.assertEqual(answers(viewer, None, "https://hub.example.org", "https://hub.example.org:9000"), [403] * 2)
            policy = viewer.request("GET", "").headers["Content-Security-Policy"]
            self.assertTrue(policy.endswith(" https://hub.example.org:*"), policy)
        with Viewer(PROGRAM, SCENES / "sphere.json", "--allow-host", "[2001:db8::1]:8443") as viewer:
            self.assertEqual(answers(viewer, None, "https://[2001:db8::1]:8443", "https://[2001:db8::1]"), [200, 403])

    def test_methods_and_addresses(self):
        for method, path, expected in (("POST", "", 405), ("GET", "scene", 405), ("DELETE", "pictures", 405), ("GET", "nothing", 404),
                                       ("GET", "../", 404), ("GET", "pictures/99?after=0", 410), ("BREW", "", 405), ("HEAD", "style.css", 200)):
            self.assertEqual(self.viewer.request(method, path).status, expected, (method, path))
        self.assertEqual(self.viewer.request("HEAD", "style.css").body, b"")

    def test_oversize_and_malformed_requests(self):
        start = f"POST /{self.viewer.token}/scene HTTP/1.1\r\nHost: localhost\r\n".encode()
        cases = [
            (start + b"Content-Length: 70000\r\n\r\n" + b"x" * 70000, 413),
            (start + b"Content-Length: 18446744073709551615\r\n\r\n", 413),
            (start + b"Transfer-Encoding: chunked\r\n\r\n" + b"ffff\r\n" + b"x" * 0xFFFF + b"\r\nffff\r\n" + b"x" * 0xFFFF, 413),
            (start + b"X: " + b"x" * 20000 + b"\r\n\r\n", 431),
            (start + b"X: x\r\n" * 100000, 431),
            (start + b"Content-Length: -1\r\n\r\n", 400),
            (start + b"Content-Length: 1\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400),
            (start + b"Transfer-Encoding: chunked\r\n\r\nxyz\r\n", 400),
            (b"GET /" + b"a" * 20000 + b" HTTP/1.1\r\n\r\n", 431),
            (b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + bytes(100), 400),
            (b"GET / HTTP/9.9\r\n\r\n", 400),
            (b"GET\r\n\r\n", 400),
            (b"\x00" * 1000 + b"\r\n\r\n", 400),
        ]
        for request, expected in cases:
            self.assertEqual(status(raw(self.viewer, request)), expected, request[:100])
        self.assertEqual(raw(self.viewer, b""), b"")
        self.assertEqual(self.viewer.request("GET", "").status, 200)

    def test_requests_may_follow_each_other_at_once(self):
        line = f"GET /{self.viewer.token}/ HTTP/1.1\r\nHost: 127.0.0.1:{self.viewer.port}\r\n"
        answer = raw(self.viewer, f"{line}\r\n{line}\r\n{line}Connection: close\r\n\r\n".encode(), timeout=10)
        self.assertEqual(answer.count(b"HTTP/1.1 200 "), 3)

    def test_many_and_slow_connections(self):
        waiting = []
        for _ in range(200):
            connection = socket.create_connection(("127.0.0.1", self.viewer.port), timeout=10)
            connection.sendall(b"GET / HT")
            waiting.append(connection)
        for connection in waiting:
            connection.close()
        wait_until(lambda: self.viewer.request("GET", "").status == 200)

    def test_idle_connections_do_not_lock_others_out(self):
        path = self.viewer.open()
        with ThreadPoolExecutor(1) as pool:
            poll = pool.submit(self.viewer.request, "GET", f"{path}?after=0")  # waits for a picture
            wait_until(lambda: poll.running())
            idle = []
            for start in (b"", b"GET / HT"):
                for _ in range(100):
                    connection = socket.create_connection(("127.0.0.1", self.viewer.port), timeout=10)
                    connection.sendall(start)
                    idle.append(connection)
                self.assertEqual(self.viewer.request("GET", "", timeout=10).status, 200)
            self.viewer.request("PUT", path, "--size\n8x6")
            self.assertEqual(poll.result(timeout=30).status, 200)
            for connection in idle:
                connection.close()
        self.viewer.request("DELETE", path)

    def test_fuzz(self):
        choices = random.Random(2026)
        token = self.viewer.token.encode()
        picture = self.viewer.open().encode()
        seeds = [b"GET /%s/ HTTP/1.1\r\nHost: localhost\r\n\r\n" % token,
                 b"POST /%s/scene HTTP/1.1\r\nHost: localhost\r\nContent-Length: 12\r\n\r\n--spp\n4\n--up" % token,
                 b"PUT /%s/%s HTTP/1.1\r\nHost: localhost\r\nContent-Length: 20\r\n\r\n--size\n9x9\n--eye\n1,2" % (token, picture),
                 b"GET /%s/%s?after=0 HTTP/1.1\r\nHost: localhost\r\n\r\n" % (token, picture),
                 b"POST /%s/explanation?x=1&y=2&scene=0 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n" % token,
                 b"POST /%s/file?format=png HTTP/1.1\r\nHost: localhost\r\nContent-Length: 11\r\n\r\n--size\n4x4\n" % token,
                 b"POST /%s/pictures HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nabcde\r\n0\r\n\r\n" % token]
        parts = [b"\r\n", b"\x00", b"%", b"%2", b"&", b"=", b"?", b"/", b"--", b"\n", b"1e999", b"-1", b"99999999999999999999", b"\xff\xfe", b" ",
                 b":", b"x=", b"--size\n1x1\n", b"--env\nstudio\n", b"--time\n1\n", b"--integrator\nid\n", b"--camera\n0\n", b"nan", b"inf"]
        end, count, before = time.monotonic() + FUZZ_SECONDS, 0, self.viewer.memory()
        while time.monotonic() < end:
            request = bytearray(choices.choice(seeds))
            for _ in range(choices.randint(1, 6)):
                at = choices.randrange(len(request) + 1)
                kind = choices.randrange(4)
                if kind == 0:
                    request[at:at] = choices.choice(parts)
                elif kind == 1:
                    del request[at:at + choices.randint(1, 8)]
                elif kind == 2 and at < len(request):
                    request[at] = choices.randrange(256)
                else:
                    request[at:at] = request[at:at + choices.randint(1, 40)]
            # Long polls would wait for their 10 s.
            answer = raw(self.viewer, bytes(request), timeout=0.5)
            count += 1
            if answer:
                self.assertIn(status(answer), (200, 204, 301, 400, 403, 404, 405, 410, 413, 422, 431, 500, 503), request)
                # Only limits, such as pictures that are too large, are failures of the server.
                if status(answer) == 500:
                    self.assertRegex(answer, b"memory|large|limit", request)
            self.assertIsNone(self.viewer.process.poll(), request)
        print(f"fuzz: {count} requests, memory {before >> 20} to {self.viewer.memory() >> 20} MiB", file=sys.stderr)
        self.assertGreater(count, FUZZ_SECONDS)
        self.assertLess(self.viewer.memory(), 400 << 20)
        wait_until(lambda: self.viewer.request("GET", "").status == 200)


class Pictures(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = Path(self.scratch.name)

    def program_picture(self, scene, words, name="expected.png"):
        result = run(scene, *words, "-o", self.folder / name, "-q")
        self.assertEqual(result.returncode, 0, result.stderr)
        return (self.folder / name).read_bytes()

    def test_pictures_are_the_programs(self):
        cases = {
            "perspective1.json": [["--size", "64x48"], SMALL, ["--size", "32x24", "--integrator", "path", "--spp", "3"],
                                  ["--size", "64x48", "--integrator", "depth"], ["--size", "64x48", "--integrator", "id"],
                                  ["--size", "64x48", "--background", "transparent"], ["--size", "64x48", "--crop", "8,8,40,30"],
                                  ["--size", "64x48", "--eye", "-3,2,9", "--target", "0,0,0", "--fov", "50"]],
            "gltf/materials.glb": [SMALL, [*SMALL, "--env", "#8090ff", "--env-rotation", "30"], [*SMALL, "--env", "studio", "--background", "env"],
                                   [*SMALL, "--exposure", "1.5", "--tonemap", "aces"], [*SMALL, "--target-error", "0.5"],
                                   [*SMALL, "--view", "front", "--filter", "blackman-harris", "--seed", "7"]],
            "gltf/moving.glb": [[*SMALL, "--time", "0.5"], [*SMALL, "--time", "0.75", "--integrator", "flat"]],
            "gltf/far.glb": [SMALL, ["--size", "64x48", "--integrator", "normal"]],
            "sky.json": [[*SMALL, "--integrator", "path"]],
        }
        for scene, options in cases.items():
            with Viewer(PROGRAM, SCENES / scene) as viewer:
                path = viewer.open()
                for words in options:
                    with self.subTest(scene=scene, words=words):
                        expected = self.program_picture(SCENES / scene, words)
                        last = viewer.draw(words, path)[-1]
                        self.assertEqual(last.headers["Content-Type"], "image/png", last.body)
                        self.assertEqual(read_png(last.body), read_png(expected))
                        saved = viewer.request("POST", "file?format=png", "\n".join(words))
                        self.assertEqual(saved.body, expected)
                        self.assertIn(f'filename="{Path(scene).stem}.png"', saved.headers["Content-Disposition"])

    def test_options_of_the_command_line_are_those_of_the_first_picture(self):
        # The value of --ground may be omitted, so it can't be a word of its own.
        for options in (["--ground"], ["--ground=-0.7", "--env", "studio"], ["--exposure", "-1"], ["--eye", "-3,2,9"]):
            with self.subTest(options=options), Viewer(PROGRAM, SCENES / "gltf/cube.glb", *SMALL, *options) as viewer:
                words = viewer.request("POST", "scene?scene=0", "").json["words"]
                expected = self.program_picture(SCENES / "gltf/cube.glb", [*SMALL, *options])
                last = viewer.draw(words, viewer.open())[-1]
                self.assertEqual(last.headers["Content-Type"], "image/png", last.body)
                self.assertEqual(read_png(last.body), read_png(expected))

    def test_options_that_a_quantity_cannot_apply_are_omitted(self):
        scene = SCENES / "gltf/materials.glb"
        given = ["--ground", "--guiding", "--bsdf", "spec", "--denoise", "--quality", "draft", "--target-error", "0.5",
                 "--time-limit", "9", "--spp", "4", "--background", "env", "--max-depth", "3", "--aov", "variance"]
        kept = ["--size", "64x48", "--env", "studio"]
        quantity, flat = ["--integrator", "depth"], ["--integrator", "flat"]
        with Viewer(PROGRAM, scene, *kept, *given[:5], *quantity) as viewer:
            words = [*kept, *given, *quantity]
            last = viewer.draw(words)[-1]
            self.assertEqual(last.headers["Content-Type"], "image/png", last.body)
            names = [word for word in given[:-2] if word.startswith("--")]
            self.assertEqual(sorted(last.picture["omitted"]), sorted([*names, "--aov variance"]))
            expected = self.program_picture(scene, [*kept, *quantity])
            self.assertEqual(read_png(last.body), read_png(expected))
            self.assertEqual(viewer.request("POST", "file?format=png", "\n".join(words)).body, expected)
            # Colors without light are averaged, and pictures of light omit nothing.
            spp = ["--size", "64x48", "--spp", "4"]
            self.assertEqual(viewer.draw([*spp, *flat])[-1].picture["omitted"], [])
            self.assertEqual(viewer.draw([*spp, "--bsdf", "spec", "--quality", "draft"])[-1].picture["omitted"], [])
            self.assertEqual(viewer.draw([*spp, "--bsdf", "spec", *flat])[-1].picture["omitted"], ["--bsdf"])

    def test_only_channels_that_a_quantity_cannot_have_are_omitted(self):
        scene, words = SCENES / "gltf/cube.glb", ["--size", "64x48", "--spp", "4", "--integrator", "flat"]
        with Viewer(PROGRAM, scene) as viewer:
            channels = [*words, "--aov", "variance,depth,noisy"]
            self.assertEqual(viewer.draw(channels)[-1].picture["omitted"], ["--aov variance,noisy"])
            saved = viewer.request("POST", "file?format=exr", "\n".join(channels)).body
            self.assertEqual(saved, self.program_picture(scene, [*words, "--aov", "depth"], "expected.exr"))

    def test_ground_without_a_lowest_point(self):
        scene = self.folder / "planes.json"
        scene.write_text('{"version": 1, "objects": [{"type": "plane", "point": [0, -1, 0], "normal": [0, 1, 0]}]}')
        warning = "no object is bounded, so the scene has no lowest point for --ground; give a height, as in --ground=0"
        words = ["--size", "8x8", "--integrator", "path", "--spp", "1"]
        with Viewer(PROGRAM, scene, *words) as viewer:
            self.assertEqual(viewer.draw([*words, "--ground"])[-1].picture["warning"], warning)
            for options in ([], ["--ground=0"]):
                self.assertNotIn("warning", viewer.draw([*words, *options])[-1].picture)

    def test_exr_with_channels(self):
        words = [*SMALL, "--aov", "depth,id"]
        with Viewer(PROGRAM, SCENES / "gltf/cube.glb") as viewer:
            saved = viewer.request("POST", "file?format=exr", "\n".join(words))
            self.assertEqual(saved.body, self.program_picture(SCENES / "gltf/cube.glb", words, "expected.exr"))
            for extension in ("txt", "", "../png", "PNG"):
                self.assertEqual(viewer.request("POST", f"file?format={extension}", "\n".join(SMALL)).status, 422, extension)
            refused = viewer.request("POST", "file?format=png", "\n".join(words))
            self.assertEqual((refused.status, refused.json["error"]),
                             (422, ".png stores only colors, without the channels of --aov; choose exr"))

    def test_options_of_the_program_are_those_of_the_page(self):
        with Viewer(PROGRAM, SCENES / "gltf/cube.glb", "--spp", "3", "--size", "40x30", "--view", "front", "-t", "1") as viewer:
            scene = viewer.request("POST", "scene", "").json
            self.assertEqual(scene["words"], ["--size", "40x30", "--view", "front", "--spp", "3"])

    def test_moving_camera(self):
        with Viewer(PROGRAM, SCENES / "gltf/materials.glb") as viewer:
            path = viewer.open()
            viewer.draw(["--size", "640x480"], path, moving=True)
            first = viewer.draw(["--size", "640x480", "--view", "front"], path, moving=True)[0]
            self.assertEqual((first.picture["preview"], first.picture["samples"]), (True, 1))
            self.assertEqual((first.picture["width"], first.picture["height"]), (640, 480))
            width, _, _ = read_png(first.body)
            self.assertLess(width, 640)

    def test_passes_grow_and_the_sequence_increases(self):
        with Viewer(PROGRAM, SCENES / "gltf/materials.glb") as viewer:
            responses = viewer.draw(["--size", "320x240", "--spp", "64"])
            samples = [r.picture["samples"] for r in responses if not r.picture["preview"]]
            self.assertEqual(samples[-1], 64)
            self.assertGreater(len(samples), 1)
            self.assertEqual(samples, sorted(set(samples)))
            sequence = [r.picture["sequence"] for r in responses]
            self.assertEqual(sequence, sorted(set(sequence)))

    def test_crop(self):
        with Viewer(PROGRAM, SCENES / "perspective1.json") as viewer:
            last = viewer.draw(["--size", "64x48", "--crop", "8,10,40,30"])[-1]
            self.assertEqual([last.picture[name] for name in ("x", "y", "width", "height")], [8, 10, 32, 20])
            self.assertEqual(read_png(last.body)[:2], (32, 20))

    def test_variance(self):
        with Viewer(PROGRAM, SCENES / "gltf/lamps.glb") as viewer:
            words = ["--size", "64x48", "--spp", "16", "--integrator", "path", "--aov", "variance"]
            shown = read_png(viewer.draw(words)[-1].body)
            samples = shown[2]
            self.assertEqual(samples[0::3], samples[1::3])
            self.assertGreater(max(samples), 200)
            self.assertGreater(len(set(samples)), 50)
            # PNG has no channels and is the shown picture; EXR has the channel.
            saved = viewer.request("POST", "file?format=png", "\n".join(words))
            self.assertEqual((saved.status, read_png(saved.body)), (200, shown))
            saved = viewer.request("POST", "file?format=exr", "\n".join(words))
            self.assertEqual(saved.body, self.program_picture(SCENES / "gltf/lamps.glb", words, "expected.exr"))
            last = viewer.draw([*words[:-1], "variance,id"])[-1]
            self.assertEqual(last.headers["Content-Type"], "image/png", last.body)

    def test_time_limit(self):
        with Viewer(PROGRAM, SCENES / "gltf/lamps.glb") as viewer:
            last = viewer.draw(["--size", "320x240", "--spp", "65536", "--time-limit", "0.3"])[-1]
            self.assertEqual((last.picture["of"], last.picture["done"]), (65536, True))
            self.assertLess(last.picture["samples"], 65536)
            self.assertGreater(last.picture["samples"], 0)

    def test_saving_stops_when_the_client_leaves(self):
        with Viewer(PROGRAM, SCENES / "gltf/lamps.glb") as viewer:
            for _ in range(8):
                with socket.create_connection(("127.0.0.1", viewer.port)) as client:
                    body = b"--size\n2000x2000\n--spp\n65536"
                    client.sendall(f"POST /{viewer.token}/file?format=exr HTTP/1.1\r\nHost: localhost\r\n"
                                   f"Content-Length: {len(body)}\r\n\r\n".encode() + body)
                    time.sleep(0.1)
            wait_until(lambda: viewer.request("POST", "scene", "").status == 200)
            saved = viewer.request("POST", "file?format=png", "--size\n16x12\n--spp\n2")
            self.assertEqual(saved.status, 200, saved.body)

    def test_explanation_is_the_programs(self):
        for scene, words in (("perspective1.json", []), ("gltf/textures.glb", ["--view", "30,20"])):
            with Viewer(PROGRAM, SCENES / scene) as viewer:
                for x, y in ((320, 240), (200, 300), (0, 0), (639, 479)):
                    expected = json.loads(run("explain", SCENES / scene, *words, "--pixel", f"{x},{y}", "--json").stdout)
                    answer = viewer.request("POST", f"explanation?x={x + 0.5}&y={y + 0.5}", "\n".join(words)).json
                    expected["pixel"]["camera"] = answer["pixel"]["camera"]  # the page doesn't name it
                    self.assertEqual(answer, expected)
                for query in ("x=640.5&y=1", "x=-1&y=1", "x=nan&y=1", "y=1", "x=1&y=1&scene=1", "x=1&y=1&scene=-1"):
                    self.assertEqual(viewer.request("POST", f"explanation?{query}", "").status, 422, query)

    def test_errors_are_the_programs(self):
        with Viewer(PROGRAM, SCENES / "perspective1.json") as viewer:
            path = viewer.open()
            for words in (["--sp", "4"], ["--spp", "0"], ["--help"], ["--output", "x.png"], ["x.json"], ["--port", "1"], ["--spp"],
                          ["--eye", "1,2"], ["--target", "0,0,0"]):
                answer = viewer.request("PUT", path, "\n".join(words))
                allowed = 200 if words[0] == "--port" else 422
                self.assertEqual(answer.status, allowed, words)
                if allowed == 422:
                    self.assertTrue(answer.json["error"], words)
            last = viewer.draw(["--camera", "nobody"], path)[-1]
            self.assertEqual(last.headers["Content-Type"], "application/json")
            self.assertIn('there is no camera "nobody"; choose 0 (camera1)', last.json["error"])
            self.assertEqual(viewer.draw(["--size", "16x12"], path)[-1].headers["Content-Type"], "image/png")

    def test_description_of_an_asset(self):
        with Viewer(PROGRAM, SCENES / "gltf/moving.glb") as viewer:
            scene = viewer.request("POST", "scene", "").json
            self.assertEqual(scene["format"], "gltf")
            self.assertGreater(scene["animations"][0]["end"], 0)
            self.assertGreater(scene["distance"], 0)
        with Viewer(PROGRAM, SCENES / "perspective1.json", "--compare", SCENES / "sphere.json") as viewer:
            names = [viewer.request("POST", f"scene?scene={i}", "").json for i in (0, 1)]
            self.assertEqual([Path(scene["name"]).name for scene in names], ["perspective1.json", "sphere.json"])
            self.assertEqual([scene["scenes"] for scene in names], [2, 2])
            other = viewer.draw(["--size", "64x48"], viewer.open(scene=1))[-1]
            self.assertEqual(read_png(other.body), read_png(self.program_picture(SCENES / "sphere.json", ["--size", "64x48"])))

    def test_files_are_read_again_when_they_change(self):
        scene = self.folder / "scene.json"
        shutil.copy(SCENES / "perspective1.json", scene)
        text = scene.read_text()
        with Viewer(PROGRAM, scene, "--integrator", "flat") as viewer:
            path = viewer.open()
            first = viewer.draw(["--size", "64x48"], path)[-1]

            def next_after(response):
                number = response.picture["sequence"]
                return wait_until(lambda: (r := viewer.request("GET", f"{path}?after={number}")).status == 200 and r)

            # A broken file: the message names the line and shows it with a caret.
            scene.write_text(text.replace('"radius"', '"radiu"', 1))
            broken = next_after(first)
            self.assertEqual(broken.headers["Content-Type"], "application/json")
            self.assertRegex(broken.json["error"], r"scene\.json:\d+:\d+: /")
            self.assertIn("^", broken.json["error"])
            refused = viewer.request("POST", "scene", "")
            self.assertEqual((refused.status, refused.json["words"], refused.json["scenes"]), (422, ["--integrator", "flat"], 1))
            self.assertEqual((refused.json["name"], refused.json["error"]), (str(scene), broken.json["error"]))
            # Another picture, by a new file of the same name, as editors write it.
            changed = re.sub(r'("radius":\s*)[\d.]+', r"\g<1>0.3", text)
            self.assertNotEqual(changed, text)
            (self.folder / "new").write_text(changed)
            os.replace(self.folder / "new", scene)
            second = next_after(broken)
            self.assertEqual(second.headers["Content-Type"], "image/png")
            self.assertGreater(second.picture["revision"], first.picture["revision"])
            self.assertEqual(read_png(second.body), read_png(self.program_picture(scene, ["--size", "64x48"])))
            self.assertNotEqual(read_png(second.body), read_png(first.body))
            # A missing file, and the first one again.
            scene.unlink()
            missing = next_after(second)
            self.assertIn("scene.json", missing.json["error"])
            scene.write_text(text)
            self.assertEqual(read_png(next_after(missing).body), read_png(first.body))

    def test_scene_file_becomes_a_pipe_or_a_folder(self):
        scene = self.folder / "scene.json"
        shutil.copy(SCENES / "perspective1.json", scene)
        with Viewer(PROGRAM, scene) as viewer:
            path = viewer.open()
            last = viewer.draw(["--size", "64x48"], path)[-1]
            first = read_png(last.body)

            def next_after(response):
                number = response.picture["sequence"]
                return wait_until(lambda: (r := viewer.request("GET", f"{path}?after={number}")).status == 200 and r)

            for make, remove, text in ((os.mkfifo, os.unlink, "is not a regular file"), (os.mkdir, os.rmdir, "is a directory, not a file")):
                scene.unlink()
                make(scene)
                while text not in (last := next_after(last)).body.decode(errors="replace"):
                    pass  # the file may have been seen while it was missing
                remove(scene)
                shutil.copy(SCENES / "perspective1.json", scene)
                while (last := next_after(last)).headers["Content-Type"] != "image/png":
                    pass
                self.assertEqual(read_png(last.body), first)
            scene.unlink()
            os.mkfifo(scene)
            while "is not a regular file" not in (last := next_after(last)).json["error"]:
                pass
            viewer.process.send_signal(15)
            self.assertEqual(viewer.process.wait(timeout=10), 0)
        result = run("view", scene, "--no-browser", timeout=30)
        self.assertEqual(result.returncode, 5)
        self.assertIn(b"is not a regular file", result.stderr)

    def test_texture_that_changes_during_loading(self):
        scene, words = self.folder / "scene.gltf", ["--size", "16x12", "--integrator", "albedo", "--view", "front"]
        write_textured_grid(scene, 400)
        with ThreadPoolExecutor() as pool:
            opening = pool.submit(Viewer, PROGRAM, scene, *words)
            count = 0
            while not opening.done():
                count += 1
                write_color(self.folder / "t.png", count)
                time.sleep(0.01)
            with opening.result() as viewer:
                path = viewer.open()
                expected = read_png(self.program_picture(scene, words))
                wait_until(lambda: read_png(viewer.draw(words, path)[-1].body) == expected, 10)
                # A file that was missing when the scene was loaded.
                (self.folder / "t.png").unlink()
                wait_until(lambda: read_png(viewer.draw(words, path)[-1].body) != expected, 10)
                scene.write_text(scene.read_text().replace("t.png", "u.png"))
                time.sleep(1)
                viewer.draw(words, path)
                write_color(self.folder / "u.png", 1)
                expected = read_png(self.program_picture(scene, words))
                wait_until(lambda: read_png(viewer.draw(words, path)[-1].body) == expected, 10)

    def test_pictures_are_independent_and_limited(self):
        with Viewer(PROGRAM, SCENES / "perspective1.json") as viewer:
            paths = [viewer.open() for _ in range(8)]
            expected = {view: read_png(self.program_picture(SCENES / "perspective1.json", ["--size", "32x24", "--view", view]))
                        for view in ("front", "top")}
            for path, view in zip(paths, ["front", "top"] * 4, strict=True):
                self.assertEqual(viewer.request("PUT", path, f"--size\n32x24\n--view\n{view}").status, 200)
            for path, view in zip(paths, ["front", "top"] * 4, strict=True):
                after, response = 0, None
                while response is None or not response.picture["done"]:
                    response = viewer.request("GET", f"{path}?after={after}")
                    after = response.picture["sequence"]
                self.assertEqual(read_png(response.body), expected[view])
            ninth = viewer.open()
            self.assertEqual(viewer.request("GET", f"{paths[0]}?after=0").status, 410)  # was not asked for the longest time
            # So does a request that waits for the next picture, when its picture is replaced.
            answers = []
            waiting = [threading.Thread(target=lambda path=path: answers.append(viewer.request("GET", f"{path}?after=99").status))
                       for path in [*paths[1:], ninth]]
            for thread in waiting:
                thread.start()
            time.sleep(0.5)
            viewer.open()
            wait_until(lambda: answers == [410], 5)
            for path in paths[2:]:
                self.assertEqual(viewer.request("DELETE", path).status, 204)
            self.assertEqual(viewer.request("DELETE", ninth).status, 204)
            self.assertEqual(viewer.request("GET", f"{ninth}?after=0").status, 410)
            for thread in waiting:
                thread.join()
            self.assertEqual(answers, 8 * [410])


class Ends(unittest.TestCase):
    def test_browsers_that_end_leave_no_zombie(self):
        environment = dict(os.environ, BROWSER="true", ASAN_OPTIONS="detect_leaks=0")
        with subprocess.Popen([PROGRAM, "view", SCENES / "sphere.json"], env=environment, stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE) as process:
            process.stdout.readline()
            time.sleep(0.5)
            wait_until(lambda: not any(children.read_text() for children in Path(f"/proc/{process.pid}/task").glob("*/children")), 10)
            process.terminate()
            self.assertEqual(process.wait(timeout=10), 0)

    def test_the_browser_outlives_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            browser, report = Path(folder, "browser"), Path(folder, "report")
            browser.write_text(f"#!/bin/sh\n(ps -o sid= -p $$; ls -l /proc/$$/fd; grep SigIgn /proc/$$/status) > {report}.new\n"
                               f"mv {report}.new {report}\nsleep 60\n")
            browser.chmod(0o755)
            environment = dict(os.environ, BROWSER=str(browser), ASAN_OPTIONS="detect_leaks=0")
            with subprocess.Popen([PROGRAM, "view", SCENES / "sphere.json"], env=environment, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, start_new_session=True) as process:
                wait_until(report.exists)
                process.terminate()
                self.assertEqual(process.wait(timeout=10), 0)
            session, *rest = report.read_text().split("\n")
            os.kill(int(session), 15)  # still runs, in a session of its own
            self.assertNotEqual(int(session), process.pid)
            self.assertNotIn("socket:", "\n".join(rest))
            ignored = next(int(line.split()[1], 16) for line in rest if line.startswith("SigIgn"))
            self.assertEqual(ignored & 0x7FFFFFFF, 0)  # without those of the C library

    def test_too_many_open_files(self):
        limited = 'ulimit -n 24; exec "$0" "$@"'
        with subprocess.Popen(["bash", "-c", limited, PROGRAM, "view", "--no-browser", SCENES / "sphere.json"],
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
            port = int(process.stdout.readline().split("/")[2].split(":")[1])
            waiting = [socket.create_connection(("127.0.0.1", port)) for _ in range(40)]

            def seconds():
                fields = Path(f"/proc/{process.pid}/stat").read_text().split()
                return (int(fields[13]) + int(fields[14])) / os.sysconf("SC_CLK_TCK")
            begin = seconds()
            time.sleep(1)
            self.assertLess(seconds() - begin, 0.5)
            for connection in waiting:
                connection.close()
            process.terminate()
            self.assertEqual(process.wait(timeout=10), 0)

    def test_page_ends_the_program(self):
        with Viewer(PROGRAM, SCENES / "sphere.json") as viewer:
            # While a long picture is being drawn and awaited.
            path = viewer.open()
            viewer.request("PUT", path, "--integrator\npath\n--spp\n65536")
            self.assertEqual(viewer.request("POST", "end", "").status, 200)
            self.assertEqual(viewer.process.wait(timeout=10), 0)

    def test_signals_at_the_start(self):
        # The signal often arrives before the server runs.
        for _ in range(10):
            with Viewer(PROGRAM, SCENES / "sphere.json") as viewer:
                viewer.process.send_signal(15)
                self.assertEqual(viewer.process.wait(timeout=10), 0)

    def test_signals(self):
        for signal in (1, 2, 15):
            with Viewer(PROGRAM, SCENES / "sphere.json") as viewer:
                path = viewer.open()
                viewer.request("PUT", path, "--integrator\npath\n--spp\n65536")
                viewer.process.send_signal(signal)
                self.assertEqual(viewer.process.wait(timeout=10), 0)

    def test_loading_delays_neither_requests_nor_the_end(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "many.gltf"
            write_copies(scene, 12000)
            start = time.monotonic()
            with Viewer(PROGRAM, scene, "--instances", "copy", "--size", "8x6", "--spp", "1") as viewer:
                loading = time.monotonic() - start
                paths = [viewer.open() for _ in range(8)]
                for i, path in enumerate(paths):  # each loads the scene again, one after another
                    self.assertEqual(viewer.request("PUT", path, f"--instances\ncopy\n--time\n{i}").status, 200)
                time.sleep(loading / 4)
                start = time.monotonic()
                for path in paths:
                    self.assertEqual(viewer.request("DELETE", path).status, 204)
                self.assertLess(time.monotonic() - start, loading / 4)
                self.assertEqual(viewer.request("POST", "pictures").status, 503)  # as many are still being stopped
                viewer.process.send_signal(15)
                self.assertEqual(viewer.process.wait(timeout=60), 0)
                self.assertLess(time.monotonic() - start, loading + 1)

    def test_usage(self):
        with Viewer(PROGRAM, SCENES / "sphere.json") as viewer:
            busy = run("view", SCENES / "sphere.json", "--no-browser", "--port", viewer.port, timeout=30)
            self.assertEqual(busy.returncode, 5)
            self.assertIn(f"port {viewer.port} of 127.0.0.1 can't be used: Address already in use; choose another port", busy.stderr.decode())
        for arguments, code in ((["missing.json"], 5), (["-"], 2), ([SCENES / "sphere.json", "--port", "0"], 2), ([], 2),
                                ([SCENES / "sphere.json", "--camera", "nobody"], 2), ([SCENES / "sphere.json", "-o", "x.png"], 2),
                                ([SCENES / "sphere.json", "--compare", "-"], 2), ([SCENES / "sphere.json", "--compare", "missing.json"], 5)):
            result = run("view", *arguments, "--no-browser", timeout=30)
            self.assertEqual(result.returncode, code, (arguments, result.stderr))

    def test_hosts_that_are_refused(self):
        for host in ("", "hub.example.org; script-src *", "a b", "*", "*.example.org", "https://hub.example.org", "hub/x", "hub:", "hub:port",
                     "hub:65536", "hub:80:80", ":80", "[::1", "[]", "[::1]x", "hub\nx"):
            result = run("view", SCENES / "sphere.json", "--no-browser", "--allow-host", host, timeout=30)
            self.assertEqual(result.returncode, 2, host)
            self.assertIn(b"--allow-host: expects a ", result.stderr)

    def test_address_that_cannot_be_written(self):
        with open("/dev/full", "w") as full:
            result = subprocess.run([PROGRAM, "view", SCENES / "sphere.json", "--no-browser"], stdout=full, stderr=subprocess.PIPE, timeout=30)
        self.assertEqual(result.returncode, 5)
        self.assertIn(b"standard output: can't be written", result.stderr)

    def test_module_is_missing(self):
        result = run("view", SCENES / "sphere.json", env=dict(os.environ, MICROTRACE_MODULE_PATH="/nowhere"), timeout=30)
        self.assertEqual(result.returncode, 4)
        self.assertIn(b"microtrace_http", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
