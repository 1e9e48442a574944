"""Arguments of wrong types cause errors that name the parameter and what it accepts."""

from __future__ import annotations

import io
import json

import microtrace as mt
import numpy as np
import pytest
from conftest import SCENES

CUBE = str(SCENES / "gltf" / "cube.glb")
RAYS = np.float32([[0, 0, 9, 0, 0, -1]])
CAMERA = mt.look_at((0, 0, 9), (0, 0, 0))
MATRICES = {"K": np.diag([9.0, 9, 1]), "T": np.eye(4), "size": (8, 8), "convention": "opencv"}


class Other:
    """An object of a class that microtrace doesn't know."""


#: Values that are right for no parameter below.
WRONG = [3.5j, Other(), Other, {"a": 1}, {}, len, [[1, 2], [3]], [None], b"\xff\0", "a\0b"]


@pytest.fixture(scope="module")
def prepared():
    return mt.load(CUBE).prepare()


def prepared_with(shape=None, **fields):
    return mt.Scene(objects=[mt.Object(shape or mt.Sphere())], **fields).prepare()


def with_material(**fields):
    return prepared_with(materials=[mt.Material(**fields)])


def mesh(**arrays):
    mt.Scene().add_mesh(**{"vertices": np.eye(3), "faces": [[0, 1, 2]], **arrays})


def calls(prepared):
    """Returns functions with the right arguments, each of which is then replaced by wrong ones."""
    one = {"camera": CAMERA, "size": (4, 4), "spp": 1}
    picture = mt.render(prepared, **one)
    stack = mt.render(prepared, **{**one, "camera": [CAMERA]})
    points = np.zeros((1, 3))
    return [
        (mt.load, {"path": CUBE, "detail": "all", "time": None}),
        (mt.SceneFile, {"path": CUBE, "variant": "", "animation": ""}),
        (mt.load_map, {"path": "none.exr"}),
        (mt.look_at, {"eye": (0, 0, 9), "target": (0, 0, 0), "up": (0, 1, 0)}),
        (mt.look_at, {"eye": (0, 0, 9), "target": (0, 0, 0), "vertical_fov_degrees": 45}),
        (mt.cameras, MATRICES),
        (mt.cameras, {**MATRICES, "fisheye": (0, 0, 0, 0)}),
        (mt.frame, {"scene": prepared, "azimuth": 0, "elevation": 0, "vertical_fov_degrees": 45}),
        (mt.render, {"scene": prepared, **one, "aovs": "depth", "integrator": "flat"}),
        (mt.render, {"scene": prepared, **one, "filter": "box", "seed": 0, "max_depth": 1}),
        (mt.render, {"scene": prepared, **one, "bsdf": "spec", "background": (0, 0, 0)}),
        (mt.render, {"scene": prepared, **one, "environment": None, "crop": (0, 0, 1, 1)}),
        (mt.render, {"scene": prepared, **one, "threads": 1, "exposure": 0, "shutter": None}),
        (mt.Scene().prepare, {"previous": None, "threads": 1}),
        (prepared.intersect, {"rays": RAYS, "t_min": 0, "t_max": 1, "fields": "t", "threads": 1}),
        (prepared.explain, {"ray": RAYS[0], "max_hits": 9, "max_misses": 9}),
        (prepared.locate, {"points": points, "object": 0, "threads": 1}),
        (prepared.view, {"port": 0, "height": 9}),
        (picture.tonemap, {"exposure": 0, "tone_map": "agx"}),
        (picture.save, {"path": "picture.png", "exposure": 0, "tone_map": "agx"}),
        (stack.one, {"index": 0}),
        (mt.Image, {"pixels": np.zeros((1, 1), np.uint8)}),
        (mt.RadianceMap, {"pixels": np.zeros((1, 1, 3))}),
        (mesh, {"vertices": np.eye(3), "transform": np.eye(4), "colors": np.eye(3)}),
        (mesh, {"faces": [[0, 1, 2]], "normals": np.eye(3), "uv": np.zeros((3, 2))}),
        (lambda **f: prepared_with(mt.Sphere(**f)), {"center": (0, 0, 0), "radius": 1}),
        (lambda **f: prepared_with(mt.Quadric(**f)), {"coefficients": (1, 1, 1, *[0] * 6, -1)}),
        (prepared_with, {"origin": (0, 0, 0), "size": (4, 4), "integrator": "flat"}),
        (prepared_with, {"materials": [], "lights": [], "cameras": [], "epsilon": 0}),
        (with_material, {"base_color_factor": (1, 1, 1, 1), "roughness_factor": 0.5}),
        (with_material, {"alpha_mode": "mask", "unlit": False, "anisotropy": None}),
        (with_material, {"clearcoat": None, "specular_glossiness": None}),
    ]


#: What only other libraries, or the interpreter, would say.
RAW = ("incompatible function", "std::", "object is not iterable", "object has no attribute")
RAW += (
    "could not convert",
    "float() argument",
    "not supported between",
    "has no len",
    "unhashable",
)


def test_wrong_types_are_named(prepared, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    count = 0
    for function, arguments in calls(prepared):
        for name in arguments:
            # Lists of these are converted, or contain what is named by its own type.
            words = {"materials": "material", "lights": "light", "cameras": "camera"}
            word = words.get(name, name.lower())
            for value in WRONG:
                if value == {} and name in ("fields", *words):
                    continue  # an empty list
                with pytest.raises((TypeError, ValueError)) as caught:
                    function(**{**arguments, name: value})
                message = str(caught.value)
                assert word in message.lower(), (name, value, message)
                assert not any(raw in message for raw in RAW), (name, value, message)
                count += 1
    assert count > 700
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("value", [None, 3, 2.5, True, {}, [], Other(), io.StringIO()])
@pytest.mark.parametrize("function", [mt.load, mt.SceneFile, mt.load_map])
def test_paths(function, value):
    kind = type(value).__name__
    words = rf"^path must be a str, bytes or os\.PathLike object, not {kind}$"
    with pytest.raises(TypeError, match=words):
        function(value)


@pytest.mark.parametrize("function", [mt.load, mt.SceneFile, mt.load_map])
def test_paths_that_no_file_can_have(function):
    with pytest.raises(ValueError, match=r"^path can't be the name of a file, is '\\ud800.glb'"):
        function("\ud800.glb")


def test_options_that_are_bytes(prepared):
    with pytest.raises(TypeError, match="^options must be a str or a list, not b'--spp 1'$"):
        prepared.view(b"--spp 1")


def test_masked_arrays(prepared):
    rays = np.ma.masked_array(RAYS, mask=RAYS == 9)
    with pytest.raises(ValueError, match="^rays must not have masked values"):
        prepared.occluded(rays)
    with pytest.raises(ValueError, match="^vertices must not have masked values"):
        mesh(vertices=np.ma.masked_array(np.eye(3), mask=np.eye(3) > 0))
    for nested in (list(rays), [list(rays)], [[[np.ma.masked] * 6]]):
        with pytest.raises(ValueError, match="^rays must not have masked values"):
            prepared.occluded(nested)
    assert prepared.occluded(np.ma.masked_array(RAYS)).tolist() == [True]


def test_integers_beyond_float64(prepared):
    with pytest.raises(ValueError, match="^azimuth must be from"):
        mt.frame(prepared, azimuth=10**400)
    with pytest.raises(ValueError, match="^exposure must be"):
        mt.render(prepared, CAMERA, (8, 8), exposure=-(10**400))


def test_distortion_of_several_cameras():
    with pytest.raises(ValueError, match=r"^distortion must be .* one camera, not \(2, 4\)"):
        mt.cameras(**MATRICES, distortion=np.zeros((2, 4)))
    for shape in ((5,), (1, 5), (5, 1)):
        mt.cameras(**MATRICES, distortion=np.full(shape, 0.01))


def test_colors_of_meshes_are_linear():
    with pytest.raises(ValueError, match="^colors must be linear numbers"):
        prepared_with(mt.Mesh(np.eye(3), [[0, 1, 2]], colors=np.full((3, 4), 255, np.uint8)))
    prepared_with(mt.Mesh(np.eye(3), [[0, 1, 2]], colors=[[1, 1, 1, 1]] * 3))


def test_arrays_of_pictures_are_not_replaced(prepared):
    picture = mt.render(prepared, CAMERA, (8, 8))
    with pytest.raises(AttributeError, match="^color can't be replaced"):
        picture.color = picture.color * 0


def test_indices_beyond_32_bits():
    for index, kind in ((2**32, np.int64), (2**40, np.int64), (2**63, np.uint64)):
        with pytest.raises(ValueError, match=f"^faces must be less than 2.32; found {index}$"):
            mesh(vertices=np.eye(3), faces=np.array([[0, 1, index]], kind))


def test_paths_that_are_bytes(tmp_path, prepared):
    assert len(mt.load(CUBE.encode()).objects) == 3
    picture = mt.render(prepared, CAMERA, (4, 4), spp=1)
    picture.save(bytes(tmp_path / "picture.exr"))
    picture.save(tmp_path / "again.exr")
    assert (tmp_path / "picture.exr").read_bytes() == (tmp_path / "again.exr").read_bytes()
    with pytest.raises(mt.FileError, match="is a directory"):
        mt.load(tmp_path)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"base_color_texture": "wood.png"}, "pixels must be an array of uint8 .* not 'wood.png'"),
        ({"roughness_factor": "0.5"}, "roughness_factor must be a number, not '0.5'"),
        ({"base_color_factor": "red"}, "base_color_factor must have 4 numbers, not 3"),
        ({"base_color_factor": 1}, "base_color_factor must be 4 numbers, not 1"),
        ({"base_color_factor": (1, 1, 1, "1")}, "base_color_factor must be a number, not '1'"),
        ({"unlit": 1}, "unlit must be True or False, not 1"),
        ({"unlit": np.int64(1)}, "unlit must be True or False, not"),
        ({"name": None}, "name must be a str, not None"),
        ({"sheen": mt.Clearcoat()}, "sheen must be a microtrace.Sheen, not Clearcoat"),
    ],
)
def test_attributes(fields, words):
    with pytest.raises((TypeError, ValueError), match=words):
        with_material(**fields)


def test_environments_and_texture_coordinates():
    words = 'content must be "studio", a color or a microtrace.RadianceMap'
    for content in ("sky.hdr", np.ones((2, 4, 3)), (1, 1), None, 3):
        with pytest.raises((TypeError, ValueError), match=words):
            prepared_with(environment=mt.Environment(content))
    assert prepared_with(environment=mt.Environment(iter((1, 2, 3)))).scene.environment
    shape = mt.Mesh(vertices=np.eye(3), faces=[[0, 1, 2]], uv=np.zeros((3, 2)))
    with pytest.raises(ValueError, match=r"each set of uv must have shape \(n, 2\), not \(2,\)"):
        prepared_with(shape)


def test_texts_that_are_not_unicode(prepared):
    bad, one = "\udcff", {"camera": CAMERA, "size": (4, 4), "spp": 1}
    for name, act in (
        ("name", lambda: mt.Image(np.zeros((1, 1), np.uint8), bad)),
        ("name", lambda: prepared_with(materials=[mt.Material(name=bad)])),
        ("content", lambda: prepared_with(environment=mt.Environment(bad))),
        ("variant", lambda: mt.load(CUBE, variant=bad)),
        ("filter", lambda: mt.render(prepared, filter=bad, **one)),
        ("tone_map", lambda: mt.render(prepared, **one).tonemap(tone_map=bad)),
        ("options", lambda: prepared.view(["--env", bad])),
        ("options", lambda: prepared.view(f"--env {bad}")),
    ):
        with pytest.raises((ValueError, TypeError), match=f"^{name} must .* surrogates"):
            act()


def test_exceptions_of_iterators_are_not_replaced():
    def fail():
        raise ZeroDivisionError("mine")
        yield

    with pytest.raises(ZeroDivisionError, match="mine"):
        prepared_with(mt.Sphere(fail(), 1))
    with pytest.raises(ZeroDivisionError, match="mine"):
        prepared_with(lights=fail())


def write_triangle(path, **members):
    """Writes a glTF file with a triangle, whose vertices are in data.bin in the folder above."""
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "../data.bin", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
        **members,
    }
    document["accessors"][0] |= {"min": [0, 0, 0], "max": [1, 1, 0]}
    path.parent.mkdir()
    path.write_text(json.dumps(document))
    (path.parent.parent / "data.bin").write_bytes(np.float32([0] * 3 + [1] + [0] * 3 + [1, 0]))


def test_variants_and_animations_by_index(tmp_path):
    name = "KHR_materials_variants"
    path = tmp_path / "inside" / "model.gltf"
    mappings = [{"material": k, "variants": [k]} for k in range(2)]
    write_triangle(
        path,
        extensionsUsed=[name],
        extensions={name: {"variants": [{"name": "red"}, {"name": "blue"}]}},
        materials=[{"name": "ruby"}, {"name": "sky"}],
        meshes=[
            {
                "primitives": [
                    {"attributes": {"POSITION": 0}, "extensions": {name: {"mappings": mappings}}}
                ]
            }
        ],
    )
    for variant in ("blue", "1", 1, np.int64(1)):
        scene = mt.load(path, variant=variant, allowed_folders=tmp_path)
        assert scene.objects[0].material.name == "sky"
    for wrong in ({"variant": 2}, {"variant": -1}, {"animation": 7, "time": 0}):
        with pytest.raises(mt.UsageError, match=str(next(iter(wrong.values())))):
            mt.load(path, allowed_folders=tmp_path, **wrong)


def test_one_allowed_folder_is_not_a_list_of_letters(tmp_path):
    """Its first letter would allow the root folder."""
    path = tmp_path / "inside" / "model.gltf"
    write_triangle(path)
    for folders in ((), "/nonexistent", [tmp_path / "inside"]):
        with pytest.raises(mt.Error, match="data.bin"):
            mt.load(path, allowed_folders=folders)
    for folders in (tmp_path, str(tmp_path), bytes(tmp_path), [bytes(tmp_path)], {tmp_path}):
        assert len(mt.load(path, allowed_folders=folders).objects) == 1
    for folders in (3, None, [3], [None]):
        with pytest.raises(TypeError, match="allowed_folders must be"):
            mt.load(path, allowed_folders=folders)
