#!/usr/bin/env python3
"""Renders scenes/gltf/textures.glb independently in float64, to check the renderer's picture.

    textures_reference.py ASSET PPM

The asset's rectangles face an orthographic camera, so texture coordinates are linear functions of the pixel position, and
footprints are constant. Follows docs/gltf.md ("How textures are filtered"): bilinear filters in linear light, mip maps of
area means, a linear blend of two mip maps by the width of the footprint, and several lookups along its longer side. Shares
no code with the renderer, and rounds only the final number. A pixel may differ by 1 of 255. Pixels are not compared where
the mask's alpha is within 1e-4 of its cutoff. The exit status is 1 if any other pixel differs, or if more than one pixel in
200 differs at all.
"""
import json
import math
import struct
import sys
import zlib

WIDTH, HEIGHT, PIXELS_PER_UNIT = 640, 480, 80
MIRRORED = 33648


def read_glb(path):
    data = open(path, "rb").read()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), data[28 + length:]


def linear(byte):
    v = byte / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def srgb(v):
    v = min(max(v, 0), 1)
    return 255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)


def read_png(data):
    """Returns rows of pixels in linear light with alpha. The file's rows must not be filtered."""
    size, pixels, at = struct.unpack_from(">I", data, 16)[0], b"", 8
    channels = {2: 3, 6: 4}[data[25]]
    while at < len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        if name == b"IDAT":
            pixels += data[at + 8:at + 8 + length]
        at += length + 12
    pixels = zlib.decompress(pixels)
    rows = []
    for y in range(size):
        row = pixels[y * (channels * size + 1):][:channels * size + 1]
        assert row[0] == 0
        texels = [row[1 + channels * x:1 + channels * (x + 1)] for x in range(size)]
        rows.append([[*map(linear, t[:3]), t[3] / 255 if channels == 4 else 1.0] for t in texels])
    return rows


def mip_maps(image):
    """Returns the mip maps: the image, and for each further level the means over 2 x 2 texels. The image's sides must be
    powers of 2."""
    levels = [image]
    while len(image) > 1:
        half = len(image) // 2
        image = [[[sum(image[2 * y + j][2 * x + i][c] for j in (0, 1) for i in (0, 1)) / 4 for c in range(4)]
                  for x in range(half)] for y in range(half)]
        levels.append(image)
    return levels


def mix(a, b, t):
    return [(1 - t) * p + t * q for p, q in zip(a, b)]


class Texture:
    def __init__(self, asset, data, index):
        texture = asset["textures"][index]
        sampler = asset["samplers"][texture["sampler"]]
        self.mirrors_u = sampler["wrapS"] == MIRRORED
        view = asset["bufferViews"][asset["images"][texture["source"]]["bufferView"]]
        start = view["byteOffset"]
        self.levels = mip_maps(read_png(data[start:start + view["byteLength"]]))

    def texel(self, level, x, y):
        size = len(level)
        if self.mirrors_u and x // size % 2:
            x = -1 - x
        return level[y % size][x % size]

    def bilinear(self, number, u, v):
        level = self.levels[number]
        x, y = u * len(level) - 0.5, v * len(level) - 0.5
        i, j = math.floor(x), math.floor(y)
        row = lambda k: mix(self.texel(level, i, k), self.texel(level, i + 1, k), x - i)
        return mix(row(j), row(j + 1), y - j)

    def one(self, u, v, width):
        """Returns the filtered color for a square footprint with sides of `width` texels."""
        if width <= 1:
            return self.bilinear(0, u, v)
        level = int(math.log2(width))
        blend = width / 2 ** level - 1
        return mix(self.bilinear(level, u, v), self.bilinear(level + 1, u, v), blend)

    def look_up(self, u, v, du, dv):
        """Returns the filtered color for a footprint of du by dv. du is the step in u to the next pixel in a row, dv is the
        step in v to the next row."""
        across, down = abs(du) * len(self.levels[0]), abs(dv) * len(self.levels[0])
        longer, shorter = max(across, down), max(min(across, down), 1)
        if longer <= 1:
            return self.bilinear(0, u, v)
        places = min(math.ceil(longer / shorter - 2 ** -10), 8)
        step = (du / places, 0) if across > down else (0, dv / places)
        found = [self.one(u + (i - (places - 1) / 2) * step[0], v + (i - (places - 1) / 2) * step[1], longer / places)
                 for i in range(places)]
        return [sum(c) / places for c in zip(*found)]


def rectangle(asset, data, mesh):
    """Returns the rectangle of pixels (x0, y0, x1, y1), u and v in its upper left corner, their steps to the next pixel,
    and the material."""
    primitive = mesh["primitives"][0]

    def values(name, count):
        accessor = asset["accessors"][primitive["attributes"][name]]
        start = asset["bufferViews"][accessor["bufferView"]]["byteOffset"]
        return [struct.unpack_from(f"<{count}f", data, start + 4 * count * i) for i in range(4)]

    corners = values("POSITION", 3)
    x0, y1 = WIDTH / 2 + PIXELS_PER_UNIT * corners[0][0], HEIGHT / 2 - PIXELS_PER_UNIT * corners[0][1]
    x1, y0 = WIDTH / 2 + PIXELS_PER_UNIT * corners[2][0], HEIGHT / 2 - PIXELS_PER_UNIT * corners[2][1]
    place = (0, 0, 0, 0)
    if "TEXCOORD_0" in primitive["attributes"]:
        (u0, v1), _, (u1, v0), _ = values("TEXCOORD_0", 2)
        place = (u0, v0, (u1 - u0) / (x1 - x0), (v1 - v0) / (y1 - y0))
    return tuple(map(round, (x0, y0, x1, y1))), place, asset["materials"][primitive["material"]]


def main():
    asset, data = read_glb(sys.argv[1])
    magic, size, _, pixels = open(sys.argv[2], "rb").read().split(b"\n", 3)
    assert magic == b"P6" and size == b"%d %d" % (WIDTH, HEIGHT)
    picture = lambda x, y: pixels[3 * (WIDTH * y + x):][:3]
    wrong = differ = judged = 0
    *front, behind = [rectangle(asset, data, mesh) for mesh in asset["meshes"]]
    gray = behind[2]["pbrMetallicRoughness"]["baseColorFactor"]
    assert behind[0] == front[2][0], "stands behind the mask alone"
    inside = set()
    for (x0, y0, x1, y1), (u0, v0, du, dv), material in front:
        surface = material["pbrMetallicRoughness"]
        texture = Texture(asset, data, surface["baseColorTexture"]["index"])
        for y in range(y0, y1):
            for x in range(x0, x1):
                inside.add((x, y))
                texel = texture.look_up(u0 + (x - x0 + 0.5) * du, v0 + (y - y0 + 0.5) * dv, du, dv)
                color = [a * b for a, b in zip(texel, surface["baseColorFactor"])]
                if "alphaCutoff" in material:
                    above = color[3] - material["alphaCutoff"]
                    if abs(above) < 1e-4:
                        continue
                    color = color if above > 0 else gray
                judged += 1
                errors = [abs(p - srgb(c)) for p, c in zip(picture(x, y), color)]
                differ += max(errors) > 0.5
                if max(errors) > 1:
                    wrong += 1
                    if wrong < 10:
                        print(f"pixel {x} {y} is {list(picture(x, y))}, wanted {[round(srgb(c), 2) for c in color[:3]]}")
    for y in range(HEIGHT):
        for x in range(WIDTH):
            if (x, y) not in inside and picture(x, y) != b"\0\0\0":
                wrong += 1
                print(f"pixel {x} {y} should be black")
    print(f"{judged} pixels judged, {differ} rounded otherwise, {wrong} wrong")
    sys.exit(1 if wrong or differ > judged / 200 or judged < 100000 else 0)


if __name__ == "__main__":
    main()
