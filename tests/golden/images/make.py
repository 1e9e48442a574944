#!/usr/bin/env python3
"""Writes the images in the folders beside this script. Together they reach the SIMD code of the decoders: every chroma
subsampling, sizes that are not multiples of a block, progressive scans and restarts, loop filters, and alpha. Needs
libjpeg-turbo-progs and webp.
"""

import math
import random
import struct
import subprocess
import zlib
from pathlib import Path

FOLDER = Path(__file__).parent
WIDTH, HEIGHT = 131, 37
CJPEG = {
    "444": "-sample 1x1",
    "422": "-sample 2x1",
    "440": "-sample 1x2",
    "420": "-sample 2x2",
    "411": "-sample 4x1",
    "420_progressive": "-sample 2x2 -progressive -quality 60",
    "444_progressive": "-sample 1x1 -progressive -quality 95",
    "422_restart": "-sample 2x1 -restart 1 -quality 30",
    "420_coarse": "-sample 2x2 -quality 4",
    "420_fine": "-sample 2x2 -quality 100",
    "arithmetic": "-sample 2x2 -arithmetic",
    "gray": "-grayscale",
    "rgb": "-rgb -quality 90",
}
CWEBP = {
    "lossy": "-q 75",
    "fine": "-q 100 -f 0",
    "coarse": "-q 5 -f 100 -sharpness 0 -strong",
    "simple_filter": "-q 30 -f 80 -nostrong",
    "sharp_filter": "-q 40 -f 60 -sharpness 7 -segments 1",
    "alpha": "-q 60 -alpha_q 100 -alpha_filter best",
    "coarse_alpha": "-q 60 -alpha_q 20",
    "raw_alpha": "-q 60 -alpha_method 0",
    "lossless": "-lossless -m 6",
    "near_lossless": "-near_lossless 40",
}
SMALL = [(1, 1), (2, 3), (5, 1), (17, 16)]


def pixel(x, y, noise):
    """Returns a pixel. The picture has smooth, striped and noisy parts with hard edges between them."""
    if (x - 40) ** 2 + (y - 18) ** 2 < 150:
        return (255, 0, 255 * ((x + y) % 2))
    if x > 90:
        return tuple(noise.randrange(256) for _ in range(3))
    return (2 * x % 256, round(127.5 + 127.5 * math.sin(0.3 * x + 0.2 * y)), 7 * y % 256)


def rows_of(width, height, alpha):
    noise = random.Random(1)
    return [[(*pixel(x, y, noise), (x * 4 + y * 3) % 256 if x % 40 > 8 else 0)[:4 if alpha else 3] for x in range(width)]
            for y in range(height)]


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def predict(kind, left, above, corner):
    """Computes the predictor of a PNG filter (ISO/IEC 15948, section 9.2)."""
    if kind == 4:
        p = left + above - corner
        return min((abs(p - left), 0, left), (abs(p - above), 1, above), (abs(p - corner), 2, corner))[2]
    return (0, left, above, (left + above) // 2)[kind]


def png(rows, color_type, depth=8):
    """Returns a PNG file whose rows use all five filters in turn. Each row is a list of tuples of samples."""
    size = len(rows[0][0]) * depth // 8
    lines = [b"".join(struct.pack(f">{len(p)}{'BH'[depth == 16]}", *p) for p in row) for row in rows]
    data, above = b"", bytes(len(lines[0]))
    for y, line in enumerate(lines):
        kind = y % 5
        data += bytes([kind]) + bytes(
            (byte - predict(kind, line[i - size] if i >= size else 0, above[i], above[i - size] if i >= size else 0)) % 256
            for i, byte in enumerate(line))
        above = line
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), depth, color_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b"")


def ppm(rows):
    return b"P6\n%d %d\n255\n" % (len(rows[0]), len(rows)) + bytes(c for row in rows for p in row for c in p)


def write(name, command, given):
    result = subprocess.run(command, input=given, capture_output=True, check=True)
    (FOLDER / name).write_bytes(result.stdout)


def main():
    for name in ("jpeg", "webp", "png"):
        (FOLDER / name).mkdir(exist_ok=True)
    color, with_alpha = rows_of(WIDTH, HEIGHT, False), rows_of(WIDTH, HEIGHT, True)
    for name, options in CJPEG.items():
        write(f"jpeg/{name}.jpg", ["cjpeg", *options.split()], ppm(color))
    for name, options in CWEBP.items():
        has_alpha = "alpha" in name or "lossless" in name
        write(f"webp/{name}.webp", ["cwebp", "-quiet", *options.split(), "-o", "-", "--", "-"],
              png(with_alpha, 6) if has_alpha else png(color, 2))
    for width, height in SMALL:
        small = rows_of(width, height, True)
        write(f"jpeg/{width}x{height}.jpg", ["cjpeg", "-sample", "2x2"], ppm([[p[:3] for p in row] for row in small]))
        write(f"webp/{width}x{height}.webp", ["cwebp", "-quiet", "-o", "-", "--", "-"], png(small, 6))
    (FOLDER / "png/rgb.png").write_bytes(png(color, 2))
    (FOLDER / "png/rgba.png").write_bytes(png(with_alpha, 6))
    (FOLDER / "png/gray_alpha.png").write_bytes(png([[p[2:] for p in row] for row in with_alpha], 4))
    (FOLDER / "png/sixteen_bits.png").write_bytes(png([[tuple(257 * c ^ 85 for c in p) for p in row[:40]] for row in color], 2, 16))


if __name__ == "__main__":
    main()
