"""Tests that pictures equal those of the program byte for byte."""

from __future__ import annotations

import json
import os
import platform
import struct
import subprocess
import sys
import threading
import types
import warnings

import microtrace as mt
import numpy as np
import pytest
from conftest import SCENES, interrupted_after

KNOT = SCENES / "gltf" / "knot.glb"
MATERIALS = SCENES / "gltf" / "materials.glb"
SIZE = (64, 48)


def run(program, *arguments):
    subprocess.run(
        [program, *map(str, arguments), "--size", "64x48", "--quiet"], check=True, timeout=300
    )


@pytest.mark.parametrize(
    ("words", "options"),
    [("transparent", {"transparent": True}), ("0.1,0.2,0.3", {"background": (0.1, 0.2, 0.3)})],
)
def test_backgrounds_replace_an_environment_that_is_visible(program, tmp_path, words, options):
    scene = SCENES / "light.json"
    path = ["--integrator", "path", "--spp", 2]
    run(program, scene, *path, "--background", words, "-o", tmp_path / "a.exr")
    picture = mt.render(mt.load(scene), size=SIZE, integrator="path", spp=2, **options)
    picture.save(tmp_path / "b.exr")
    assert (tmp_path / "b.exr").read_bytes() == (tmp_path / "a.exr").read_bytes()
    # An environment that is given stays visible.
    sky = mt.Environment((0.5, 0.5, 0.5), is_background=True)
    picture = mt.render(
        mt.load(scene), size=SIZE, integrator="path", spp=2, environment=sky, **options
    )
    assert (picture.color[0, 0] == ([0.5] * 3 + [1])[: picture.color.shape[-1]]).all()


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
        (MATERIALS, ["--samples", 2, "--bsdf", "spec"], {"spp": 2, "bsdf": "spec"}),
        (KNOT, ["--samples", 2, "--guiding"], {"spp": 2, "guiding": True}),
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
    scene = mt.load(MATERIALS).prepare()
    mt.render(scene, size=SIZE, spp=4, aovs=["color", *names]).save(ours)
    assert ours.read_bytes() == theirs.read_bytes()
    # The program stores where a crop is in the whole picture.
    run(program, MATERIALS, "--samples", 4, "--crop", "5,7,40,31", "-o", theirs)
    mt.render(scene, size=SIZE, spp=4, crop=(5, 7, 40, 31)).save(ours)
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


def with_brighter_lights(source, factor, path):
    """Writes a copy of a binary glTF asset whose lights have this many times the intensity."""
    data = source.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    document = json.loads(data[20 : 20 + length])
    for light in document["extensions"]["KHR_lights_punctual"]["lights"]:
        light["intensity"] = light.get("intensity", 1) * factor
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    head = b"glTF" + struct.pack("<3I", 2, 20 + len(text) + len(rest), len(text)) + b"JSON"
    path.write_bytes(head + text + rest)
    return path


def test_lights_of_files_are_not_blown_out(program, tmp_path):
    bright = with_brighter_lights(SCENES / "gltf" / "lamps.glb", 1024, tmp_path / "bright.glb")
    ours, theirs = tmp_path / "ours.png", tmp_path / "theirs.png"
    run(program, bright, "--spp", 2, "-o", theirs)
    scene = mt.load(bright).prepare()
    picture = mt.render(scene, size=SIZE, spp=2)
    picture.save(ours)
    assert ours.read_bytes() == theirs.read_bytes()
    plain = mt.render(scene, size=SIZE, spp=2, exposure=0)
    assert np.array_equal(plain.color, picture.color)
    assert np.median(plain.tonemap()) > 200 > np.median(picture.tonemap())
    cut = mt.render(scene, size=SIZE, spp=1, exposure="auto", crop=(0, 0, 8, 8))
    assert cut._exposure == picture._exposure < -1
    flat = mt.render(scene, size=SIZE, integrator="flat")
    assert flat._exposure == 0
    for value, error in ((65, ValueError), (float("nan"), ValueError), ("bright", TypeError)):
        with pytest.raises(error, match="exposure"):
            mt.render(scene, size=SIZE, exposure=value)
    for value in ("automatic", "1", [1, 2]):  # texts are no numbers
        with pytest.raises(TypeError, match=r'exposure must be a number, "auto" or None, not '):
            mt.render(scene, size=SIZE, exposure=value)
        with pytest.raises(TypeError, match="ground must be True, False or a height, not "):
            mt.render(scene, size=SIZE, ground=value)
        with pytest.raises(TypeError, match="exposure must be a number, not "):
            picture.tonemap(exposure=value)


def test_the_module_runs_the_program(tmp_path):
    arguments = [KNOT, "--size", "16x12", "--spp", "1", "-q", "-o", tmp_path / "module.png"]
    subprocess.run([sys.executable, "-m", "microtrace", *arguments], check=True)
    mt.render(mt.load(KNOT), size=(16, 12), spp=1).save(tmp_path / "ours.png")
    assert (tmp_path / "module.png").read_bytes() == (tmp_path / "ours.png").read_bytes()
    wrong = subprocess.run([sys.executable, "-m", "microtrace"], capture_output=True)
    assert wrong.returncode == 2 and b"SCENE is required" in wrong.stderr


def test_ground(program, tmp_path):
    cube = SCENES / "gltf" / "cube.glb"
    ours, theirs = tmp_path / "ours.png", tmp_path / "theirs.png"
    scene = mt.load(cube).prepare()
    arguments = {"size": SIZE, "spp": 4, "transparent": True}
    plain = mt.render(scene, **arguments)
    for ground, option in ((True, "--ground"), (-2, "--ground=-2")):
        options = ("--spp", 4, "--background", "transparent")
        run(program, cube, *options, option, "-o", theirs)
        picture = mt.render(scene, ground=ground, **arguments)
        picture.save(ours)
        assert ours.read_bytes() == theirs.read_bytes()
        assert (picture.color[..., 3] >= plain.color[..., 3]).all()
        assert np.array_equal(picture.color[..., :3], plain.color[..., :3])
        assert (picture.color[..., 3] > plain.color[..., 3]).sum() > 100
    for value, error in (("low", TypeError), (float("nan"), ValueError), (1e39, ValueError)):
        with pytest.raises(error, match="ground"):
            mt.render(scene, ground=value)
    with pytest.raises(ValueError, match="integrator"):
        mt.render(scene, ground=True, integrator="flat")


def test_colors_are_rounded_to_nearest():
    script = """
import ctypes, numpy as np, microtrace as mt
libm = ctypes.CDLL("libm.so.6")
scene = mt.Scene().prepare()
def picture():
    return mt.render(scene, mt.PerspectiveCamera(), (2, 2), background=(0.1, 0.2, 0.3)).color
usual = picture()
libm.fesetround(0x400)  # downward, in x86
other = picture()
libm.fesetround(0)
assert np.array_equal(usual, other)
"""
    if platform.machine() == "x86_64":
        subprocess.run([sys.executable, "-c", script], check=True)


def test_a_ground_without_a_lowest_point():
    scene = mt.Scene(lights=[mt.PointLight(position=(0, 1, 0))])
    scene.add_plane((0, 0, -5), (0, 0, 1))
    arguments = {"camera": mt.look_at((0, 1, 0), (0, 0, -4)), "size": (8, 8), "spp": 1}
    with pytest.warns(
        mt.SceneWarning, match="no lowest point for the ground; .* ground=0"
    ) as caught:
        picture = mt.render(scene, ground=True, **arguments)
    assert [(w.filename, w.message.diagnostic.file) for w in caught] == [(__file__, "")]
    assert np.array_equal(picture.color, mt.render(scene, **arguments).color)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mt.render(scene, ground=0, **arguments)
        scene.add_sphere((0, 0, -3), 0.5)
        mt.render(scene, ground=True, **arguments)


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
    with pytest.raises(ValueError, match="tone_map must be one of none, "):
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
        ({"integrator": "x"}, "integrator"),
        ({"filter": "gauss"}, "filter"),
        ({"bsdf": "phong"}, "bsdf must be"),
        ({"size": (0, 10)}, "size must be from 1 to 65536"),
        ({"size": (1, 2, 3)}, "a width and a height"),
        ({"guiding": True, "integrator": "flat"}, 'guiding .* integrator="path"'),
        ({"bsdf": "spec", "integrator": "flat"}, 'bsdf .* integrator="path"'),
        ({"crop": (3, 3, 1, 4)}, "crop must be .* x1 <= 64 and .* y1 <= 48, not .3, 3, 1, 4."),
        ({"crop": (0, 0, 65, 1)}, "crop must be"),
        ({"crop": (0, -1, 1, 1)}, "crop must be"),
        ({"crop": (2, 0, 2, 1)}, "crop must be"),
        ({"spp": -1}, "spp must be from 1"),
        ({"seed": -1}, "seed must be from 0"),
        ({"max_depth": 0}, "max_depth must be from 1"),
        ({"max_depth": 65537}, "max_depth must be from 1 to 65536"),
        ({"threads": -1}, "threads must be from 0"),
        ({"threads": 1025}, "threads must be from 0 to 1024"),
        ({"background": (1, 2)}, "background must have 3"),
        ({"background": (0, 0, 1.5)}, "background must have numbers from 0 to 1, not"),
        ({"background": (-0.5, 0, 0)}, "background must have numbers from 0 to 1, not"),
        ({"environment": mt.Environment((np.nan, 0, 0))}, "/environment/content"),
        (
            {"camera": mt.PerspectiveCamera(position=(np.nan, 0, 0))},
            "^/camera/position: must be finite",
        ),
        ({"camera": mt.look_at((1, 0, 0), (1, 0, 0))}, "/direction: must not be zero"),
        ({"camera": mt.look_at((0, 5, 0), (0, 0, 0))}, "/up: must not be parallel"),
        ({"camera": mt.PerspectiveCamera(vertical_fov=4)}, "/vertical_fov"),
    ]:
        with pytest.raises(ValueError, match=text):
            mt.render(prepared, **{"size": SIZE, **arguments})
    for arguments, text in [
        ({"size": (16.5, 12)}, "size must be an integer"),
        ({"spp": "many"}, "spp must be an integer"),
        ({"environment": "studio"}, "expected an Environment"),
    ]:
        with pytest.raises(TypeError, match=text):
            mt.render(prepared, **{"size": SIZE, **arguments})
    with pytest.raises(TypeError, match="expected a Scene"):
        mt.render(None)
    with pytest.raises(TypeError, match="expected a camera"):
        mt.render(prepared, "front")
    with pytest.raises(KeyError, match="add 'depth' to aovs"):
        mt.render(prepared, size=SIZE, spp=1)["depth"]


def test_results_of_progress_functions():
    scene = mt.Scene()
    scene.add_sphere()
    for result in (None, True, np.True_, "text", 7, 0, ""):
        mt.render(scene, size=(8, 8), aovs=["depth"], progress=lambda share, r=result: r)
    for result in (False, np.False_):
        with pytest.raises(mt.CanceledError):
            mt.render(scene, size=(8, 8), aovs=["depth"], progress=lambda share, r=result: r)


def test_pictures_are_compared_by_identity():
    scene = mt.Scene()
    scene.add_sphere()
    one, other = (mt.render(scene, size=(4, 4), aovs=["depth"]) for _ in range(2))
    assert one == one and one != other and one in [other, one] and {one: 1}[one] == 1


def test_ranges_of_arguments():
    scene = mt.Scene()
    scene.add_sphere()
    picture = mt.render(scene, mt.look_at((0, 0, 5), (0, 0, 0)), (4, 4))
    for wrong in (
        lambda: picture.one(0),
        lambda: picture.tonemap(exposure=np.nan),
        lambda: mt.frame(scene, azimuth=np.nan),
        lambda: mt.frame(scene, elevation=91),
        lambda: mt.frame(scene, vertical_fov_degrees=0),
        lambda: mt.look_at((np.nan, 0, 0), (0, 0, 0)),
        lambda: mt.look_at((1, 0, 0), (0, 0, 0), vertical_fov_degrees=180),
        lambda: mt.render(scene, size=5),
        lambda: scene.prepare().intersect(np.ones((3, 6)), t_min=[1, 2]),
    ):
        with pytest.raises(ValueError):
            wrong()


def test_small_numbers_of_numpy():
    prepared = mt.load(KNOT).prepare()
    camera = mt.PerspectiveCamera(position=np.array([0, 0, 9.0]), vertical_fov=np.float32(1))
    picture = mt.render(prepared, camera, np.array([16, 12]), spp=np.int64(1), threads=np.uint8(1))
    assert picture.color.shape == (12, 16, 3)


def test_lens():
    prepared = mt.load(KNOT).prepare()
    camera = mt.PerspectiveCamera(position=(0, 0, 9), focus=9, lens_radius=0.5)
    pinhole = mt.PerspectiveCamera(position=(0, 0, 9), focus=3)
    pictures = [mt.render(prepared, c, SIZE, spp=4).color for c in (camera, pinhole)]
    assert not np.array_equal(*pictures)
    with pytest.raises(ValueError, match="lens_radius"):
        mt.render(prepared, mt.PerspectiveCamera(lens_radius=-1), SIZE, spp=1)


def test_shutter():
    def moment(time):
        scene = mt.Scene()
        scene.add_sphere((time, 0, 0), 1)
        return scene, mt.PerspectiveCamera(position=(0, 0, 9))

    scene, camera = moment(0.25)
    still = mt.render(scene, camera, SIZE, spp=3).color
    closed = mt.Shutter(moment, 0.25, 0.25)
    assert np.array_equal(mt.render(scene, camera, SIZE, spp=3, shutter=closed).color, still)
    moving = mt.Shutter(moment, 0, 2, times=4)
    pictures = [
        mt.render(scene, camera, SIZE, spp=3, threads=n, shutter=moving).color for n in (1, 3)
    ]
    assert np.array_equal(*pictures)
    assert not np.array_equal(pictures[0], still)
    with pytest.raises(ValueError, match="one camera"):
        mt.render(scene, [camera, camera], SIZE, spp=3, shutter=moving)
    with pytest.raises(ZeroDivisionError):
        mt.render(scene, camera, SIZE, spp=3, shutter=mt.Shutter(lambda time: 1 / 0, 0, 1))


def test_progress_and_cancel():
    prepared = mt.load(KNOT).prepare()
    shares: list[float] = []
    mt.render(prepared, size=SIZE, spp=4, progress=shares.append)
    assert shares == sorted(shares) and shares[-1] == 1
    with pytest.raises(mt.CanceledError):
        mt.render(prepared, size=SIZE, progress=lambda share: share < 0.5)
    with pytest.raises(ZeroDivisionError):
        mt.render(prepared, size=SIZE, progress=lambda share: 1 / 0)


def test_progress_bar_without_standard_error(monkeypatch):
    tqdm = types.ModuleType("tqdm.auto")
    tqdm.tqdm = lambda **options: 1 / 0  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", tqdm)
    monkeypatch.setattr(sys, "stderr", None)
    mt.render(mt.load(KNOT), size=(8, 8), spp=1, progress=True)


def test_functions_are_called_on_the_calling_thread():
    prepared, threads = mt.load(KNOT).prepare(), set()

    def moment(time):
        threads.add(threading.get_ident())
        return prepared, mt.frame(prepared.scene)

    camera = mt.frame(prepared.scene)
    shutter = mt.Shutter(moment, 0, 1, times=2)

    def progress(share):
        threads.add(threading.get_ident())

    mt.render(prepared, camera, SIZE, spp=4, shutter=shutter, progress=progress)
    assert threads == {threading.get_ident()}


def test_interrupt_of_a_progress_function_that_blocks():
    with interrupted_after(0.5):
        mt.render(mt.load(KNOT), size=SIZE, spp=4, progress=lambda _: threading.Event().wait())


def test_interrupt():
    prepared = mt.load(KNOT).prepare()
    with interrupted_after(0.5):
        mt.render(prepared, size=(1920, 1080), spp=4096)  # would take hours


def test_names_of_arrays_are_completed():
    picture = mt.render(mt.load(KNOT).prepare(), size=(8, 6), spp=1, aovs=["color", "depth"])
    assert {"color", "depth", "save", "tonemap"} <= set(dir(picture))
    assert picture._ipython_key_completions_() == ["color", "depth"]


def end_while_a_thread_renders(ending: str) -> None:
    """Runs a program whose main thread executes `ending` while another one renders."""
    program = f"""
import os, sys, threading, time
import microtrace as mt
prepared = mt.load({str(KNOT)!r}).prepare()
started = threading.Event()
def render():
    mt.render(prepared, size=(640, 480), spp=65536, progress=lambda share: started.set())
threading.Thread(target=render, daemon=True).start()
assert started.wait(60)
{ending}
"""
    # Python warns of fork() in processes with threads from version 3.12 on.
    command = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", program]
    result = subprocess.run(command, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""


def test_exit_while_a_thread_renders():
    end_while_a_thread_renders("")


def test_exit_of_forked_processes_while_a_thread_renders():
    end_while_a_thread_renders("""
start = time.monotonic()
for _ in range(8):
    if (child := os.fork()) == 0:
        sys.exit()
    assert os.waitpid(child, 0)[1] == 0
assert time.monotonic() - start < 30  # each of them would wait 5 s for the thread
""")


def test_exit_while_a_progress_function_runs():
    # It runs for longer than the interpreter waits.
    run_program(f"""
import threading
import microtrace as mt
started = threading.Event()
def progress(share):
    started.set()
    while True:
        pass
def render():
    mt.render(mt.load({str(KNOT)!r}), size=(64, 48), spp=4, progress=progress)
threading.Thread(target=render, daemon=True).start()
started.wait()
""")


REFUSE_THREADS = """
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
typedef int Create(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
int refused;
int pthread_create(pthread_t* thread, const pthread_attr_t* how, void* (*f)(void*), void* x) {
  if (__atomic_fetch_sub(&refused, 1, __ATOMIC_RELAXED) > 0) return EAGAIN;
  return ((Create*)dlsym(RTLD_NEXT, "pthread_create"))(thread, how, f, x);
}
"""


@pytest.mark.parametrize("refused", [1, 2, 100])
def test_progress_if_the_system_refuses_threads(tmp_path, refused):
    # Without a thread for it, the calling thread renders, and others may call the function.
    library = tmp_path / "refuse.so"
    compile = ["cc", "-D_GNU_SOURCE", "-shared", "-fPIC", "-x", "c", "-", "-o", library, "-ldl"]
    subprocess.run(compile, input=REFUSE_THREADS, check=True, text=True)
    run_program(
        f"""
import ctypes
import microtrace as mt
scene = mt.load({str(KNOT)!r}).prepare()
shares = []
def draw(**options):
    return mt.render(scene, size=(160, 120), spp=16, threads=4, **options).color.tobytes()
expected = draw()
ctypes.c_int.in_dll(ctypes.CDLL({str(library)!r}), "refused").value = {refused}
assert draw(progress=shares.append) == expected
assert shares[-1] == 1
""",
        LD_PRELOAD=str(library),
    )


def run_program(program: str, **environment: str) -> None:
    """Runs a program that must end without an error or a message."""
    result = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        env=os.environ | environment,
        timeout=300,
    )
    assert (result.returncode, result.stderr) == (0, ""), result.stderr


def test_handlers_at_exit_get_whole_results():
    # The handler runs after the library's own, which was registered later.
    run_program(f"""
import atexit
@atexit.register
def check():
    assert (prepared.occluded(rays) == expected).all()
    hits = prepared.intersect(rays)
    assert (hits.hit == expected).all()
    assert mt.render(prepared, size=(320, 240), spp=4).color.mean() > 0
import microtrace as mt
import numpy as np
prepared = mt.load({str(KNOT)!r}).prepare()
rays = np.random.default_rng(0).normal(size=(500_000, 6)).astype(np.float32)
expected = prepared.occluded(rays)
filled = np.full(500_000, 255, np.uint8)  # memory that results might reuse
del filled
""")


@pytest.mark.parametrize(
    "call",
    [
        "prepared.intersect(rays[:1000])",
        "assert (prepared.occluded(rays) == expected).all()",
        "mt.render(prepared, size=(16, 12), spp=1, aovs=['depth'])",
        "mt.load(path)",
        "prepared.scene",
        "prepared.view().close()",
        "read_missing()",
    ],
)
def test_daemon_threads_end_silently(call):
    run_program(f"""
import threading, time
import microtrace as mt
import numpy as np
path = {str(KNOT)!r}
prepared = mt.load(path).prepare()
rays = np.random.default_rng(0).normal(size=(300_000, 6)).astype(np.float32)
expected = prepared.occluded(rays)
def read_missing():
    try:
        mt.load("missing.glb")
    except FileNotFoundError:
        pass
def work():
    while True:
        {call}
for _ in range(2):
    threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
""")


def looks_alike(a: mt.Picture, b: mt.Picture) -> bool:
    """Returns True if all but a few pixels at outlines show the same primitive at the same
    depth."""
    same = (a.primitive == b.primitive) & np.isclose(a.depth, b.depth, rtol=1e-5, equal_nan=True)
    return bool((a.primitive > 0).any()) and same.mean() > 0.99


def test_wrong_shutters():
    scene = mt.load(KNOT)

    def moment(time):
        return scene, mt.PerspectiveCamera(position=(0, 0, 9))

    for fields, words in [
        ({"times": 48}, "^times must be a power of two from 1 to 65536, not 48"),
        ({"open": 2}, "^open and close must be finite"),
        ({"close": np.inf}, "^open and close must be finite"),
        ({"open": np.nan}, "^open and close must be finite"),
    ]:
        shutter = mt.Shutter(**{"moment": moment, "open": 0, "close": 1, **fields})
        with pytest.raises(ValueError, match=words):
            mt.render(scene, size=SIZE, integrator="path", shutter=shutter)


def test_matrices_of_cameras():
    prepared = mt.load(KNOT).prepare()
    eye, (width, height) = np.array([4.0, 3, 10]), SIZE
    reference = mt.look_at(tuple(eye), (0, 0, 0), vertical_fov_degrees=40)
    f = height / 2 / np.tan(np.radians(20))
    back = eye / np.linalg.norm(eye)
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3] = np.column_stack([right, np.cross(back, right), back, eye])
    opengl = mt.cameras(
        [[f, 0, width / 2], [0, f, height / 2], [0, 0, 1]], pose, SIZE, convention="opengl"
    )
    k = [[f, 0, width / 2 - 0.5], [0, f, height / 2 - 0.5], [0, 0, 1]]
    camera_from_world = np.linalg.inv(pose @ np.diag([1.0, -1, -1, 1]))
    stack = np.stack([camera_from_world] * 2)
    opencv = mt.cameras(k, stack, SIZE, convention="opencv", distortion=np.zeros(5))
    names = ["depth", "primitive"]
    expected = mt.render(prepared, reference, SIZE, aovs=names)
    assert looks_alike(mt.render(prepared, opengl[0], SIZE, aovs=names), expected)
    pictures = mt.render(prepared, opencv, SIZE, aovs=names)
    assert pictures.depth.shape == (2, height, width)
    assert looks_alike(pictures.one(1), expected)
    # Twice the size shows the same view.
    twice = mt.render(prepared, opencv[0], (2 * width, 2 * height), aovs=names)
    assert abs((twice.primitive > 0).mean() - (expected.primitive > 0).mean()) < 0.01


@pytest.mark.parametrize("fisheye", [False, True])
def test_distortion_projects_back(fisheye):
    """Visible points land on their own pixels by OpenCV's formulas."""
    prepared = mt.load(KNOT).prepare()
    width, height = SIZE
    k = np.array([[60.0, 0, 31], [0, 58, 24], [0, 0, 1]])
    t = np.diag([1.0, -1, -1, 1])
    t[2, 3] = 9
    if fisheye:
        k1, k2, k3, k4 = numbers = (0.1, -0.05, 0.02, -0.01)
        (camera,) = mt.cameras(k, t, SIZE, convention="opencv", fisheye=numbers)
    else:
        k1, k2, p1, p2, k3 = numbers = (-0.2, 0.05, 0.01, -0.02, 0.01)
        (camera,) = mt.cameras(k, t, SIZE, convention="opencv", distortion=numbers)
    picture = mt.render(prepared, camera, SIZE, aovs=["position", "depth"])
    seen = np.isfinite(picture.depth)
    assert seen.sum() > 100
    x, y, z = (picture.position[seen].astype(np.float64) @ t[:3, :3].T + t[:3, 3]).T
    x, y = x / z, y / z
    r = np.sqrt(x * x + y * y)
    if fisheye:
        a = np.arctan(r)
        scale = a * (1 + k1 * a**2 + k2 * a**4 + k3 * a**6 + k4 * a**8) / r
        u, v = x * scale, y * scale
    else:
        radial = 1 + k1 * r**2 + k2 * r**4 + k3 * r**6
        u = x * radial + 2 * p1 * x * y + p2 * (r**2 + 2 * x * x)
        v = y * radial + p1 * (r**2 + 2 * y * y) + 2 * p2 * x * y
    rows, columns = np.nonzero(seen)
    assert np.allclose(u * k[0, 0] + k[0, 2], columns, atol=1e-3)
    assert np.allclose(v * k[1, 1] + k[1, 2], rows, atol=1e-3)


def test_wrong_matrices():
    k, t = np.eye(3), np.eye(4)
    skewed = k.copy()
    skewed[0, 1] = 1
    for arguments, text in [
        ((np.eye(4), t, SIZE), "K must have shape"),
        ((k, np.eye(3), SIZE), "T must have shape"),
        ((skewed, t, SIZE), "K must have the rows"),
        ((k, 2 * t, SIZE), "rotation"),
        ((k, np.diag([1.0, 1, -1, 1]), SIZE), "rotation"),
        ((np.stack([k] * 2), np.stack([t] * 3), SIZE), "same length"),
    ]:
        with pytest.raises(ValueError, match=text):
            mt.cameras(*arguments, convention="opencv")
    with pytest.raises(ValueError, match="coefficients"):
        mt.cameras(k, t, SIZE, convention="opencv", distortion=[1, 2, 3])
    with pytest.raises(ValueError, match="convention"):
        mt.cameras(k, t, SIZE, convention="blender")


def test_memory_is_reused_but_not_shared():
    prepared = mt.load(KNOT).prepare()
    camera = mt.frame(prepared)

    def render(size=(320, 200)):
        return mt.render(prepared, camera, size, aovs=["position", "object"])

    kept = render()
    expected = {name: array.copy() for name, array in kept.items()}
    row = render().position[7]  # keeps its array alive
    expected_row = row.copy()
    address = render().position.ctypes.data
    assert render().position.ctypes.data == address
    for k in range(1, 200):
        other = render((320, 200 + k))
        other.position[:] = np.nan
        other.object[:] = 7
    np.testing.assert_array_equal(row, expected_row)
    for name, array in kept.items():
        np.testing.assert_array_equal(array, expected[name])
        assert array.flags.writeable and array.flags.c_contiguous


def test_picture_too_large_for_memory():
    prepared = mt.load(KNOT).prepare()
    with pytest.raises(mt.LimitError, match="no memory for the arrays .* smaller or fewer"):
        mt.render(prepared, [mt.frame(prepared)] * 10**5, (65536, 65536), aovs=["depth"])
