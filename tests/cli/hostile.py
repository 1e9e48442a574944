"""Makes scene files that are large in one respect, whose cost must grow at most linearly.

Each function makes an asset with about n of the objects in its name. bounds_test.py renders each asset at a small size. Run
as a program, this script compares the processor times for N and 4 N, which no test does:

usage: hostile.py PROGRAM N NAME,NAME,...|all [OPTION...]
"""

import base64
import json
import os
import resource
import struct
import sys
import tempfile
import zlib
from pathlib import Path

FLOATS, UINTS = 5126, 5125
TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


def data_uri(data, kind="application/octet-stream"):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def asset(**members):
    """Returns an asset with one triangle as mesh 0 on node 0. `members` are added or replace members of the same names."""
    result = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"byteLength": 36, "uri": data_uri(TRIANGLE)}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": FLOATS, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}],
    }
    result.update(members)
    return {key: value for key, value in result.items() if value is not None}


def png(width, height, color=0, depth=8):
    """Returns a PNG image of zeros, which compresses to a thousandth of its size."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    row = bytes(1 + width * channels * depth // 8)
    compressor = zlib.compressobj(9)
    data = b"".join(compressor.compress(row) for _ in range(height)) + compressor.flush()
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, depth, color, 0, 0, 0))
            + chunk(b"IDAT", data) + chunk(b"IEND", b""))


# glTF: nodes

def nested_nodes(n):
    nodes = [{"children": [i + 1], "mesh": 0} for i in range(n - 1)] + [{"mesh": 0}]
    return asset(nodes=nodes)


def nested_named_nodes(n):
    nodes = [{"name": "n", "children": [i + 1], "mesh": 0} for i in range(n - 1)] + [{"mesh": 0}]
    return asset(nodes=nodes)


def wide_nodes(n):
    return asset(nodes=[{"mesh": 0}] * n, scenes=[{"nodes": list(range(n))}])


def transformed_nodes(n):
    """Returns an asset of named nodes with all properties, as exporters write them."""
    place = {"translation": [0.25, 1.5, -3.75], "rotation": [0.5, -0.5, 0.5, 0.5], "scale": [0.75, 1.25, 0.875]}
    return asset(nodes=[{"mesh": 0, "name": f"part {i}", **place} for i in range(n)], scenes=[{"nodes": list(range(n))}])


def children_of_one_node(n):
    return asset(nodes=[{"children": list(range(1, n + 1))}] + [{"mesh": 0}] * n)


def equal_names(n):
    return asset(nodes=[{"mesh": 0, "name": "a"}] * n, scenes=[{"nodes": list(range(n))}])


def names_that_are_taken(n):
    names = [f"a (" + str(i) + ")" for i in range(2, n // 2)] + ["a"] * (n // 2)
    return asset(nodes=[{"mesh": 0, "name": name} for name in names], scenes=[{"nodes": list(range(len(names)))}],
                 meshes=[{"name": "", "primitives": [{"attributes": {"POSITION": 0}}]}])


def scenes(n):
    return asset(scenes=[{"nodes": [0]}] * n)


def hidden_nodes(n):
    hidden = {"extensions": {"KHR_node_visibility": {"visible": False}}}
    return asset(extensionsUsed=["KHR_node_visibility"], nodes=[{"mesh": 0, **hidden}] * n,
                 scenes=[{"nodes": list(range(n))}])


# glTF: all other arrays

def meshes(n):
    return asset(meshes=asset()["meshes"] * n, nodes=[{"mesh": i} for i in range(n)],
                 scenes=[{"nodes": list(range(n))}])


def primitives(n):
    return asset(meshes=[{"primitives": [{"attributes": {"POSITION": 0}}] * n}])


def materials(n):
    return asset(materials=[{}] * n, meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": i}
                                                             for i in range(n)]}])


def coated_materials(n):
    coat = {"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}}}
    return asset(materials=[coat] * n, extensionsUsed=["KHR_materials_clearcoat"],
                 meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": i} for i in range(n)]}])


def textures(n):
    use = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(n)]
    return asset(images=[{"uri": data_uri(png(256, 256), "image/png")}], textures=[{"source": 0}] * n, materials=use,
                 meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": i} for i in range(n)]}])


def images(n):
    use = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(n)]
    return asset(images=[{"uri": data_uri(png(4, 4), "image/png")}] * n, textures=[{"source": i} for i in range(n)],
                 materials=use,
                 meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": i} for i in range(n)]}])


def samplers(n):
    return asset(samplers=[{}] * n)


def cameras(n):
    camera = {"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}
    return asset(cameras=[camera] * n, nodes=[{"mesh": 0}] + [{"camera": i, "name": "c"} for i in range(n)],
                 scenes=[{"nodes": list(range(n + 1))}])


def lights(n):
    light = {"type": "point", "intensity": 1}
    return asset(extensionsUsed=["KHR_lights_punctual"],
                 extensions={"KHR_lights_punctual": {"lights": [light] * n}},
                 nodes=[{"mesh": 0}] + [{"extensions": {"KHR_lights_punctual": {"light": i}},
                                         "translation": [i, 0, 1]} for i in range(n)],
                 scenes=[{"nodes": list(range(n + 1))}])


def skins(n):
    joints = {"bufferView": 1, "componentType": 5121, "count": 3, "type": "VEC4"}
    weights = {"bufferView": 2, "componentType": FLOATS, "count": 3, "type": "VEC4"}
    data = TRIANGLE + bytes(12) + struct.pack("<12f", *(1, 0, 0, 0) * 3)
    views = [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12},
             {"buffer": 0, "byteOffset": 48, "byteLength": 48}]
    return asset(buffers=[{"byteLength": len(data), "uri": data_uri(data)}], bufferViews=views,
                 accessors=asset()["accessors"] + [joints, weights],
                 meshes=[{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
                 skins=[{"joints": [0]}] * n, nodes=[{"mesh": 0, "skin": i} for i in range(n)],
                 scenes=[{"nodes": list(range(n))}])


def joints(n):
    result = skins(1)
    result["nodes"] = [{"mesh": 0, "skin": 0}] + [{}] * n
    result["skins"] = [{"joints": list(range(1, n + 1))}]
    result["scenes"] = [{"nodes": list(range(n + 1))}]
    return result


def skinned_nodes_of_many_joints(n):
    """Returns an asset of about sqrt(n) nodes, each with a skin of about sqrt(n) joints."""
    side = int(n ** 0.5)
    result = joints(side)
    result["nodes"] += [{"mesh": 0, "skin": 0}] * side
    result["scenes"] = [{"nodes": list(range(2 * side + 1))}]
    return result


def morph_targets(n):
    return asset(meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}] * n}],
                          "weights": [0.5] * n}])


def nodes_with_morph_targets(n):
    side = int(n ** 0.5)
    result = morph_targets(side)
    result["nodes"] = [{"mesh": 0}] * side
    result["scenes"] = [{"nodes": list(range(side))}]
    return result


def keyed(data, accessors):
    """Returns an asset of one triangle with additional data and accessors."""
    views = [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": len(data)}]
    data = TRIANGLE + data
    return asset(buffers=[{"byteLength": len(data), "uri": data_uri(data)}], bufferViews=views,
                 accessors=asset()["accessors"] + accessors)


def times(count):
    return {"bufferView": 1, "componentType": FLOATS, "count": count, "type": "SCALAR", "min": [0], "max": [count - 1]}


def animations(n):
    result = keyed(struct.pack("<2f", 0, 1) + bytes(24), [
        times(2), {"bufferView": 1, "byteOffset": 8, "componentType": FLOATS, "count": 2, "type": "VEC3"}])
    result["animations"] = [{"samplers": [{"input": 1, "output": 2}],
                             "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}] * n
    return result


def channels(n):
    result = animations(1)
    result["nodes"] = [{"mesh": 0}] * n
    result["scenes"] = [{"nodes": list(range(n))}]
    result["animations"][0]["channels"] = [{"sampler": 0, "target": {"node": i, "path": "translation"}}
                                           for i in range(n)]
    return result


def animation_samplers(n):
    result = channels(n)
    result["animations"][0]["samplers"] *= n
    for i, channel in enumerate(result["animations"][0]["channels"]):
        channel["sampler"] = i
    return result


def keyframes(n):
    result = keyed(struct.pack(f"<{n}f", *range(n)) + bytes(12 * n), [
        times(n), {"bufferView": 1, "byteOffset": 4 * n, "componentType": FLOATS, "count": n, "type": "VEC3"}])
    result["animations"] = animations(1)["animations"]
    return result


def variants(n):
    mapping = {"KHR_materials_variants": {"mappings": [{"material": 0, "variants": list(range(n))}]}}
    return asset(extensionsUsed=["KHR_materials_variants"], materials=[{}],
                 extensions={"KHR_materials_variants": {"variants": [{"name": str(i)} for i in range(n)]}},
                 meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "extensions": mapping}]}])


def variant_mappings(n):
    result = variants(n)
    result["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = [
        {"material": 0, "variants": [i]} for i in range(n)]
    return result


def accessors(n):
    return asset(accessors=asset()["accessors"] * n,
                 meshes=[{"primitives": [{"attributes": {"POSITION": i}} for i in range(n)]}])


def buffer_views(n):
    return asset(bufferViews=asset()["bufferViews"] * n, accessors=[
        dict(asset()["accessors"][0], bufferView=i) for i in range(n)])


def buffers(n):
    return asset(buffers=asset()["buffers"] * n, bufferViews=[{"buffer": i, "byteLength": 36} for i in range(n)])


def attributes(n):
    names = {"POSITION": 0, **{f"TEXCOORD_{i}": 1 for i in range(n)}}
    coordinates = {"bufferView": 0, "componentType": FLOATS, "count": 3, "type": "VEC2"}
    return asset(meshes=[{"primitives": [{"attributes": names}]}], accessors=asset()["accessors"] + [coordinates])


def extensions_used(n):
    return asset(extensionsUsed=[f"EXT_{i}" for i in range(n)])


def equal_extensions_used(n):
    return asset(extensionsUsed=["KHR_materials_unlit"] * n)


def undeclared_extensions(n):
    return asset(extensions={f"EXT_{i}": {} for i in range(n)})


def instance_attributes(n):
    accessor = {"componentType": FLOATS, "count": 1, "type": "VEC3"}
    instancing = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1, **{f"_{i}": 1 for i in range(n)}}}}
    return asset(extensionsUsed=["EXT_mesh_gpu_instancing"], accessors=asset()["accessors"] + [accessor],
                 nodes=[{"mesh": 0, "extensions": instancing}])


def children_behind_unknown_keys(n):
    nodes = [{**{f"unknown{i}": 0 for i in range(n)}, "children": list(range(1, n + 1))}] + [{"mesh": 0}] * n
    return asset(nodes=nodes)


def channels_of_one_long_sampler(n):
    result = keyframes(n)
    result["nodes"] = [{"mesh": 0}] * n
    result["scenes"] = [{"nodes": list(range(n))}]
    result["animations"][0]["samplers"] *= n
    result["animations"][0]["channels"] = [{"sampler": i, "target": {"node": i, "path": "translation"}}
                                           for i in range(n)]
    return result


def images_of_one_long_view(n):
    data = png(1, 1) + bytes(n)
    result = images(n)
    result["bufferViews"] = asset()["bufferViews"] + [{"buffer": 1, "byteLength": len(data)}]
    result["buffers"] = asset()["buffers"] + [{"byteLength": len(data), "uri": data_uri(data)}]
    result["images"] = [{"bufferView": 1, "mimeType": "image/png"}] * n
    return result


def extensions(n):
    return asset(extensions={f"EXT_{i}": {} for i in range(n)}, extensionsUsed=[f"EXT_{i}" for i in range(n)])


def extensions_of_nodes(n):
    return asset(nodes=[{"mesh": 0, "extensions": {f"EXT_{i}": {}}} for i in range(n)],
                 scenes=[{"nodes": list(range(n))}], extensionsUsed=[f"EXT_{i}" for i in range(n)])


def nodes_and_extensions_used(n):
    light = {"extensions": {"KHR_lights_punctual": {"light": 0}}}
    used = [f"EXT_{i}" for i in range(n)] + ["KHR_lights_punctual"]
    return asset(extensionsUsed=used, extensions={"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
                 nodes=[{"mesh": 0}] + [light] * n, scenes=[{"nodes": list(range(n + 1))}])


def warnings(n):
    return asset(nodes=[{"mesh": 0, f"unknown {i}": 0} for i in range(n)], scenes=[{"nodes": list(range(n))}])


def equal_warnings(n):
    return asset(nodes=[{"mesh": 0, "unknown": 0}] * n, scenes=[{"nodes": list(range(n))}])


def instances(n):
    accessor = {"componentType": FLOATS, "count": n, "type": "VEC3"}
    instancing = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}
    return asset(extensionsUsed=["EXT_mesh_gpu_instancing"], accessors=asset()["accessors"] + [accessor],
                 nodes=[{"mesh": 0, "extensions": instancing}])


def zeros(n):
    """Returns a mesh whose vertices come from an accessor without data."""
    accessor = {"componentType": FLOATS, "count": n // 3 * 3, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}
    return asset(accessors=[accessor])


def zeros_with_attributes(n):
    n = n // 3 * 3
    kinds = {"POSITION": "VEC3", "NORMAL": "VEC3", "TANGENT": "VEC4", "TEXCOORD_0": "VEC2", "TEXCOORD_1": "VEC2",
             "COLOR_0": "VEC4"}
    made = [{"componentType": FLOATS, "count": n, "type": kind, "min": [0, 0, 0], "max": [0, 0, 0]}
            for kind in kinds.values()]
    for accessor in made[1:]:
        del accessor["min"], accessor["max"]
    return asset(accessors=made, meshes=[{"primitives": [{"attributes": {name: i for i, name in enumerate(kinds)}}]}])


def sparse_zeros(n):
    result = zeros(n)
    data = bytes(16)
    result.update(buffers=[{"byteLength": len(data), "uri": data_uri(data)}],
                  bufferViews=[{"buffer": 0, "byteLength": 4}, {"buffer": 0, "byteOffset": 4, "byteLength": 12}])
    result["accessors"][0]["sparse"] = {"count": 1, "indices": {"bufferView": 0, "componentType": UINTS},
                                        "values": {"bufferView": 1}}
    return result


def points(n):
    result = zeros(n)
    result["meshes"][0]["primitives"][0]["mode"] = 0
    return result


def pixels(n):
    side = int(n ** 0.5)
    return asset(images=[{"uri": data_uri(png(side, side), "image/png")}], textures=[{"source": 0}],
                 materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
                 meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}])


# glTF: text

def long_name(n):
    return asset(nodes=[{"mesh": 0, "name": "x" * n}])


def long_unknown_key(n):
    return asset(nodes=[{"mesh": 0, "x" * n: 0}])


def small_members(n):
    return asset(extras={f"member {i} with a name of some length": {} for i in range(n)})


def unknown_keys(n):
    return asset(extras={str(i): i for i in range(n)})


def deep_extras(n):
    return json.dumps(asset(extras=0)).replace('"extras": 0', '"extras": [' + ",".join(["[" * 200 + "]" * 200] *
                                                                                       (n // 200)) + "]")


def repeated_keys(n):
    return json.dumps(asset(extras=0)).replace('"extras": 0', '"extras": {' + ",".join(['"a": 0'] * n) + "}")


def repeated_keys_under_a_long_one(n):
    inner = "{" + ",".join(['"a": 0'] * n) + "}"
    return json.dumps(asset(extras=0)).replace('"extras": 0', '"extras": {"' + "x" * 6 * n + '": ' + inner + "}")


def values_under_a_long_key(n):
    """Returns values that the schema describes, below a long key that it does not describe."""
    return asset(extensionsUsed=["x" * 6 * n],
                 extensions={"x" * 6 * n: {"nodes": [{"unknown": 0, "extensions": {}}] * n}})


def attributes_of_long_names(n):
    side = int(n ** 0.5)
    names = {"POSITION": 0, **{"_" + "X" * side * 4 + str(i): 0 for i in range(side)}}
    return asset(meshes=[{"primitives": [{"attributes": names}]}])


# JSON scenes

def scene(**members):
    camera = {"type": "perspective", "position": [0, 0, 9], "direction": [0, 0, -1], "up": [0, 1, 0],
              "vertical_fov": 40, "focus": 1}
    return {"version": 1, "cameras": [camera], "objects": [{"type": "sphere", "center": [0, 0, 0], "radius": 1}],
            **members}


def spheres(n):
    return scene(objects=[{"name": f"ball {i}", "type": "sphere", "center": [i, 0, 0], "radius": 1} for i in range(n)])


def equal_spheres(n):
    return scene(objects=scene()["objects"] * n)


def equal_triangles(n):
    return scene(objects=[{"type": "triangle", "a": [0, 0, 0], "b": [1, 0, 0], "c": [0, 1, 0]}] * n)


def colors(n):
    return scene(colors={f"color {i}": [1, 0, 0] for i in range(n)},
                 objects=[{"type": "sphere", "center": [i, 0, 0], "radius": 1, "color": f"color {i}"} for i in range(n)])


def named_materials(n):
    return scene(materials={f"stuff {i}": {"metallic": 1} for i in range(n)},
                 objects=[{"type": "sphere", "center": [i, 0, 0], "radius": 1, "material": f"stuff {i}"}
                          for i in range(n)])


def scene_lights(n):
    return scene(lights=[{"name": f"lamp {i}", "type": "point", "position": [i, 0, 2]} for i in range(n)])


def scene_cameras(n):
    return scene(cameras=[{**scene()["cameras"][0], "name": f"camera {i}"} for i in range(n)])


GLTF = {f.__name__: f for f in (
    nested_nodes, nested_named_nodes, wide_nodes, transformed_nodes, children_of_one_node, equal_names,
    names_that_are_taken, scenes, hidden_nodes, meshes, primitives, materials, coated_materials, textures, images, samplers, cameras, lights, skins,
    joints, skinned_nodes_of_many_joints, morph_targets, nodes_with_morph_targets, animations, channels,
    animation_samplers, keyframes, variants, variant_mappings, accessors, buffer_views, buffers, attributes,
    extensions_used, equal_extensions_used, undeclared_extensions, instance_attributes,
    children_behind_unknown_keys, channels_of_one_long_sampler, images_of_one_long_view, extensions, extensions_of_nodes, nodes_and_extensions_used, warnings,
    equal_warnings, instances, zeros, zeros_with_attributes, sparse_zeros, points, pixels, long_name,
    small_members, long_unknown_key, unknown_keys, deep_extras, repeated_keys, repeated_keys_under_a_long_one,
    values_under_a_long_key, attributes_of_long_names)}


JSON = {f.__name__: f for f in (spheres, equal_spheres, equal_triangles, colors, named_materials, scene_lights,
                                scene_cameras)}
ALL = {**GLTF, **JSON}


def write(name, n, folder):
    content = ALL[name](n)
    path = Path(folder) / (name + (".json" if name in JSON else ".gltf"))
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def cost_of(arguments, folder):
    """Returns the exit code, processor time in seconds and memory in MiB of a run, which is limited to a minute and 12
    GiB."""
    child = os.fork()
    if child == 0:
        resource.setrlimit(resource.RLIMIT_AS, (12 << 30, 12 << 30))
        resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
        os.chdir(folder)
        with open("said", "wb") as said:
            os.dup2(said.fileno(), 1)
            os.dup2(said.fileno(), 2)
        os.execv(arguments[0], arguments)
    _, status, usage = os.wait4(child, 0)
    return os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def main(program, n, names, *options):
    program = os.path.abspath(program)
    for name in ALL if names == "all" else names.split(","):
        with tempfile.TemporaryDirectory() as folder:
            costs = []
            for size in (int(n), 4 * int(n)):
                path = write(name, size, folder)
                costs.append(cost_of([program, str(path), *(options or ("--validate",))], folder))
            said = Path(folder, "said").read_text(errors="replace").strip().split("\n")[-1]
        (code, seconds, memory), (code4, seconds4, memory4) = costs
        print(f"{name:32} exit {code}, {code4}; {seconds:5.2f} s, {seconds4:5.2f} s: x {seconds4 / max(seconds, 0.01):4.1f}; "
              f"{memory:.0f} MiB, {memory4:.0f} MiB; {said[:100]}", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
