"""Tests denoising by the real library, Open Image Denoise."""

from __future__ import annotations

import os
import subprocess
import sys

import microtrace as mt
import numpy as np
import pytest
from conftest import SCENES

SCENE = SCENES / "room.json"
SIZE = (64, 48)


@pytest.fixture(scope="module")
def scene():
    return mt.load(SCENE).prepare()


def test_denoised_pictures_are_closer_to_the_truth(scene):
    noisy = mt.render(scene, size=SIZE, spp=8, integrator="path")["color"]
    denoised = mt.render(scene, size=SIZE, spp=8, integrator="path", denoise=True)
    truth = mt.render(scene, size=SIZE, spp=512, seed=1, integrator="path")["color"]
    assert set(denoised) == {"color"}

    def error(color):
        return np.sqrt(np.mean((color[..., :3] - truth[..., :3]) ** 2))

    assert error(denoised["color"]) < 0.6 * error(noisy)


def blurred() -> mt.PerspectiveCamera:
    """Returns a camera with a lens, to which the whole room is out of focus."""
    return mt.PerspectiveCamera(position=(0, 0, 4), focus=1.5, lens_radius=0.2)


def test_blur_has_less_noise(scene):
    def color(spp, seed=0, denoise=False):
        picture = mt.render(
            scene, blurred(), SIZE, spp=spp, seed=seed, integrator="path", denoise=denoise
        )
        return picture["color"]

    truth = color(512, seed=1)

    def error(picture):
        return np.sqrt(np.mean((picture - truth) ** 2))

    # 0.75 if features and lamps keep the noise of the lens.
    assert error(color(8, denoise=True)) < 0.5 * error(color(8))


def test_shadows_on_the_ground_have_less_noise():
    prepared = mt.load(SCENES / "gltf/materials.glb").prepare()

    def color(spp, seed=0, denoise=False):
        picture = mt.render(prepared, size=SIZE, spp=spp, seed=seed, ground=True, denoise=denoise)
        return picture["color"]

    shown = mt.render(prepared, size=SIZE, spp=1, aovs=["denoise_normal"])["denoise_normal"]
    ground = np.all(shown == 0, axis=-1)
    truth = color(512, seed=1)

    def error(picture):
        return np.sqrt(np.mean((picture - truth)[ground] ** 2))

    assert error(color(8, denoise=True)) < 0.8 * error(color(8))


@pytest.mark.parametrize("camera", [None, blurred()])
def test_threads_do_not_change_the_bytes(scene, camera):
    pictures = [
        mt.render(scene, camera, SIZE, spp=4, integrator="path", denoise=True, threads=n)["color"]
        for n in (1, 2, 3)
    ]
    assert all(np.array_equal(picture, pictures[0]) for picture in pictures)


@pytest.mark.parametrize("options", [[], ["--aperture", "0.2", "--focus", "1.5"]])
def test_the_program_gives_the_same_bytes(scene, tmp_path, options):
    camera = None
    if options:
        camera = mt.load(SCENE).cameras[0]
        camera.lens_radius, camera.focus = 0.2, 1.5
    picture = mt.render(scene, camera, SIZE, spp=4, integrator="path", denoise=True)
    picture.save(tmp_path / "python.png")
    microtrace = [sys.executable, "-c", "from microtrace_program import main; main()"]
    arguments = ["--size", "64x48", "--spp", "4", "--integrator", "path", "--denoise", "--quiet"]
    arguments += options
    subprocess.run(
        [*microtrace, str(SCENE), *arguments, "-o", str(tmp_path / "program.png")], check=True
    )
    bytes_of_python = (tmp_path / "python.png").read_bytes()
    assert bytes_of_python == (tmp_path / "program.png").read_bytes()
    assert b"microtrace:denoiser\0Open Image Denoise 2." in bytes_of_python


def test_errors(scene, monkeypatch):
    with pytest.raises(ValueError, match="path"):
        mt.render(scene, size=SIZE, integrator="flat", denoise=True)
    with pytest.raises(ValueError, match="color"):
        mt.render(scene, size=SIZE, integrator="path", aovs=["depth"], denoise=True)
    shutter = mt.Shutter(lambda time: (scene, mt.frame(scene)), 0, 1)
    with pytest.raises(ValueError, match="shutter"):
        mt.render(scene, size=SIZE, integrator="path", denoise=True, shutter=shutter)
    monkeypatch.setenv("MICROTRACE_OIDN_PATH", os.devnull + "/missing")
    with pytest.raises(mt.UnsupportedError, match="pip install"):
        mt.render(scene, size=SIZE, integrator="path", denoise=True)
