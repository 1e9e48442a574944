"""Tests scenes as data: loading, editing, preparing and pickling."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import errno
import gc
import inspect
import os
import pickle
import re
import subprocess
import sys
import tracemalloc
import warnings
from pathlib import Path

import microtrace as mt
import numpy as np
import pytest
from conftest import SCENES, icosphere
from microtrace import materials

KNOT = SCENES / "gltf" / "knot.glb"
MATERIALS = SCENES / "gltf" / "materials.glb"


def test_files_are_not_pickled():
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        with pytest.raises(TypeError, match="cannot pickle"):
            pickle.dumps(mt.SceneFile(KNOT), protocol)


def test_threads_may_share_a_file():
    file = mt.SceneFile(SCENES / "gltf" / "moving.glb")
    times = [0.05 * k for k in range(20)]
    alone = [pickle.dumps(file.at(time)) for time in times]
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        together = list(pool.map(lambda time: pickle.dumps(file.at(time)), times * 5))
    assert together == alone * 5


def test_errors_name_paths_that_are_not_utf_8(tmp_path):
    folder = os.fsencode(tmp_path) + b"/\xff"
    os.mkdir(folder)
    path = folder + b"/a.json"
    with pytest.raises(FileNotFoundError) as missing:
        mt.load(os.fsdecode(path))
    assert os.fsencode(missing.value.diagnostic.file) == path
    with open(path, "w") as file:
        file.write("{")
    with pytest.raises(mt.SceneError):
        mt.load(os.fsdecode(path))


def test_misspelled_attributes_are_refused():
    material = mt.Material()
    with pytest.raises(AttributeError, match="no attribute 'roughness'; did you mean 'roughness_"):
        material.roughness = 0.2
    with pytest.raises(AttributeError, match="PerspectiveCamera has no attribute 'xyz'$"):
        mt.PerspectiveCamera().xyz = 1
    with pytest.raises(AttributeError, match="no attribute 'tmies'; did you mean 'times'"):
        mt.Shutter(lambda time: (mt.Scene(), mt.look_at((0, 0, 5), (0, 0, 0))), 0, 1).tmies = 8
    material.roughness_factor = 0.2

    class Labeled(mt.Object):
        pass

    labeled = Labeled(mt.Sphere((0, 0, 0), 1))
    labeled.label = 7
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        again = pickle.loads(pickle.dumps(material, protocol))
        assert again.roughness_factor == 0.2


def test_times_must_be_numbers():
    with pytest.raises(mt.UsageError, match="time"):
        mt.load(SCENES / "gltf" / "moving.glb", time=float("nan"))


def test_defaults_are_those_of_the_library():
    """Python's dataclasses repeat the defaults of C++."""
    scene = mt.Scene(
        materials=[
            mt.Material(
                specular=mt.Specular(),
                transmission=mt.Transmission(),
                volume=mt.Volume(),
                volume_scatter=mt.VolumeScatter(),
                clearcoat=mt.Clearcoat(),
                sheen=mt.Sheen(),
                anisotropy=mt.Anisotropy(),
                iridescence=mt.Iridescence(),
                diffuse_transmission=mt.DiffuseTransmission(),
                specular_glossiness=mt.SpecularGlossiness(),
            )
        ]
    )
    (back,) = scene.prepare().scene.materials
    given = dataclasses.asdict(scene.materials[0])

    def rounded(value):
        if isinstance(value, dict):
            return {k: rounded(v) for k, v in value.items()}
        if isinstance(value, tuple):
            return tuple(rounded(v) for v in value)
        return np.float32(value) if isinstance(value, float) else value

    assert rounded(dataclasses.asdict(back)) == rounded(given)


def test_every_field_survives():
    """Each number of each material reaches the library and comes back."""
    made = {}
    number = 0.0
    for name in materials.__dict__:
        cls = getattr(materials, name)
        if not dataclasses.is_dataclass(cls) or name in ("Texture", "TextureUse", "Material"):
            continue
        values = {}
        for item in dataclasses.fields(cls):
            if item.name.endswith("_texture"):
                values[item.name] = mt.Image(np.full((1, 1, 3), int(number * 64) % 256, np.uint8))
            elif isinstance(item.default, tuple):
                values[item.name] = (number, number + 1 / 64, number + 2 / 64)
            else:
                values[item.name] = number + (1.5 if item.default > 1 else 0)
            number += 1 / 64
        made[name] = cls(**values)
    scene = mt.Scene(
        materials=[
            mt.Material(
                **{_snake(name): value for name, value in made.items()},
                alpha_mode="mask",
                unlit=True,
            )
        ]
    )
    (back,) = scene.prepare().scene.materials
    assert back.alpha_mode == "mask" and back.unlit
    for name, value in made.items():
        other = getattr(back, _snake(name))
        for item in dataclasses.fields(value):
            a, b = getattr(value, item.name), getattr(other, item.name)
            if isinstance(a, mt.Image):
                assert np.array_equal(a.pixels, b.texture.image.pixels)
            else:
                assert a == b, (name, item.name)


def _snake(name: str) -> str:
    return "".join(("_" if c.isupper() and k else "") + c.lower() for k, c in enumerate(name))


def test_arrays_of_files_are_shared_and_read_only():
    scene = mt.load(KNOT)
    vertices = scene.objects[0].shape.vertices
    with pytest.raises(ValueError, match="read-only"):
        vertices[0] = 0
    with pytest.raises(ValueError):
        vertices.flags.writeable = True
    again = scene.prepare().scene.objects[0].shape.vertices
    assert np.shares_memory(vertices, again)
    del scene
    gc.collect()
    assert np.isfinite(vertices).all()


def test_own_arrays_are_copied():
    """A change after prepare() has no effect, and can't crash."""
    vertices, faces = icosphere(1)
    faces = faces.astype(np.uint32)
    vertices = vertices.astype(np.float32)
    scene = mt.Scene()
    scene.add_mesh(vertices, faces)
    prepared = scene.prepare()
    before = prepared.intersect([0, 0, 5, 0.01, 0.02, -1])
    faces[:] = 10**9
    vertices[:] = 7
    after = prepared.intersect([0, 0, 5, 0.01, 0.02, -1])
    assert before.t == after.t and np.array_equal(before.normal, after.normal)
    with pytest.raises(mt.SceneError, match="/objects/0/shape/faces"):
        scene.prepare()


def test_editing():
    scene = mt.load(MATERIALS, detail="color")
    target = next(o for o in scene.objects if o.material is not None)
    target.material.base_color_factor = (1, 0, 0, 1)
    target.material.base_color_texture = None
    del scene.objects[1:]
    scene.objects[0] = target
    prepared = scene.prepare()
    assert len(prepared.scene.objects) == 1
    used = prepared.scene.objects[0].material
    assert used.base_color_factor == (1, 0, 0, 1)


def test_materials_are_numbered_in_order():
    a, b, c = (mt.Material(name=n) for n in "abc")
    scene = mt.Scene(materials=[b])
    for material in (c, a, b, c):
        scene.add_sphere(material=material)
    prepared = scene.prepare()
    back = prepared.scene
    assert [m.name for m in back.materials] == ["b", "c", "a"]
    assert back.objects[0].material is back.materials[1]


def test_previous_gives_the_same():
    vertices, faces = icosphere(3)
    rays = np.random.default_rng(0).normal(size=(2000, 6))
    previous = None
    for k in range(4):
        scene = mt.Scene()
        scene.add_mesh(vertices * (1 + 0.05 * k), faces)
        previous = scene.prepare(previous)
        fresh = scene.prepare()
        a, b = previous.intersect(rays), fresh.intersect(rays)
        assert np.array_equal(a.t, b.t) and np.array_equal(a.primitive, b.primitive)


def test_transform_of_meshes():
    vertices, faces = icosphere(1)
    mirror = np.diag([-2.0, 1, 1, 1])
    mirror[:3, 3] = 10, 0, 0
    scene = mt.Scene()
    scene.add_mesh(vertices, faces, normals=vertices, transform=mirror)
    prepared = scene.prepare()
    hits = prepared.intersect([[10.1, 0.2, 5, 0, 0, -1]], fields=("face_normal", "normal", "front"))
    assert hits.front.all() and hits.face_normal[0, 2] > 0 and hits.normal[0, 2] > 0
    assert np.allclose(np.linalg.norm(hits.normal, axis=1), 1, atol=1e-6)
    with pytest.raises(ValueError, match="4 x 4"):
        scene.add_mesh(vertices, faces, transform=np.eye(3))
    with pytest.raises(ValueError, match="affine"):
        scene.add_mesh(vertices, faces, transform=np.ones((4, 4)))


def test_pickle():
    scene = mt.load(KNOT)
    rays = np.random.default_rng(0).normal(size=(500, 6))
    prepared = scene.prepare()
    expected = prepared.intersect(rays)
    for copy in (pickle.loads(pickle.dumps(scene)).prepare(), pickle.loads(pickle.dumps(prepared))):
        hits = copy.intersect(rays)
        assert np.array_equal(hits.t, expected.t) and np.array_equal(hits.normal, expected.normal)
    duplicate = scene.copy()
    duplicate.objects[0].name = "other"
    assert scene.objects[0].name != "other"
    assert duplicate.objects[0].shape.vertices is scene.objects[0].shape.vertices


def test_copies_share_no_lists():
    scene = mt.Scene([mt.Object(mt.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))])
    scene.copy().objects[0].shape.vertices.append([5, 5, 5])
    assert len(scene.objects[0].shape.vertices) == 3


def test_texts_are_short():
    scene = mt.load(KNOT)
    assert len(repr(scene)) < 4000
    assert repr(mt.Material(name="red", roughness_factor=0.5)) == (
        "Material(name='red', roughness_factor=0.5)"
    )
    assert "<float32 (352, 3)>" in repr(scene.objects[0].shape)


def test_images_of_pillow():
    pillow = pytest.importorskip("PIL.Image")
    red = pillow.new("RGB", (3, 2), (255, 0, 0))
    for mode in ("RGB", "RGBA", "P", "CMYK", "YCbCr", "HSV"):
        pixels = mt.Image(red.convert(mode)).pixels
        assert pixels.shape[:2] == (2, 3)
        assert np.abs(pixels[0, 0].astype(int)[:3] - (255, 0, 0)).max() <= 1, mode
    assert mt.Image(red.convert("1")).pixels.dtype == np.uint8
    premultiplied = pillow.frombytes("La", (1, 1), bytes((50, 100)))
    assert mt.Image(premultiplied).pixels.tolist() == [[[127, 100]]]
    for mode in ("F", "I", "LAB"):
        with pytest.raises(ValueError, match=f"^pixels of Pillow's mode {mode} have no definite"):
            mt.Image(pillow.new(mode, (3, 2)))
    gray = pillow.fromarray(np.full((2, 3), 40000, np.uint16))
    assert (mt.Image(gray).pixels == 40000).all()
    scene = mt.Scene()
    scene.add_sphere(material=mt.Material(base_color_texture=red.convert("P")))
    assert (
        scene.prepare().scene.objects[0].material.base_color_texture.texture.image.pixels[0, 0]
        == [255, 0, 0, 255]
    ).all()


def test_transparent_colors_of_pillow():
    pillow = pytest.importorskip("PIL.Image")
    for mode, colors, transparent in (
        ("L", (5, 6), 5),
        ("RGB", ((255, 0, 0), (0, 0, 255)), (255, 0, 0)),
        ("P", (0, 1), 0),
        ("I;16", (500, 600), 500),
    ):
        image = pillow.new(mode, (2, 1))
        for x, color in enumerate(colors):
            image.putpixel((x, 0), color)
        image.info["transparency"] = transparent
        pixels = mt.Image(image).pixels
        assert pixels[0, :, -1].tolist() == [0, np.iinfo(pixels.dtype).max], mode
        if mode != "P":
            assert pixels[0, 1, :-1].tolist() == np.atleast_1d(colors[1]).tolist()


def test_truth_values_of_numpy():
    scene = mt.Scene(environment=mt.Environment(is_background=np.bool_(False)))
    for value in (True, False):
        scene.add_sphere(material=mt.Material(double_sided=np.bool_(value)))
    again = scene.prepare().scene
    assert [m.double_sided for m in again.materials] == [True, False]
    assert again.environment.is_background is False


def test_images():
    pixels = np.arange(24, dtype=np.uint8).reshape(2, 4, 3)
    image = mt.Image(pixels, "checker")
    pixels[:] = 0
    assert image.pixels[1, 3].tolist() == [21, 22, 23] and image.name == "checker"
    assert mt.Image(np.zeros((2, 3), np.uint16)).pixels.shape == (2, 3, 1)
    assert mt.Image(np.full((2, 3), 258, ">u2")).pixels.ravel().tolist() == [258] * 6
    for wrong in (np.zeros((2, 3, 5), np.uint8), np.zeros(3, np.uint8), np.zeros((0, 1), np.uint8)):
        with pytest.raises(ValueError):
            mt.Image(wrong)
    with pytest.raises(TypeError):
        mt.Image(np.zeros((2, 3)))
    with pytest.raises(mt.SceneError):
        mt.RadianceMap(-np.ones((2, 4, 3)))
    with pytest.raises(mt.SceneError):
        mt.RadianceMap(np.full((2, 4, 3), 1e300))  # without a warning of NumPy
    assert np.array_equal(pickle.loads(pickle.dumps(image)).pixels, image.pixels)


def test_meshes_without_faces_have_empty_arrays():
    scene = mt.Scene()
    scene.add_mesh([], [])
    shape = mt.Mesh(np.eye(3), np.zeros((0, 3), int), segments=[[0, 1]])
    scene.objects.append(mt.Object(shape))
    for _ in range(2):
        scene = scene.prepare().scene
        empty, lines = (item.shape for item in scene.objects)
        for array in (empty.vertices, empty.faces, lines.faces):
            assert isinstance(array, np.ndarray) and array.shape == (0, 3)
        assert lines.segments.tolist() == [[0, 1]] and lines.normals is None
    assert mt.scene_of(lines).prepare().scene.objects[0].shape.faces.shape == (0, 3)


def test_vertex_colors():
    scene = mt.Scene()
    triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    scene.add_mesh(*triangle, colors=np.full((3, 3), 188, np.uint8))
    colors = scene.prepare().scene.objects[0].shape.colors
    assert np.allclose(colors[0], [0.5028865, 0.5028865, 0.5028865, 1])
    for wrong in ([[255, 128, 0]] * 3, np.full((3, 3), 1.5), np.full((3, 3), np.nan)):
        with pytest.raises(ValueError, match="colors must be in"):
            scene.add_mesh(*triangle, colors=wrong)
    scene.add_mesh(*triangle, colors=np.full((3, 4), 0.25))
    assert scene.prepare().scene.objects[1].shape.colors[0].tolist() == [0.25] * 4


def test_objects_share_a_mesh():
    rng = np.random.default_rng(3)
    vertices = rng.normal(size=(300, 3)).astype(np.float32)
    mesh = mt.Mesh(vertices, np.arange(300).reshape(100, 3), normals=vertices.tolist())
    matrices = [np.hstack([rng.normal(size=(3, 3)), 3 * rng.normal(size=(3, 1))]) for _ in range(5)]
    shared = mt.Scene(objects=[mt.Object(mesh, placement=m) for m in matrices])
    copied = mt.Scene()
    for m in matrices:
        x, y, z = (vertices[:, k : k + 1].astype(np.float64) for k in range(3))
        moved = (m[:, 0] * x + m[:, 1] * y) + (m[:, 2] * z + m[:, 3])
        faces = mesh.faces if np.linalg.det(m[:, :3]) > 0 else mesh.faces[:, [0, 2, 1]]
        copied.objects.append(mt.Object(mt.Mesh(moved.astype(np.float32), faces)))
    rays = np.hstack([4 * rng.normal(size=(2000, 3)), rng.normal(size=(2000, 3))])
    hits, expected = (s.prepare().intersect(rays) for s in (shared, copied))
    assert np.isfinite(expected.t).sum() > 200
    for name in ("t", "object", "primitive"):
        assert np.array_equal(getattr(hits, name), getattr(expected, name)), name


def test_shared_meshes_survive():
    mesh = mt.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    matrices = [np.hstack([np.eye(3) * (k + 1), [[k], [0], [0.1]]]) for k in range(3)]
    scene = mt.Scene(objects=[mt.Object(mesh, placement=m) for m in matrices])
    scene.add_mesh(mesh.vertices, mesh.faces)
    back = scene.prepare().scene
    shapes = [each.shape for each in back.objects]
    assert shapes[0] is shapes[1] is shapes[2] and shapes[3] is not shapes[0]
    assert np.array_equal(shapes[0].vertices, mesh.vertices)
    assert back.objects[3].placement is None
    for each, matrix in zip(back.objects, matrices, strict=False):
        assert np.array_equal(each.placement, matrix)
    again = pickle.loads(pickle.dumps(scene.prepare()))
    rays = np.random.default_rng(1).normal(size=(500, 6))
    hits, expected = again.intersect(rays), scene.prepare().intersect(rays)
    assert np.isfinite(hits.t).any() and np.array_equal(hits.t, expected.t)


def test_scene_too_large_for_memory():
    """Runs in another process, whose memory is limited."""
    script = """
import resource, microtrace as mt, numpy as np
scene = mt.Scene()
scene.add_mesh(np.eye(3), np.broadcast_to(np.uint32([0, 1, 2]), (10**8, 3)))
resource.setrlimit(resource.RLIMIT_AS, (2**31, 2**31))
try:
    scene.prepare()
except mt.LimitError as error:
    print(error)
"""
    command = [sys.executable, "-c", script]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "memory" in result.stdout


def test_default_background_is_the_documented_one():
    gray = re.search(r"None: ([\d.]+) gray if path traced, else black", inspect.getsource(mt.Scene))
    camera = mt.look_at((0, 0, 5), (0, 0, 9))
    scene = mt.Scene().prepare()
    assert gray is not None
    lit = mt.render(scene, camera, (1, 1), spp=1).color[0, 0]
    assert lit.tolist() == [np.float32(gray[1])] * 3
    flat = mt.render(scene, camera, (1, 1), integrator="flat").color[0, 0]
    assert flat.tolist() == [0, 0, 0]


def test_materials_may_occur_twice():
    red, blue = mt.Material(name="red"), mt.Material(name="blue")
    scene = mt.Scene(materials=[red, red, blue], background=(0, 0, 0))
    scene.add_sphere(material=blue)
    scene.add_sphere(center=(9, 0, 0), material=red)
    prepared = scene.prepare()
    camera = mt.look_at((0, 0, 5), (0, 0, 0), vertical_fov_degrees=20)
    assert mt.render(prepared, camera, (1, 1), aovs=["material"]).material[0, 0] == 3
    assert [each.name for each in prepared.scene.materials] == ["red", "red", "blue"]


@pytest.mark.parametrize("array", ["normals", "tangents", "colors", "uv"])
@pytest.mark.parametrize("number", [np.nan, np.inf])
def test_attributes_must_be_finite(array, number):
    width = {"normals": 3, "tangents": 4, "colors": 4, "uv": 2}[array]
    values = np.zeros((3, width), np.float32)
    values[1, 0] = number
    mesh = mt.Mesh(np.eye(3), [[0, 1, 2]], **{array: [values] if array == "uv" else values})
    with pytest.raises(mt.SceneError, match="finite"):
        mt.Scene(objects=[mt.Object(mesh)]).prepare()


@pytest.mark.parametrize(
    "shape, placement, error, text",
    [
        (mt.Sphere(), np.identity(4), ValueError, "only meshes"),
        (mt.Mesh([[0, 0, 0]] * 3, [[0, 1, 2]]), np.identity(3), ValueError, "(3, 4) or (4, 4)"),
        (mt.Mesh([[0, 0, 0]] * 3, [[0, 1, 2]]), np.ones((4, 4)), ValueError, "last row"),
        (mt.Mesh([[0, 0, 0]] * 3, [[0, 1, 2]]), np.full((3, 4), np.inf), ValueError, "finite"),
        (
            mt.Mesh([[0, 0, 0]] * 3, [[0, 1, 2]], segments=[[0, 1]]),
            np.identity(4),
            ValueError,
            "segments",
        ),
    ],
)
def test_wrong_placements(shape, placement, error, text):
    with pytest.raises(error, match=re.escape(text)):
        mt.Scene(objects=[mt.Object(shape, placement=placement)]).prepare()


def scene_with(**changes):
    vertices, faces = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    return mt.Scene(
        objects=[mt.Object(mt.Mesh(**{"vertices": vertices, "faces": faces, **changes}))]
    )


@pytest.mark.parametrize(
    "scene, error, text",
    [
        (scene_with(faces=[[0, 1, 3]]), mt.SceneError, "/objects/0/shape/faces"),
        (scene_with(faces=[[0, 1, -1]]), ValueError, "must not be negative"),
        (scene_with(faces=[[0, 1, 2**40]]), ValueError, "faces must be less than 2^32"),
        (scene_with(faces=[[0.0, 1, 2]]), TypeError, "integers"),
        (scene_with(faces=[[0, 1]]), ValueError, "(n, 3)"),
        (scene_with(vertices=[[0, 0]] * 3), ValueError, "(n, 3)"),
        (scene_with(vertices=[["x", 0, 0]] * 3), TypeError, "real numbers"),
        (scene_with(vertices=[[0, 0, np.nan]] * 3), mt.SceneError, "/objects/0/shape/vertices"),
        (scene_with(normals=[[0, 0, 1]]), mt.SceneError, "normals"),
        (
            scene_with(uv=[[[0, 0]]]),
            mt.SceneError,
            "/shape/uv: must have as many elements as there are vertices",
        ),
        (mt.Scene(objects=[mt.Object(mt.Sphere(radius="big"))]), TypeError, "radius"),
        (mt.Scene(objects=[mt.Object(3)]), TypeError, "expected a shape"),
        (mt.Scene(objects=[mt.Object(mt.Quadric([1, 2]))]), TypeError, "coefficients"),
        (mt.Scene(lights=[mt.DirectionalLight((0, 0, 0))]), ValueError, "not zero"),
        (mt.Scene(lights=["sun"]), TypeError, "expected a light"),
        (mt.Scene(cameras=["mine"]), TypeError, "expected a camera"),
        (mt.Scene(materials=[mt.Material(alpha_mode="glass")]), ValueError, "opaque, mask, blend"),
        (mt.Scene(environment=mt.Environment("sky")), ValueError, "studio"),
        (mt.Scene(integrator="photon"), ValueError, "path"),
        (
            mt.Scene(materials=[mt.Material(roughness_factor=7)]),
            mt.SceneError,
            "/materials/0/rough",
        ),
        (
            mt.Scene(lights=[mt.PointLight(intensity=-1)]),
            mt.SceneError,
            "/lights/0/intensity",
        ),
        (mt.Scene(environment=mt.Environment((-1, 0, 0))), mt.SceneError, "/environment/content"),
        (mt.Scene(size=(10, -1)), TypeError, "size"),
    ],
)
def test_wrong_scenes(scene, error, text):
    with pytest.raises(error) as raised:
        scene.prepare()
    assert text in str(raised.value)


PARTS = {
    "specular": (mt.Specular, ("specular_factor", "specular_color_factor")),
    "transmission": (mt.Transmission, ("transmission_factor",)),
    "volume": (mt.Volume, ("thickness_factor", "attenuation_distance", "attenuation_color")),
    "volume_scatter": (mt.VolumeScatter, ("multiscatter_color", "scatter_anisotropy")),
    "clearcoat": (
        mt.Clearcoat,
        ("clearcoat_factor", "clearcoat_roughness_factor", "clearcoat_normal_scale"),
    ),
    "sheen": (mt.Sheen, ("sheen_color_factor", "sheen_roughness_factor")),
    "anisotropy": (mt.Anisotropy, ("anisotropy_strength", "anisotropy_rotation")),
    "iridescence": (
        mt.Iridescence,
        (
            "iridescence_factor",
            "iridescence_ior",
            "iridescence_thickness_minimum",
            "iridescence_thickness_maximum",
        ),
    ),
    "diffuse_transmission": (
        mt.DiffuseTransmission,
        ("diffuse_transmission_factor", "diffuse_transmission_color_factor"),
    ),
    "specular_glossiness": (mt.SpecularGlossiness, ("specular_factor", "glossiness_factor")),
}
OF_MATERIALS = ("base_color_factor", "metallic_factor", "roughness_factor", "emissive_factor")


def with_nan(kind, name):
    """Returns an object of a class with NaN in an attribute."""
    result = kind()
    value = getattr(result, name)
    nan = (np.nan,) * len(value) if isinstance(value, tuple) else np.nan
    setattr(result, name, nan)
    return result


def test_errors_have_the_names_of_attributes():
    scenes = {}
    for name in OF_MATERIALS:
        scenes[f"/materials/0/{name}"] = mt.Scene(materials=[with_nan(mt.Material, name)])
    for part, (kind, names) in PARTS.items():
        for name in names:
            material = mt.Material(**{part: with_nan(kind, name)})
            scenes[f"/materials/0/{part}/{name}"] = mt.Scene(materials=[material])
    spot = mt.SpotLight(inner_cone_angle=1, outer_cone_angle=0.5)
    scenes["/lights/0/outer_cone_angle"] = mt.Scene(lights=[spot])
    scenes["/lights/0/position"] = mt.Scene(lights=[mt.PointLight((np.nan, 0, 0))])
    calibrated = mt.CalibratedCamera(image_size=(0, 3))
    scenes["/cameras/0/image_size/width"] = mt.Scene(cameras=[calibrated])
    scenes["/cameras/0/vertical_fov"] = mt.Scene(cameras=[mt.PerspectiveCamera(vertical_fov=9)])
    for pointer, scene in scenes.items():
        with pytest.raises(mt.SceneError) as caught:
            scene.prepare()
        assert caught.value.diagnostic.pointer == pointer
    with pytest.raises(mt.SceneError, match="must be above inner_cone_angle, "):
        mt.Scene(lights=[spot]).prepare()
    with pytest.raises(mt.SceneError, match="number of vertices, 3$"):
        scene_with(faces=[[0, 1, 3]]).prepare()


def test_errors_of_files(tmp_path):
    with pytest.raises(FileNotFoundError):
        mt.load(tmp_path / "missing.glb")
    path = tmp_path / "scene.json"
    path.write_text('{\n  "version": 1,\n  "objects": 1\n}')
    with pytest.raises(mt.SceneError) as raised:
        mt.load(path)
    error = raised.value
    assert isinstance(error, ValueError) and error.diagnostic.line >= 1
    assert str(path) in str(error) and error.diagnostic.pointer.startswith("/")


def test_warnings_of_files(tmp_path):
    path = tmp_path / "empty.gltf"
    path.write_text('{"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_unknown"]}')
    with pytest.warns(mt.SceneWarning) as warned:
        mt.load(path)
    assert warned[0].filename == __file__
    assert warned[0].message.diagnostic.file == str(path)


def test_warnings_in_a_folder_whose_name_begins_like_ours(tmp_path):
    path = tmp_path / "empty.gltf"
    path.write_text('{"asset": {"version": "2.0"}, "extensionsUsed": ["EXT_unknown"]}')
    name = str(Path(mt.__file__).parent) + "_application/main.py"
    with pytest.warns(mt.SceneWarning) as warned:
        exec(compile("mt.load(path)", name, "exec"), {"mt": mt, "path": path})
    assert warned[0].filename == name


def test_origins_are_never_negative_zeros():
    assert [str(x) for x in mt.load(SCENES / "gltf" / "knot.glb").origin] == ["0.0"] * 3


def test_texts_of_tuples_of_arrays():
    material = mt.Material(base_color_factor=(np.ones(2), 1, 1, 1))
    assert repr(material) == "Material(base_color_factor=(<float64 (2,)>, 1, 1, 1))"


def test_standard_streams():
    program = "import microtrace as mt; mt.render(mt.load('-'), size=(4, 3), spp=1).save('-')"
    run = subprocess.run(
        [sys.executable, "-c", program],
        input=(SCENES / "gltf" / "cube.glb").read_bytes(),
        capture_output=True,
        check=True,
    )
    assert run.stdout.startswith(b"P6\n4 3\n255\n")


def test_only_missing_files_are_not_found(tmp_path):
    picture = mt.render(mt.Scene(objects=[mt.Object(mt.Sphere())]), size=(4, 4), spp=1)
    (tmp_path / "file").write_text("")
    for act, error in (
        (lambda: mt.load(tmp_path / "file" / "a.json"), mt.FileError),
        (lambda: picture.save(tmp_path / "file" / "a.png"), mt.FileError),
        (lambda: picture.save("/dev/full"), mt.FileError),
        (lambda: mt.load(tmp_path / "none" / "a.json"), FileNotFoundError),
        (lambda: picture.save(tmp_path / "none" / "a.png"), FileNotFoundError),
    ):
        with pytest.raises(error) as caught:
            act()
        assert isinstance(caught.value, FileNotFoundError) == (error is FileNotFoundError)


def test_paths_that_cannot_be_examined():
    with pytest.raises(mt.FileError) as caught:
        mt.load("a" * 300 + ".glb")
    assert isinstance(caught.value, OSError) and not isinstance(caught.value, FileNotFoundError)


def test_warnings_can_be_pickled():
    diagnostic = mt.Diagnostic("a.gltf", 1, 2, "/nodes", "odd", "a.gltf:1:2: odd")
    warning = pickle.loads(pickle.dumps(mt.SceneWarning(diagnostic)))
    assert warning.diagnostic == diagnostic and str(warning) == diagnostic.text


def test_warnings_and_errors_of_texts():
    with pytest.warns(mt.SceneWarning, match="^odd$") as caught:
        warnings.warn("odd", mt.SceneWarning, stacklevel=1)
    for made in (caught[0].message, mt.SceneWarning("odd"), mt.SceneError("odd")):
        for each in (made, pickle.loads(pickle.dumps(made))):
            assert str(each) == "odd" and each.args == ("odd",)
            assert each.diagnostic == mt.Diagnostic("", 0, 0, "", "odd", "odd")
    assert str(mt.SceneWarning()) == str(mt.Error()) == ""
    error = mt.FileError(errno.EIO, "broken", "a.glb")
    assert str(error) == f"[Errno {errno.EIO}] broken: 'a.glb'"


def test_file_errors_have_the_attributes_of_the_system(tmp_path):
    picture = mt.render(mt.Scene(objects=[mt.Object(mt.Sphere())]), size=(4, 4), spp=1)
    missing, file = str(tmp_path / "none.glb"), tmp_path / "file"
    file.write_text("")
    scene = tmp_path / "scene.json"
    scene.write_text('{"version": 1, "objects": [{"type": "mesh", "file": "none.glb"}]}')
    for act, number, name in (
        (lambda: mt.load(missing), errno.ENOENT, missing),
        (lambda: mt.load(file / "a.json"), errno.ENOTDIR, str(file / "a.json")),
        (lambda: picture.save("/dev/full"), errno.ENOSPC, "/dev/full"),
        (lambda: mt.load(scene), errno.ENOENT, None),
        (lambda: mt.load(tmp_path), errno.EISDIR, str(tmp_path)),
        (lambda: picture.save(file / "a.exr"), errno.ENOTDIR, str(file / "a.exr")),
    ):
        with pytest.raises(mt.FileError) as caught:
            act()
        for error in (caught.value, pickle.loads(pickle.dumps(caught.value))):
            assert error.errno == number and error.filename == name
            assert error.strerror == (os.strerror(number))
            assert str(error) == error.diagnostic.text
            assert error.diagnostic.file == (name or str(scene))


def test_no_leaks():
    vertices, faces = icosphere(1)
    rays = np.zeros((10, 6))

    def once():
        scene = mt.Scene()
        scene.add_mesh(vertices, faces, material=mt.Material(base_color_texture=IMAGE))
        prepared = scene.prepare()
        prepared.intersect(rays)
        assert len(prepared.scene.objects) == 1

    for _ in range(50):
        once()
    gc.collect()
    tracemalloc.start()
    resident = _resident()
    before = tracemalloc.take_snapshot()
    for _ in range(1000):
        once()
    gc.collect()
    growth = sum(s.size_diff for s in tracemalloc.take_snapshot().compare_to(before, "filename"))
    tracemalloc.stop()
    assert growth < 200_000
    assert _resident() - resident < 30 * 2**20


IMAGE = mt.Image(np.zeros((64, 64, 3), np.uint8))


def _resident() -> int:
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * 4096


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"background": (1, 2)}, "background must have 3 numbers"),
        ({"epsilon": "x"}, "epsilon must be a number, not 'x'"),
        ({"background": (np.nan, 0, 0)}, "/background"),
        ({"origin": (0, np.inf, 0)}, "/origin"),
        ({"epsilon": -1}, "/epsilon"),
        ({"size": (0, 0)}, "/size/width"),
        ({"size": (70000, 1)}, "/size/width"),
    ],
)
def test_wrong_numbers_of_a_scene(fields, message):
    with pytest.raises((ValueError, TypeError, mt.Error), match=message):
        mt.Scene(**fields).prepare()
