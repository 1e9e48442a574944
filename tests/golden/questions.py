"""Reads, writes and runs the command lines of questions.txt."""

import dataclasses
import hashlib
import json
import os
import shlex
import subprocess
import tempfile
from pathlib import Path

LIST = Path(__file__).with_name("questions.txt")
SCENES = Path(__file__).resolve().parents[2] / "scenes"
PIXEL_BYTES, DIGEST_BYTES = 84, 8  # sizes in a checkpoint, see src/io/checkpoint/checkpoint.cpp


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


def samples_of(checkpoint, picture):
    """Returns the bytes of a checkpoint's pixels. Their number is that of the PPM picture's pixels."""
    width, height = map(int, picture.split(maxsplit=3)[1:3])
    size = width * height * PIXEL_BYTES
    assert len(checkpoint) > size + DIGEST_BYTES
    return checkpoint[-size - DIGEST_BYTES:-DIGEST_BYTES]


def ask(program, question, threads=1, isa=None, with_samples=True):
    """Returns the hashes of the program's outputs, with the same names as in pins. Checks that a path-traced picture casts
    path and shadow rays."""
    command = [program, *shlex.split(question.text), "--threads", str(threads)]
    environment = dict(os.environ)
    if isa:
        environment["MICROTRACE_ISA"] = isa
    with tempfile.TemporaryDirectory() as folder:
        checkpoint = Path(folder) / "samples"
        if question.has_light:
            command += ["--quiet", "--stats=json"]
            if with_samples:
                command += ["--checkpoint", checkpoint]
        result = subprocess.run(command, capture_output=True, cwd=SCENES, env=environment)
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
                answer["samples"] = sha256(samples_of(checkpoint.read_bytes(), result.stdout))
    return answer
