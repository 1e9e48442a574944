#!/usr/bin/env python3
"""Writes the seeds and dictionaries of the fuzz targets.

usage: make_seeds.py PROJECT_FOLDER FOLDER

Each format gets a folder of small files and a dictionary FORMAT.dict. glTF assets with a binary chunk are written in the
fuzz target's special form: JSON, a zero byte, and the chunk.
"""

import base64
import json
import shutil
import struct
import sys
import zlib
from pathlib import Path

sys.dont_write_bytecode = True
import image_seeds

GLTF_WORDS = """
asset version minVersion generator extensionsUsed extensionsRequired extensions extras scene scenes nodes children mesh
meshes primitives attributes POSITION NORMAL TANGENT TEXCOORD_0 TEXCOORD_1 COLOR_0 JOINTS_0 WEIGHTS_0 indices mode targets
weights material materials pbrMetallicRoughness baseColorFactor baseColorTexture metallicFactor roughnessFactor
metallicRoughnessTexture normalTexture occlusionTexture emissiveTexture emissiveFactor strength index texCoord alphaMode OPAQUE MASK BLEND
alphaCutoff doubleSided textures source sampler samplers magFilter minFilter wrapS wrapT images uri mimeType image/png
image/jpeg bufferView bufferViews buffer buffers byteOffset byteLength byteStride target accessors componentType
normalized count type SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4 min max sparse values cameras camera perspective orthographic yfov znear
zfar aspectRatio xmag ymag skins skin joints inverseBindMatrices skeleton animations channels samplers node path translation
rotation scale matrix input output interpolation LINEAR STEP CUBICSPLINE name variants mappings mode
KHR_materials_unlit KHR_texture_transform offset KHR_lights_punctual lights light directional spot point intensity color
range innerConeAngle outerConeAngle KHR_mesh_quantization KHR_draco_mesh_compression EXT_mesh_gpu_instancing TRANSLATION ROTATION SCALE
EXT_meshopt_compression KHR_meshopt_compression ATTRIBUTES TRIANGLES INDICES filter fallback OCTAHEDRAL QUATERNION EXPONENTIAL COLOR
KHR_materials_variants KHR_node_visibility visible KHR_animation_pointer pointer KHR_texture_basisu EXT_texture_webp
KHR_materials_emissive_strength emissiveStrength KHR_materials_clearcoat KHR_materials_transmission KHR_materials_ior
data:application/octet-stream;base64, data:image/png;base64, 5120 5121 5122 5123 5125 5126 34962 34963 4294967295 2147483648
1e38 1e-45 -1 null true false
"""


def words_of_schema(value):
    """Returns all property names and enumeration values of a JSON schema."""
    if isinstance(value, dict):
        for key, part in value.items():
            if key == "properties":
                yield from part
            yield from words_of_schema(part)
    elif isinstance(value, list):
        for part in value:
            yield from [part] if isinstance(part, str) else words_of_schema(part)
    elif isinstance(value, str) and value.isidentifier():
        yield value


def dictionary(words):
    lines = []
    for word in dict.fromkeys(words):
        quoted = word if word.lstrip("-")[:1].isdigit() or word in ("null", "true", "false") else f'"{word}"'
        lines.append('"' + quoted.replace("\\", "\\\\").replace('"', '\\"') + '"')
    return "\n".join(lines) + "\n"


def png(width, height, depth=8, color=6, interlaced=0, **more):
    """Returns a PNG image, by default with 8-bit RGBA pixels. `more` has chunks that precede the pixels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    row = -(-width * depth * {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[color] // 8)
    rows = b"".join(bytes([y % 5]) + bytes((40 * x + 90 * y) % 256 for x in range(row)) for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, interlaced)
    before = b"".join(chunk(kind.encode(), data) for kind, data in more.items())
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + before + chunk(b"IDAT", zlib.compress(rows))
            + chunk(b"IEND", b""))


def images():
    """Returns image files of all kinds, by name."""
    palette = {"PLTE": bytes(range(48)), "tRNS": b"\0\x80\xff"}
    files = {"grey1.png": png(19, 9, 1, 0), "grey16.png": png(5, 4, 16, 0, tRNS=b"\0\1"), "rgb.png": png(6, 5, 8, 2),
             "palette2.png": png(9, 5, 2, 3, **palette), "palette4.png": png(9, 5, 4, 3, **palette),
             "grey_alpha.png": png(4, 4, 8, 4), "rgba16.png": png(3, 3, 16, 6, gAMA=b"\0\1\x86\xa0"),
             "interlaced.png": png(1, 1, 8, 6, 1)}
    return files | image_seeds.decoded()


class Asset:
    """The JSON and the buffer of an asset that has a camera, and a node with a quadrilateral."""

    def __init__(self):
        self.buffer = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}]}
        self.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]
        self.json["nodes"] = [{"camera": 0, "translation": [0, 0, 3]}, {"mesh": 0}]
        points = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
        self.primitive = {"attributes": {"POSITION": self.accessor("3f", "VEC3", points)},
                          "indices": self.accessor("H", "SCALAR", [(k,) for k in (0, 1, 2, 0, 2, 3)])}
        self.json["meshes"] = [{"primitives": [self.primitive]}]

    def add(self, array, item):
        self.json.setdefault(array, []).append(item)
        return len(self.json[array]) - 1

    def view(self, data, **more):
        self.buffer += b"\0" * (-len(self.buffer) % 4)
        self.buffer += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.buffer) - len(data), "byteLength": len(data), **more})

    def accessor(self, code, kind, rows, **more):
        kinds = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}
        data = b"".join(struct.pack("<" + code, *row) for row in rows)
        limits = {"min": list(map(min, zip(*rows))), "max": list(map(max, zip(*rows)))}
        return self.add("accessors", {"bufferView": self.view(data), "componentType": kinds[code[-1]], "count": len(rows),
                                      "type": kind, **limits, **more})

    def attribute(self, name, code, kind, rows, **more):
        self.primitive["attributes"][name] = self.accessor(code, kind, rows, **more)

    def uses(self, extension, required=False):
        self.add("extensionsUsed", extension)
        if required:
            self.add("extensionsRequired", extension)

    def packed(self):
        self.json["buffers"] = [{"byteLength": len(self.buffer)}]
        return json.dumps(self.json, separators=(",", ":")).encode() + b"\0" + self.buffer

    def embedded(self):
        text = base64.b64encode(self.buffer).decode()
        self.json["buffers"] = [{"byteLength": len(self.buffer), "uri": "data:application/octet-stream;base64," + text}]
        return json.dumps(self.json, indent=1).encode()


def plain():
    return Asset()


def textured():
    asset = Asset()
    asset.attribute("TEXCOORD_0", "2f", "VEC2", [(0, 0), (1, 0), (1, 1), (0, 1)])
    asset.attribute("NORMAL", "3f", "VEC3", [(0, 0, 1)] * 4)
    asset.attribute("TANGENT", "4f", "VEC4", [(1, 0, 0, 1)] * 4)
    asset.attribute("COLOR_0", "4B", "VEC4", [(255, 0, 0, 255), (0, 255, 0, 128), (0, 0, 255, 0), (9, 9, 9, 9)], normalized=True)
    asset.uses("KHR_texture_transform")
    transform = {"KHR_texture_transform": {"offset": [0.5, 0.25], "rotation": 1, "scale": [2, 3]}}
    asset.add("images", {"bufferView": asset.view(png(3, 2)), "mimeType": "image/png"})
    asset.add("samplers", {"magFilter": 9728, "wrapS": 33071, "wrapT": 33648})
    asset.add("textures", {"source": 0, "sampler": 0})
    asset.primitive["material"] = asset.add("materials", {
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": transform}, "baseColorFactor": [1, 0.5, 0.25, 0.5]},
        "normalTexture": {"index": 0, "scale": 2}, "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 1, 1],
        "alphaMode": "MASK", "alphaCutoff": 0.4, "doubleSided": True})
    return asset


def embedded_image():
    asset = Asset()
    asset.attribute("TEXCOORD_0", "2H", "VEC2", [(0, 0), (65535, 0), (65535, 65535), (0, 65535)], normalized=True)
    asset.add("images", {"uri": "data:image/png;base64," + base64.b64encode(png(2, 2)).decode()})
    asset.add("textures", {"source": 0})
    asset.primitive["material"] = asset.add("materials", {
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": "BLEND"})
    return asset


def basisu(project):
    asset = Asset()
    asset.uses("KHR_texture_basisu", required=True)
    ktx2 = (project / "tests/image/ktx2/uastc_linear_4x4.ktx2").read_bytes()
    asset.add("images", {"bufferView": asset.view(ktx2), "mimeType": "image/ktx2"})
    asset.add("textures", {"extensions": {"KHR_texture_basisu": {"source": 0}}})
    asset.primitive["material"] = asset.add("materials", {"normalTexture": {"index": 0}})
    return asset


def animated():
    asset = Asset()
    times = asset.accessor("f", "SCALAR", [(0,), (1,)])
    moves = asset.accessor("3f", "VEC3", [(0, 0, 0), (1, 0, 0)])
    turns = asset.accessor("4f", "VEC4", [(0, 0, 0, 1), (0, 0, 1, 0)])
    cubic = asset.accessor("3f", "VEC3", [(0, 0, 0), (1, 1, 1), (0, 0, 0), (0, 0, 0), (2, 2, 2), (0, 0, 0)])
    asset.add("animations", {
        "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
                     {"sampler": 1, "target": {"node": 1, "path": "rotation"}},
                     {"sampler": 2, "target": {"node": 1, "path": "scale"}}],
        "samplers": [{"input": times, "output": moves}, {"input": times, "output": turns, "interpolation": "STEP"},
                     {"input": times, "output": cubic, "interpolation": "CUBICSPLINE"}]})
    return asset


def pointed():
    asset = Asset()
    asset.uses("KHR_animation_pointer")
    asset.uses("KHR_node_visibility")
    asset.primitive["material"] = asset.add("materials", {"pbrMetallicRoughness": {}})
    asset.json["nodes"][1]["extensions"] = {"KHR_node_visibility": {"visible": True}}
    times = asset.accessor("f", "SCALAR", [(0,), (1,)])
    channels = {"/materials/0/pbrMetallicRoughness/baseColorFactor": asset.accessor("4f", "VEC4", [(0, 0, 0, 1), (1, 1, 2, 1)]),
                "/cameras/0/perspective/yfov": asset.accessor("f", "SCALAR", [(1,), (4,)]),
                "/nodes/1/extensions/KHR_node_visibility/visible": asset.accessor("B", "SCALAR", [(1,), (0,)])}
    asset.add("animations", {
        "channels": [{"sampler": i, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": pointer}}}}
                     for i, pointer in enumerate(channels)],
        "samplers": [{"input": times, "output": output, "interpolation": "STEP"} for output in channels.values()]})
    return asset


def morphed():
    asset = Asset()
    target = asset.accessor("3f", "VEC3", [(0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 0, 0)])
    asset.primitive["targets"] = [{"POSITION": target}, {"POSITION": target}]
    asset.json["meshes"][0]["weights"] = [0.5, 0.25]
    times = asset.accessor("f", "SCALAR", [(0,), (2,)])
    weights = asset.accessor("f", "SCALAR", [(0,), (1,), (1,), (0,)])
    asset.add("animations", {"channels": [{"sampler": 0, "target": {"node": 1, "path": "weights"}}],
                             "samplers": [{"input": times, "output": weights}]})
    return asset


def skinned():
    asset = Asset()
    asset.attribute("JOINTS_0", "4B", "VEC4", [(0, 1, 0, 0)] * 4)
    asset.attribute("WEIGHTS_0", "4f", "VEC4", [(0.5, 0.5, 0, 0)] * 4)
    matrix = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
    asset.add("skins", {"joints": [2, 3], "skeleton": 2, "inverseBindMatrices": asset.accessor("16f", "MAT4", [matrix] * 2)})
    asset.json["nodes"][1]["skin"] = 0
    asset.json["nodes"] += [{"children": [3], "translation": [0.5, 0, 0]}, {"rotation": [0, 0, 0.6, 0.8], "scale": [1, 2, 1]}]
    asset.json["scenes"][0]["nodes"].append(2)
    return asset


def sparse():
    asset = Asset()
    accessor = asset.json["accessors"][0]
    accessor["sparse"] = {"count": 2, "indices": {"bufferView": asset.view(b"\1\0\3\0"), "componentType": 5123},
                          "values": {"bufferView": asset.view(struct.pack("<6f", 1, -1, 0.5, -1, 1, 0.5))}}
    accessor["min"], accessor["max"] = [-1, -1, 0], [1, 1, 0.5]
    return asset


def quantized():
    asset = Asset()
    asset.uses("KHR_mesh_quantization", required=True)
    asset.attribute("POSITION", "3h", "VEC3", [(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)])
    asset.json["accessors"][-1]["bufferView"] = asset.view(
        b"".join(struct.pack("<3hxx", *p) for p in [(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)]), byteStride=8)
    asset.json["nodes"][1]["scale"] = [0.1, 0.1, 0.1]
    return asset


def instanced():
    asset = Asset()
    asset.uses("EXT_mesh_gpu_instancing")
    places = asset.accessor("3f", "VEC3", [(0, 0, 0), (1, 0, 0), (0, 1, 0)])
    turns = asset.accessor("4b", "VEC4", [(0, 0, 0, 127)] * 3, normalized=True)
    asset.json["nodes"][1]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places, "ROTATION": turns}}}
    return asset


def lit():
    asset = Asset()
    asset.uses("KHR_lights_punctual")
    asset.uses("KHR_materials_variants")
    asset.json["extensions"] = {
        "KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 5, "range": 9, "spot": {"innerConeAngle": 0.1}}, {"type": "point"}]},
        "KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]}}
    asset.json["nodes"].append({"extensions": {"KHR_lights_punctual": {"light": 0}}, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]})
    asset.json["scenes"][0]["nodes"].append(2)
    asset.add("materials", {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}})
    asset.primitive["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": 0, "variants": [0, 1]}]}}
    return asset


def materials():
    """Returns an asset with one material of each kind. The materials are on quadrilaterals behind each other, one of which
    emits light."""
    asset = Asset()
    asset.attribute("TEXCOORD_0", "2f", "VEC2", [(0, 0), (1, 0), (1, 1), (0, 1)])
    asset.add("images", {"bufferView": asset.view(png(3, 2)), "mimeType": "image/png"})
    asset.add("textures", {"source": 0})
    texture = {"index": 0}
    models = [
        ({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.4},
          "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0.5, "attenuationColor": [1, 0.5, 0]},
          "KHR_materials_volume_scatter": {"multiscatterColor": [0.9, 0.5, 1], "scatterAnisotropy": 0.5},
          "KHR_materials_dispersion": {"dispersion": 0.5}}, {"metallicFactor": 0, "roughnessFactor": 0.1}),
        ({"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.2, "clearcoatNormalTexture": texture},
          "KHR_materials_sheen": {"sheenColorFactor": [1, 0.5, 1], "sheenRoughnessFactor": 0.3}}, {"metallicRoughnessTexture": texture}),
        ({"KHR_materials_anisotropy": {"anisotropyStrength": 0.7, "anisotropyRotation": 1, "anisotropyTexture": texture},
          "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceThicknessTexture": texture}}, {"roughnessFactor": 0.4}),
        ({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5, "diffuseTransmissionColorFactor": [0, 1, 0]},
          "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [2, 1, 0]}}, {"metallicFactor": 0}),
        ({"KHR_materials_emissive_strength": {"emissiveStrength": 20}}, {}),
    ]
    primitives = asset.json["meshes"][0]["primitives"] = []
    for extensions, model in models:
        for extension in extensions:
            asset.uses(extension)
        number = asset.add("materials", {"pbrMetallicRoughness": model, "extensions": extensions, "doubleSided": True,
                                         "emissiveFactor": [1, 1, 1] if "KHR_materials_emissive_strength" in extensions else [0, 0, 0]})
        asset.json["meshes"].append({"primitives": [{**asset.primitive, "material": number}]})
        node = asset.add("nodes", {"mesh": len(asset.json["meshes"]) - 1, "translation": [number * 0.3 - 0.6, 0, -0.4 * number],
                                   "rotation": [0, 0.2, 0, 0.98]})
        asset.json["scenes"][0]["nodes"].append(node)
    primitives.append(asset.primitive)
    return asset


def checkpoint(ranges, compressed=False, width=3, height=2):
    """Returns a checkpoint in the format of src/io/checkpoint/checkpoint.cpp, without the digest at the end."""
    identity = b"--seed\t1\n"
    samples = sum(last - first for first, last in ranges)
    head = b"microtrace samples\n" + struct.pack("<II", 5, len(identity)) + identity
    head += struct.pack("<4IdI", 1, 1, 0, samples, 0.5, 1) + struct.pack("<6I3f", width, height, 0, 0, width, height, 0, 0.25, 1)
    head += struct.pack("<I", len(ranges)) + b"".join(struct.pack("<2I", *r) for r in ranges)
    pixel = b"".join(struct.pack("<Q", word) for word in (0, samples, 1 << 63, samples, 5, 2, samples << 46, 0, 9, samples))
    pixel += struct.pack("<I", samples)
    pixels = width * height
    block = b"".join(bytes([byte]) * pixels for byte in pixel)
    if compressed:
        # A Zstandard frame (RFC 8878) with a run of equal bytes for each byte of a pixel. The last run ends the frame.
        runs = b"".join((pixels << 3 | 1 << 1 | (i + 1 == len(pixel))).to_bytes(3, "little") + bytes([byte])
                        for i, byte in enumerate(pixel))
        block = b"\x28\xb5\x2f\xfd\x60" + struct.pack("<H", len(block) - 256) + runs
    channels = [(b"depth.Z", 1, 0, bytes(4 * pixels)), (b"id.instance", 2, 0, bytes(4 * pixels)),
                (b"variance.Y", 0, 0, b""), (b"emission.R", 1, 1, bytes(4 * pixels))]
    tail = struct.pack("<I", len(channels))
    for name, kind, is_only_for_denoising, values in channels:
        tail += struct.pack("<I", len(name)) + name + struct.pack("<2I", kind, is_only_for_denoising)
        tail += struct.pack("<I", len(values)) + values if values else b""
    return head + struct.pack("<I", len(block)) + block + tail


def strips():
    asset = Asset()
    for mode in range(7):
        asset.json["meshes"][0]["primitives"].append({"attributes": asset.primitive["attributes"], "mode": mode})
    return asset


def compressed():
    asset = Asset()
    asset.uses("EXT_meshopt_compression")
    # The shortest index sequence that the codec accepts: a header, codes of two literal triangles, and the tail.
    data = bytes([0xE1, 0xF0, 0x10] + [0] * 16)
    asset.json["bufferViews"][1]["extensions"] = {"EXT_meshopt_compression": {
        "buffer": 0, "byteOffset": asset.json["bufferViews"][asset.view(data)]["byteOffset"], "byteLength": len(data),
        "byteStride": 2, "count": 6, "mode": "TRIANGLES"}}
    asset.uses("KHR_draco_mesh_compression")
    asset.primitive["extensions"] = {"KHR_draco_mesh_compression": {
        "bufferView": asset.view(b"DRACO\2\2\1\1\0\0" + bytes(24)), "attributes": {"POSITION": 0}}}
    return asset


def unpacked(glb):
    """Returns a GLB file in the fuzz target's special form."""
    (size,) = struct.unpack_from("<I", glb, 12)
    return glb[20:20 + size].rstrip() + b"\0" + glb[28 + size:]


def main():
    project, folder = Path(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    for name in ("json_scene", "gltf", "image", "checkpoint"):
        (folder / name).mkdir(parents=True)

    for path in [*project.glob("tests/io/good/*.json"), *project.glob("scenes/*.json"), *project.glob("scenes/degenerate/*.json")]:
        if path.stat().st_size < 4096:
            shutil.copy(path, folder / "json_scene" / f"{path.parent.name}_{path.name}")
    schema = json.loads((project / "docs/scene.schema.json").read_text())
    numbers = ["0", "-0", "1e38", "1e39", "1e-45", "1e400", "0.5", "4294967296", "null", "true", "\\ud800", "\\u0000"]
    (folder / "json_scene.dict").write_text(dictionary([*words_of_schema(schema), *numbers]))

    for make in (plain, textured, embedded_image, animated, pointed, morphed, skinned, sparse, quantized, instanced, lit, materials, strips,
                 compressed):
        (folder / "gltf" / make.__name__).write_bytes(make().packed())
        if make in (plain, embedded_image):
            (folder / "gltf" / f"{make.__name__}.gltf").write_bytes(make().embedded())
    (folder / "gltf" / "basisu").write_bytes(basisu(project).packed())
    shutil.copy(project / "scenes/gltf/cube.glb", folder / "gltf" / "cube.glb")
    for name in ("meshopt", "meshopt_khr"):
        (folder / "gltf" / name).write_bytes(unpacked((project / f"scenes/gltf/{name}.glb").read_bytes()))
    (folder / "gltf.dict").write_text(dictionary(GLTF_WORDS.split()))
    for name, data in images().items():
        (folder / "image" / name).write_bytes(data)
    for path in project.glob("tests/image/ktx2/*.ktx2"):
        shutil.copy(path, folder / "image" / path.name)
    for name, ranges in {"none": [], "one": [(0, 4)], "two": [(0, 4), (8, 9)]}.items():
        (folder / "checkpoint" / name).write_bytes(checkpoint(ranges))
        (folder / "checkpoint" / f"{name}_compressed").write_bytes(checkpoint(ranges, compressed=True))
    (folder / "checkpoint.dict").write_text('"microtrace samples"\n"--seed"\n')
    # Markers of JPEG and chunk names of WebP. Most of PNG's are omitted, because PNG chunks have checksums.
    words = [f"\\xff\\x{marker:02x}" for marker in (0xC0, 0xC2, 0xC4, 0xD0, 0xD8, 0xD9, 0xDA, 0xDB, 0xDD, 0xEE)]
    words += ["RIFF", "WEBP", "VP8 ", "VP8L", "VP8X", "ALPH", "ANIM", "ICCP", "IDAT", "PLTE", "tRNS"]
    words += ["KTX 20", "KTXorientation", "KTXswizzle", "rgba", "\\x28\\xb5\\x2f\\xfd"]
    (folder / "image.dict").write_text("".join(f'"{word}"\n' for word in words))


main()
