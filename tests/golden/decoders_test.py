#!/usr/bin/env python3
"""Decodes the images of images/ and ../image/ktx2 with each kind of SIMD code and without any. Compares the samples with
the SHA-256 digests in images/sha256.txt.

usage: decoders_test.py DECODE_IMAGES MODULE [--update]

DECODE_IMAGES may be a script that runs the program on another machine. The specifications that libjpeg-turbo and libwebp
implement do not define how chroma is upsampled, so other versions of these libraries may decode different samples. --update
rewrites the list.
"""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
FOLDERS = ["golden/images/jpeg", "golden/images/png", "golden/images/webp", "image/ktx2"]
LIST = TESTS / "golden/images/sha256.txt"
WAYS = {
    "as users": ({}, []),
    "SSE2": ({"JSIMD_FORCESSE2": "1"}, []),
    "no vectors": ({"JSIMD_FORCENONE": "1"}, ["--plain"]),
}


def decode(image, environment, options):
    result = subprocess.run([os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), image, *options],
                            env=dict(os.environ, **environment), capture_output=True, check=False)
    if result.returncode != 0 or result.stderr:
        sys.exit(f"{image}: exit code {result.returncode}, {result.stderr.decode()}")
    return hashlib.sha256(result.stdout).hexdigest()


def main():
    images = sorted(image for folder in FOLDERS for image in (TESTS / folder).iterdir())
    if "--update" in sys.argv[3:]:
        LIST.write_text("".join(f"{decode(image, {}, [])}  {image.relative_to(TESTS)}\n" for image in images))
    pins = {name: digest for digest, name in (line.split() for line in LIST.read_text().splitlines())}
    assert len(pins) == len(images) > 40
    faults = 0
    for image in images:
        for way, (environment, options) in WAYS.items():
            if decode(image, environment, options) != pins[str(image.relative_to(TESTS))]:
                faults += 1
                print(f"DIFFERENT  {image.relative_to(TESTS)}: {way}")
    print(f"{len(images)} images, {len(WAYS)} ways each")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
