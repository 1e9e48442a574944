"""Tests that meshes without tangents get those that glTF assets get."""

import microtrace as mt
import numpy as np
import pytest
from conftest import SCENES


def bumps():
    y, x = np.mgrid[:64, :64] / 64 * 2 * np.pi
    tilt = np.stack([0.5 * np.sin(3 * x), 0.5 * np.cos(2 * y), np.ones_like(x)], axis=-1)
    return np.uint8(tilt * 127.5 + 127.5)


def square(**material):
    scene = mt.Scene()
    corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
    scene.add_mesh(
        corners,
        [[0, 1, 2], [0, 2, 3]],
        normals=[[0, 0, 1]] * 4,
        uv=[[0, 1], [1, 1], [1, 0], [0, 0]],
        material=mt.Material(metallic_factor=1, roughness_factor=0.3, **material),
    )
    return scene


def color(scene):
    camera = mt.look_at((1, 0.5, 2), (0, 0, 0))
    return mt.render(scene.prepare(), camera, size=(32, 24), spp=4).color


@pytest.mark.parametrize(
    "material",
    [
        {"normal_texture": bumps()},
        {"clearcoat": mt.Clearcoat(1.0, clearcoat_normal_texture=bumps())},
        {"anisotropy": mt.Anisotropy(0.9)},
    ],
)
def test_materials_that_need_tangents_have_an_effect(material):
    plain = {"clearcoat": mt.Clearcoat(1.0)} if "clearcoat" in material else {}
    with_map, without = color(square(**material)), color(square(**plain))
    assert np.abs(with_map - without).max() > 0.01
    given = square(**material)
    mesh = given.objects[0].shape
    mesh.tangents = np.tile(np.float32([1, 0, 0, 1]), (4, 1))
    np.testing.assert_array_equal(color(given), with_map)


def test_generated_tangents_are_those_of_gltf_assets():
    scene = mt.load(SCENES / "gltf" / "textured.glb")
    expected = mt.render(scene.prepare(), size=(48, 36), spp=3).color
    stripped = 0
    for item in scene.objects:
        if isinstance(item.shape, mt.Mesh) and item.shape.tangents is not None:
            item.shape.tangents = None
            stripped += 1
    assert stripped > 0
    # Those of the asset were made before its nodes' transforms, and rounded after them.
    actual = mt.render(scene.prepare(), size=(48, 36), spp=3).color
    np.testing.assert_allclose(actual, expected, atol=1e-4)


def test_meshes_without_texture_coordinates_stay_as_they_are():
    scene = square(normal_texture=bumps())
    scene.objects[0].shape.uv = ()
    plain = square()
    np.testing.assert_array_equal(color(scene), color(plain))
