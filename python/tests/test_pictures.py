"""Pictures equal the program's, byte by byte."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time

import microtrace as mt
import numpy as np
import pytest
from conftest import SCENES

KNOT = SCENES / "gltf" / "knot.glb"
MATERIALS = SCENES / "gltf" / "materials.glb"
SIZE = (64, 48)


def run(program, *arguments):
    subprocess.run(
        [program, *map(str, arguments), "--size", "64x48", "--quiet"], check=True, timeout=300
    )


@pytest.mark.parametrize(
    "scene, options, arguments",
    [
        (KNOT, [], {}),
        (MATERIALS, ["--samples", 4, "--seed", 7], {"spp": 4, "seed": 7}),
        (MATERIALS, ["--integrator", "flat"], {"integrator": "flat"}),
        (
            KNOT,
            ["--samples", 3, "--filter", "blackman-harris"],
            {"spp": 3, "filter": "blackman-harris"},
        ),
        (KNOT, ["--samples", 2, "--background", "transparent"], {"spp": 2, "transparent": True}),
        (KNOT, ["--samples", 2, "--max-depth", 2], {"spp": 2, "max_depth": 2}),
        (
            KNOT,
            ["--samples", 2, "--env", "0.5,0.25,1", "--background", "0.1,0.2,0.3"],
            {
                "spp": 2,
                "environment": mt.Environment((0.5, 0.25, 1)),
                "background": (0.1, 0.2, 0.3),
            },
        ),
        (SCENES / "perspective1.json", [], {}),
        (SCENES / "perspective1.json", ["--integrator", "path"], {"integrator": "path", "spp": 64}),
    ],
)
def test_equal_the_program(program, tmp_path, scene, options, arguments):
    ours, theirs = tmp_path / "ours.png", tmp_path / "theirs.png"
    run(program, scene, *options, "-o", theirs)
    mt.render(mt.load(scene), size=SIZE, **arguments).save(ours)
    assert ours.read_bytes() == theirs.read_bytes()


def test_exr_equals_the_program(program, tmp_path):
    ours, theirs = tmp_path / "ours.exr", tmp_path / "theirs.exr"
    aovs = "depth,distance,position,normal,face_normal,uv,barycentric,albedo,id,variance,samples"
    run(program, MATERIALS, "--samples", 4, "--aov", aovs, "-o", theirs)
    names = aovs.replace("id", "object,primitive,material").split(",")
    mt.render(mt.load(MATERIALS), size=SIZE, spp=4, aovs=["color", *names]).save(ours)
    assert ours.read_bytes() == theirs.read_bytes()


def test_data_without_color_equals_data_with_color():
    prepared = mt.load(MATERIALS).prepare()
    names = ["depth", "normal", "face_normal", "object", "primitive", "material", "uv", "position"]
    alone = mt.render(prepared, size=SIZE, aovs=names)
    beside = mt.render(prepared, size=SIZE, spp=1, aovs=["color", *names])
    for name in names:
        assert np.array_equal(alone[name], beside[name]), name
    assert alone.object.dtype == np.uint32 and alone.depth.shape == (48, 64)
    assert alone.normal.shape == (48, 64, 3)
    assert np.array_equal(np.isinf(alone.depth), alone.object == 0)
    rays_hit = alone.object > 0
    lengths = np.linalg.norm(alone.normal[rays_hit], axis=1)
    assert np.allclose(lengths, 1, atol=1e-6)


def test_stacks_threads_and_detail():
    prepared = mt.load(KNOT).prepare()
    cameras = [mt.frame(prepared, azimuth=90 * k, size=SIZE) for k in range(3)]
    stack = mt.render(prepared, cameras, SIZE, spp=2, aovs=["color", "depth"], threads=3)
    assert stack.color.shape == (3, 48, 64, 3) and stack.depth.shape == (3, 48, 64)
    for k, camera in enumerate(cameras):
        one = mt.render(prepared, camera, SIZE, spp=2, aovs=["color", "depth"], threads=1)
        assert np.array_equal(one.color, stack.color[k])
        assert np.array_equal(one.depth, stack.one(k).depth)
    shape = mt.load(KNOT, detail="shape").prepare()
    data = mt.render(shape, cameras[0], SIZE, aovs=["depth", "normal"])
    assert np.array_equal(data.depth, stack.depth[0])


def test_tonemap_and_notebook(tmp_path):
    picture = mt.render(mt.load(KNOT), size=SIZE, spp=2)
    path = tmp_path / "picture.ppm"
    picture.save(path)
    assert path.read_bytes().endswith(picture.tonemap().tobytes())
    assert (picture.tonemap(exposure=1).astype(int) >= picture.tonemap()).all()
    assert picture._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(ValueError, match="unknown tone map"):
        picture.tonemap(tone_map="sepia")
    for path in (tmp_path / "x.png", tmp_path / "no" / "x.png"):
        if path.parent.exists():
            picture.save(path, exposure=2, tone_map="aces")
        else:
            with pytest.raises(mt.FileError):
                picture.save(path)
    clear = mt.render(mt.load(KNOT), size=SIZE, spp=2, transparent=True)
    assert clear.tonemap().shape == (48, 64, 4)


def test_cameras():
    scene = mt.load(KNOT)
    prepared = scene.prepare()
    eye = (4.0, 3.0, 10.0)
    near = mt.render(prepared, mt.look_at(eye, (0, 0, 0)), SIZE, aovs=["position", "distance"])
    seen = np.isfinite(near.distance)
    assert seen.any()
    distance = np.linalg.norm(near.position[seen] - np.array(eye), axis=1)
    assert np.allclose(distance, near.distance[seen], rtol=1e-5)
    flat = mt.render(
        prepared, mt.OrthographicCamera(position=(0, 0, 10), height=8), SIZE, aovs="depth"
    )
    assert np.isfinite(flat.depth).any()
    around = mt.render(prepared, mt.EnvironmentCamera(position=(0, 0, 0.1)), SIZE, aovs="depth")
    assert np.isfinite(around.depth).any()


def test_wrong_arguments():
    prepared = mt.load(KNOT).prepare()
    for arguments, text in [
        ({"aovs": ["dept"]}, "unknown AOV"),
        ({"aovs": []}, "at least one"),
        ({"spp": 0}, "samples"),
        ({"integrator": "x"}, "integrator"),
        ({"filter": "gauss"}, "filter"),
    ]:
        with pytest.raises(ValueError, match=text):
            mt.render(prepared, size=SIZE, **arguments)
    with pytest.raises(TypeError, match="expected a camera"):
        mt.render(prepared, "front")
    with pytest.raises(KeyError, match="add 'depth' to aovs"):
        mt.render(prepared, size=SIZE, spp=1)["depth"]


def test_progress_and_cancel():
    prepared = mt.load(KNOT).prepare()
    shares: list[float] = []
    mt.render(prepared, size=SIZE, spp=4, progress=shares.append)
    assert shares == sorted(shares) and shares[-1] == 1
    with pytest.raises(mt.CanceledError):
        mt.render(prepared, size=SIZE, progress=lambda share: share < 0.5)
    with pytest.raises(ZeroDivisionError):
        mt.render(prepared, size=SIZE, progress=lambda share: 1 / 0)


def test_interrupt():
    prepared = mt.load(KNOT).prepare()
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        mt.render(prepared, size=(1920, 1080), spp=4096)
    assert time.monotonic() - start < 30  # not to the end, which takes hours
