"""Reads, writes and runs the command lines of questions.txt."""

import ctypes
import dataclasses
import hashlib
import json
import os
import re
import shlex
import struct
import subprocess
import tempfile
from pathlib import Path

LIST = Path(__file__).with_name("questions.txt")
SCENES = Path(__file__).resolve().parents[2] / "scenes"
PIXEL_BYTES, BLOCK_PIXELS = 84, 4096  # see src/io/checkpoint/pixel_blocks.hpp


@dataclasses.dataclass
class Question:
    """A command line and the hashes of its outputs. has_light is true if the picture is path traced and can write a
    checkpoint."""

    text: str
    pins: dict  # hash by name: "picture", and "samples" if path traced

    @property
    def has_light(self):
        return "samples" in self.pins


def read():
    """Returns the comment at the beginning of the list, and the list's questions."""
    head, questions = [], []
    for line in LIST.read_text(encoding="ascii").splitlines():
        if line.startswith("#"):
            head.append(line)
        elif line.startswith("  "):
            name, digest = line.split()
            questions[-1].pins[name] = digest
        elif line:
            questions.append(Question(line, {}))
    return head, questions


def write(head, questions):
    lines = [*head, ""]
    for question in questions:
        lines += [question.text, *(f"  {name} {question.pins[name]}" for name in ("picture", "samples") if name in question.pins)]
    LIST.write_text("\n".join(lines) + "\n", encoding="ascii")


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def decompress(frame, size):
    """Returns the bytes of a Zstandard frame."""
    library = ctypes.CDLL("libzstd.so.1")
    library.ZSTD_decompress.restype = ctypes.c_size_t
    library.ZSTD_decompress.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]
    content = ctypes.create_string_buffer(size)
    assert library.ZSTD_decompress(content, size, frame, len(frame)) == size
    return content.raw


def samples_of(checkpoint):
    """Returns the sums of a checkpoint's pixels, pixel by pixel. The format is described in
    src/io/checkpoint/checkpoint.cpp."""
    at = len(b"microtrace samples\n") + 4
    (identity,) = struct.unpack_from("<I", checkpoint, at)
    at += 4 + identity + 3 * 4 + 4 + 8 + 4 + 8
    x0, y0, x1, y1 = struct.unpack_from("<4I", checkpoint, at)
    at += 4 * 4 + 3 * 4
    (ranges,) = struct.unpack_from("<I", checkpoint, at)
    at += 4 + 8 * ranges
    samples = bytearray()
    for first in range(0, (x1 - x0) * (y1 - y0), BLOCK_PIXELS):
        pixels = min(BLOCK_PIXELS, (x1 - x0) * (y1 - y0) - first)
        (size,) = struct.unpack_from("<I", checkpoint, at)
        planes = checkpoint[at + 4:at + 4 + size]
        at += 4 + size
        if size < pixels * PIXEL_BYTES:
            planes = decompress(planes, pixels * PIXEL_BYTES)
        block = bytearray(len(planes))
        for byte in range(PIXEL_BYTES):
            block[byte::PIXEL_BYTES] = planes[byte * pixels:(byte + 1) * pixels]
        samples += block
    assert at == len(checkpoint) - 4 - 8  # the number of channels and the digest
    return bytes(samples)


class MissingModule(Exception):
    """The program lacks a module that reads or writes the question's images."""


def ask(program, question, threads=1, isa=None, with_samples=True):
    """Returns the hashes of the program's outputs, with the same names as in pins. Checks that a path-traced picture casts
    path and shadow rays. Raises MissingModule if an image can't be read or written."""
    command = [program, *shlex.split(question.text), "--threads", str(threads)]
    environment = dict(os.environ)
    if isa:
        environment["MICROTRACE_ISA"] = isa
    with tempfile.TemporaryDirectory() as folder:
        checkpoint = Path(folder) / "samples"
        if question.has_light:
            command.append("--stats=json")
            if with_samples:
                command += ["--checkpoint", checkpoint]
        result = subprocess.run(command, capture_output=True, cwd=SCENES, env=environment)
        if re.search(rb"the module \S+ is not in ", result.stderr):
            raise MissingModule(question.text)
        if result.returncode != 0 or not result.stdout:
            raise RuntimeError(f"{question.text}: exit code {result.returncode}\n{result.stderr.decode()}")
        answer = {"picture": sha256(result.stdout)}
        if question.has_light:
            statistics = next(line for line in result.stderr.decode().splitlines() if line.startswith("{"))
            rays = json.loads(statistics)["rays_by_kind"]
            for kind in ("camera", "path", "shadow"):
                if rays[kind]["rays"] == 0:
                    raise RuntimeError(f"{question.text}: casts no {kind} rays, so it compares no light")
            if with_samples:
                answer["samples"] = sha256(samples_of(checkpoint.read_bytes()))
    return answer
