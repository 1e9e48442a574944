"""Runs `microtrace view` for the tests in this folder, and sends requests to it."""

import http.client
import json
import os
import signal
import struct
import subprocess
import time
import zlib


def read_png(data):
    """Returns width, height and the samples of an 8-bit color picture that is not interlaced, row by row."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:80]
    position, compressed = 8, b""
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        content = data[position + 8:position + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlaced = struct.unpack(">2I5B", content)
            assert (depth, interlaced) == (8, 0)
        elif kind == b"IDAT":
            compressed += content
        position += length + 12
    channels = {2: 3, 6: 4}[color]
    raw, stride = zlib.decompress(compressed), channels * width
    above, rows = bytearray(stride), []
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            left = row[i - channels] if i >= channels else 0
            corner = above[i - channels] if i >= channels else 0
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + above[i]) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + above[i]) // 2) & 255
            elif kind == 4:
                guess = left + above[i] - corner
                nearest = min((left, above[i], corner), key=lambda value: abs(guess - value))
                row[i] = (row[i] + nearest) & 255
        rows.append(bytes(row))
        above = row
    return width, height, b"".join(rows)


class Response:
    def __init__(self, status, headers, body):
        self.status, self.headers, self.body = status, headers, body

    @property
    def json(self):
        return json.loads(self.body)

    @property
    def picture(self):
        return json.loads(self.headers["Microtrace-Picture"])


class Viewer:
    """The program with a page. Use it in a with statement."""

    def __init__(self, program, *arguments, folder=None):
        environment = dict(os.environ, ASAN_OPTIONS="detect_leaks=0")
        self.process = subprocess.Popen([program, "view", *map(str, arguments), "--no-browser"], cwd=folder, env=environment,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise AssertionError(self.process.communicate()[1])
        host, self.token, rest = self.address.removeprefix("http://").split("/")
        assert rest == ""
        self.port = int(host.split(":")[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=60)

    def request(self, method, path, body=None, headers=None, whole_path=None, timeout=60):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            body = body.encode() if isinstance(body, str) else body
            connection.request(method, f"/{self.token}/{path}" if whole_path is None else whole_path, body, headers or {})
            answer = connection.getresponse()
            return Response(answer.status, answer.headers, answer.read())
        finally:
            connection.close()

    def open(self, scene=0):
        """Opens a picture and returns its path."""
        return "pictures/" + self.request("POST", f"pictures?scene={scene}").json["id"]

    def draw(self, words, path=None, moving=False):
        """Requests a picture; returns all responses up to the last one, or to the first preview if the camera is moving."""
        path = path or self.open()
        answer = self.request("PUT", path + ("?moving" if moving else ""), "\n".join(words))
        assert answer.status == 200, answer.body
        number, after, responses = answer.json["request"], 0, []
        while True:
            response = self.request("GET", f"{path}?after={after}")
            if response.status == 204:
                continue
            assert response.status == 200, response.body
            after = response.picture["sequence"]
            if response.picture["request"] < number:
                continue
            responses.append(response)
            if response.picture["done"] or moving:
                return responses

    def memory(self):
        """Returns the resident memory in bytes."""
        with open(f"/proc/{self.process.pid}/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def wait_until(condition, seconds=30):
    """Returns the first true result of condition()."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.05)
    raise AssertionError("timeout")
