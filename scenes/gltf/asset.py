"""What the scenes of this folder are written with: the asset's JSON and buffer, PNG files, vectors."""

import json
import math
import struct
import zlib


def extensions_in(value):
    """The names of all extensions that a JSON value uses."""
    if isinstance(value, dict):
        yield from value.get("extensions", {})
        for part in value.values():
            yield from extensions_in(part)
    elif isinstance(value, list):
        for part in value:
            yield from extensions_in(part)


class Asset:
    """Collects the JSON and the buffer of one asset."""

    def __init__(self, flat=None):
        """flat: the base colors, by name, of materials without light."""
        self.buffer = b""
        self.flat = dict(flat or {})
        self.json = {
            "asset": {"version": "2.0", "generator": "microtrace scenes/gltf/make.py"},
            "extensionsUsed": [],
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
            "meshes": [],
            "materials": [
                {
                    "name": name,
                    "pbrMetallicRoughness": {"baseColorFactor": [*color, 1]},
                    "extensions": {"KHR_materials_unlit": {}},
                }
                for name, color in self.flat.items()
            ],
            "accessors": [],
            "bufferViews": [],
        }

    def add(self, array, item):
        self.json.setdefault(array, []).append(item)
        return len(self.json[array]) - 1

    def view(self, data, target=None):
        """A view of these bytes; target says which attributes or indices they are, if they are any."""
        self.buffer += b"\0" * (-len(self.buffer) % 4)
        view = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.buffer += data
        return self.add("bufferViews", view)

    def numbers(self, kind, tuples, target=34962):
        """An accessor of float32 tuples, vertex attributes unless target is None."""
        data = b"".join(struct.pack(f"<{len(t)}f", *t) for t in tuples)
        return self.add("accessors", {"bufferView": self.view(data, target), "componentType": 5126, "type": kind,
                                      "count": len(tuples)})

    def texture(self, name, png, sampler):
        view = self.view(png)
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": view})
        return self.add("textures", {"name": name, "source": image, "sampler": self.add("samplers", sampler)})

    def positions(self, points):
        data = b"".join(struct.pack("<3f", *p) for p in points)
        stored = [struct.unpack_from("<3f", data, 12 * i) for i in range(len(points))]
        return self.add("accessors", {
            "bufferView": self.view(data, 34962), "componentType": 5126, "type": "VEC3",
            "count": len(points),
            "min": [min(p[k] for p in stored) for k in range(3)],
            "max": [max(p[k] for p in stored) for k in range(3)],
        })

    def indices(self, triangles):
        flat = [i for t in triangles for i in t]
        data = struct.pack(f"<{len(flat)}H", *flat)
        return self.add("accessors", {
            "bufferView": self.view(data, 34963), "componentType": 5123, "type": "SCALAR",
            "count": len(flat),
        })

    def mesh(self, name, points, triangles_by_color):
        positions = self.positions(points)
        primitives = [
            {"attributes": {"POSITION": positions}, "indices": self.indices(triangles),
             "material": list(self.flat).index(color)}
            for color, triangles in triangles_by_color.items()
        ]
        mesh = self.add("meshes", {"name": name, "primitives": primitives})
        self.node({"name": name, "mesh": mesh})

    def node(self, node):
        self.json["scenes"][0]["nodes"].append(self.add("nodes", node))

    def write(self, path):
        self.json["extensionsUsed"] = sorted(set(extensions_in(self.json)))
        self.json["buffers"] = [{"byteLength": len(self.buffer)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = self.buffer + b"\0" * (-len(self.buffer) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def subtract(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def png(size, channels, pixel):
    """A square PNG file of pixel(x, y), 8 bits a channel."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(size)) for y in range(size))
    header = struct.pack(">IIBBBBB", size, size, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9))
            + chunk(b"IEND", b""))
