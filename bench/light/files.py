"""Writes the files that both renderers read (PNG, Radiance HDR, PLY and GLB), with no library but numpy."""
import json
import struct
import zlib

import numpy as np


def write_png(path, pixels):
    """pixels: uint8, rows x columns (gray) or rows x columns x 3."""
    height, width = pixels.shape[:2]
    channels = 1 if pixels.ndim == 2 else 3
    rows = pixels.reshape(height, width * channels)
    up = np.empty((height, width * channels + 1), np.uint8)  # PNG filter 2 (Up): the difference from the row above
    up[:, 0] = 2
    up[0, 1:] = rows[0]
    up[1:, 1:] = rows[1:] - rows[:-1]

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 0 if channels == 1 else 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header))
        file.write(chunk(b"IDAT", zlib.compress(up.tobytes(), 6)) + chunk(b"IEND", b""))


def write_hdr(path, pixels):
    """pixels: float, rows x columns x 3, linear. They are stored with 8 bits per channel and a common exponent."""
    height, width = pixels.shape[:2]
    mantissa, exponent = np.frexp(pixels.max(axis=2))
    scale = np.where(pixels.max(axis=2) > 0, mantissa * 256 / np.maximum(pixels.max(axis=2), 1e-38), 0)
    out = np.zeros((height, width, 4), np.uint8)
    out[..., :3] = np.minimum(pixels * scale[..., None], 255)
    out[..., 3] = np.where(scale > 0, exponent + 128, 0)
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
        file.write(out.tobytes())


def write_ply(path, mesh):
    """mesh: positions, normals (n x 3), uvs (n x 2), triangles (m x 3)."""
    names = ("x", "y", "z", "nx", "ny", "nz", "u", "v")
    columns = [mesh["positions"]]
    if "normals" in mesh:
        columns += [mesh["normals"], mesh["uvs"]]
    vertices = np.hstack(columns).astype("<f4")
    faces = np.empty(len(mesh["triangles"]), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    faces["n"], faces["corners"] = 3, mesh["triangles"]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
    header += [f"property float {name}" for name in names[: vertices.shape[1]]]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    with open(path, "wb") as file:
        file.write(("\n".join(header) + "\n").encode() + vertices.tobytes() + faces.tobytes())


class Glb:
    """Builds a glTF asset with a single buffer."""

    def __init__(self):
        self.document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}
        self.data = bytearray()

    def add(self, kind, entry):
        """Appends an entry to the list of this kind and returns its index."""
        entries = self.document.setdefault(kind, [])
        entries.append(entry)
        return len(entries) - 1

    def add_node(self, **node):
        self.document["scenes"][0]["nodes"].append(self.add("nodes", node))

    def view(self, data):
        self.data += bytes(-len(self.data) % 4)
        entry = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.data += data
        return self.add("bufferViews", entry)

    def accessor(self, array, bounds=False):
        index = array.ndim == 1
        array = np.ascontiguousarray(array, "<u4" if index else "<f4")
        entry = {"bufferView": self.view(array.tobytes()), "count": len(array),
                 "componentType": 5125 if index else 5126,
                 "type": "SCALAR" if index else f"VEC{array.shape[1]}"}
        if bounds:
            entry |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        return self.add("accessors", entry)

    def texture(self, path):
        image = {"bufferView": self.view(path.read_bytes()), "mimeType": "image/png"}
        return {"index": self.add("textures", {"source": self.add("images", image)})}

    def primitive(self, mesh, material):
        attributes = {"POSITION": self.accessor(mesh["positions"], bounds=True)}
        for key, name in (("normals", "NORMAL"), ("uvs", "TEXCOORD_0"), ("tangents", "TANGENT")):
            if key in mesh:
                attributes[name] = self.accessor(mesh[key])
        indices = self.accessor(np.asarray(mesh["triangles"]).reshape(-1))
        return {"attributes": attributes, "indices": indices, "material": material}

    def write(self, path):
        self.document["buffers"] = [{"byteLength": len(self.data)}]
        text = json.dumps(self.document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.data) + bytes(-len(self.data) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data)))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", len(data), b"BIN\0") + data)
