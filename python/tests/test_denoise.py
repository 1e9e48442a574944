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


def test_threads_do_not_change_the_bytes(scene):
    pictures = [
        mt.render(scene, size=SIZE, spp=4, integrator="path", denoise=True, threads=n)["color"]
        for n in (1, 2, 3)
    ]
    assert all(np.array_equal(picture, pictures[0]) for picture in pictures)


def test_the_program_gives_the_same_bytes(scene, tmp_path):
    picture = mt.render(scene, size=SIZE, spp=4, integrator="path", denoise=True)
    picture.save(tmp_path / "python.png")
    microtrace = [sys.executable, "-c", "from microtrace_program import main; main()"]
    arguments = ["--size", "64x48", "--spp", "4", "--integrator", "path", "--denoise", "--quiet"]
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
