#!/usr/bin/env python3
"""Tests --display-server with a server that decodes the packets of tev's protocol.

usage: display_server_test.py PROGRAM SOURCE_FOLDER
"""

import socket
import struct
import sys
import threading
import time
import unittest
from pathlib import Path

from program import ProgramTest

SCENES = Path(sys.argv[2]).absolute() / "scenes"
LIGHT = [SCENES / "gltf/materials.glb", "--size", "70x130", "--spp", "8", "--tonemap", "none"]


class Packet:
    def __init__(self, content):
        self.content = content

    def text(self):
        text, self.content = self.content.split(b"\0", 1)
        return text.decode()

    def numbers(self, kind, count=1):
        size = struct.calcsize(f"<{count}{kind}")
        numbers, self.content = struct.unpack(f"<{count}{kind}", self.content[:size]), self.content[size:]
        return list(numbers)


class Tev:
    """A viewer. `pictures` holds for each name the width, the height, and a list of its states: bands of pixels by position."""

    def __init__(self, packets=None, host="127.0.0.1"):
        """Receives this many packets, then closes the connection; None: all packets."""
        self.listener = socket.create_server((host, 0), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
        self.port = self.listener.getsockname()[1]
        self.pictures, self.packets, self.problem = {}, packets, None
        self.thread = threading.Thread(target=self.work, daemon=True)
        self.thread.start()

    def work(self):
        connection, _ = self.listener.accept()
        self.listener.close()
        stream = connection.makefile("rb")
        try:
            while self.packets != 0 and (head := stream.read(4)):
                size, = struct.unpack("<I", head)
                self.receive(Packet(stream.read(size - 4)))
                if self.packets:
                    self.packets -= 1
        except Exception as error:
            self.problem = error
        connection.close()

    def receive(self, packet):
        operation, focus = packet.numbers("B", 2)
        name = packet.text()
        if operation == 4:
            assert focus == 1
            width, height, count = packet.numbers("i", 3)
            self.pictures[name] = (width, height, [packet.text() for _ in range(count)], [])
        else:
            assert (operation, focus) == (6, 0)
            count, = packet.numbers("i")
            channels = [packet.text() for _ in range(count)]
            assert channels == self.pictures[name][2]
            x, y, width, height = packet.numbers("i", 4)
            offsets, strides = packet.numbers("q", count), packet.numbers("q", count)
            values = packet.numbers("f", count * width * height)
            planes = [values[offset::stride] for offset, stride in zip(offsets, strides)]
            self.pictures[name][3].append((x, y, width, height, list(zip(*planes))))
        assert packet.content == b""

    def finish(self):
        self.thread.join(timeout=30)
        if self.problem:
            raise self.problem
        return self.pictures


def pixels_of(picture):
    """Returns the last state of a picture by (x, y)."""
    pixels = {}
    for x0, y0, width, _, values in picture[3]:
        for i, value in enumerate(values):
            pixels[x0 + i % width, y0 + i // width] = value
    return pixels


def srgb(x):
    x = min(max(x, 0), 1)
    return 255 * (12.92 * x if x <= 0.0031308 else 1.055 * x**(1 / 2.4) - 0.055)


class DisplayServer(ProgramTest):
    def draw(self, tev, *arguments, code=0):
        address = f"localhost:{tev.port}" if isinstance(tev, Tev) else tev
        result = self.run_program(*arguments, "--display-server", address, timeout=60)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr

    def check(self, pixels, ppm, curve):
        head, data = ppm[:ppm.index(b"255\n") + 4], ppm[ppm.index(b"255\n") + 4:]
        width = int(head.split()[1])
        for (x, y), values in pixels.items():
            for c in range(3):
                self.assertAlmostEqual(curve(values[c]), data[3 * (width * y + x) + c], delta=0.501)

    def test_flat_picture(self):
        tev = Tev()
        self.draw(tev, SCENES / "perspective1.json", "--size", "64x80", "-o", "a.ppm")
        picture = tev.finish()["a.ppm"]
        self.assertEqual(picture[:3], (64, 80, ["R", "G", "B"]))
        pixels = pixels_of(picture)
        self.assertEqual(len(pixels), 64 * 80)
        self.check(pixels, (self.folder / "a.ppm").read_bytes(), lambda x: 255 * x)

    def test_light_appears_gradually(self):
        for more in [(), ("--checkpoint", "c"), ("--time-limit", "1000")]:
            tev = Tev()
            self.draw(tev, *LIGHT, *more, "-o", "a.ppm")
            picture = tev.finish()["a.ppm"]
            pixels = pixels_of(picture)
            self.assertEqual(len(pixels), 70 * 130)
            self.assertGreater(len(picture[3]), 3)  # bands of several states
            self.check(pixels, (self.folder / "a.ppm").read_bytes(), srgb)
            shown = (self.folder / "a.ppm").read_bytes()
            self.run_program(*LIGHT, "-o", "b.ppm")
            self.assertEqual(shown, (self.folder / "b.ppm").read_bytes())

    def test_crop_and_alpha(self):
        tev = Tev()
        self.draw(tev, SCENES / "sphere.json", "--size", "70x130", "--spp", "1", "--crop", "10,0,50,100", "--background", "transparent", "-o", "a.png")
        picture = tev.finish()["a.png"]
        self.assertEqual(picture[:3], (70, 130, ["R", "G", "B", "A"]))
        pixels = pixels_of(picture)
        self.assertEqual(set(pixels), {(x, y) for x in range(10, 50) for y in range(100)})
        self.assertEqual({pixel[3] for pixel in pixels.values()}, {0, 1})

    def test_frames(self):
        tev = Tev()
        self.draw(tev, *LIGHT, "--frames", "1:3", "-o", "%d.ppm")
        self.assertEqual(list(tev.finish()), ["1.ppm", "2.ppm", "3.ppm"])

    def test_version_6(self):
        try:
            tev = Tev(host="::1")
        except OSError as error:
            self.skipTest(str(error))
        self.draw(f"[::1]:{tev.port}", SCENES / "sphere.json", "-o", "a.ppm")
        self.assertEqual(list(tev.finish()), ["a.ppm"])

    def test_viewer_ends(self):
        self.run_program(*LIGHT, "-o", "b.ppm")
        for packets in range(4):
            tev = Tev(packets)
            message = self.draw(tev, *LIGHT, "-o", "a.ppm")
            self.assertLessEqual(message.count(b"--display-server"), 1)
            self.assertEqual((self.folder / "a.ppm").read_bytes(), (self.folder / "b.ppm").read_bytes())
        self.assertEqual(message.count(b"warning: --display-server: "), 1)

    def test_viewer_stops_receiving(self):
        with socket.create_server(("127.0.0.1", 0)) as listener:
            start = time.monotonic()
            scene = [SCENES / "sphere.json", "--size", "2000x2000", "-o", "a.ppm"]
            message = self.draw(f"127.0.0.1:{listener.getsockname()[1]}", *scene)
            self.assertLess(time.monotonic() - start, 30)
            self.assertIn(b"Connection timed out; nothing more is shown", message)
            self.assertGreater((self.folder / "a.ppm").stat().st_size, 3 * 2000 * 2000)

    def test_no_viewer(self):
        with socket.create_server(("127.0.0.1", 0)) as listener:
            port = listener.getsockname()[1]
        message = self.draw(f"127.0.0.1:{port}", *LIGHT, "-o", "a.ppm", code=5)
        self.assertIn(b"--display-server: 127.0.0.1 port", message)
        self.assertIn(b"Connection refused; start tev first", message)
        self.draw("nowhere.invalid:1", *LIGHT, "-o", "a.ppm", code=5)
        for address in (":1", "localhost", "localhost:", "localhost:0", "localhost:65536", "localhost:x", "::1:5", "[::1]"):
            self.assertIn(b"HOST:PORT", self.draw(address, *LIGHT, "-o", "a.ppm", code=2))
        self.assertFalse((self.folder / "a.ppm").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
