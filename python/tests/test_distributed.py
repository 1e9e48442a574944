"""Tests microtrace.distributed with real schedulers, workers and an object server."""

from __future__ import annotations

import inspect
import json
import re
import subprocess
import sys
import tracemalloc
from functools import partial

import chaos
import microtrace as mt
import microtrace.distributed as md
import numpy as np
import pytest
from chaos import FORMATS, OPTIONS, SCENE
from cluster import Cluster
from conftest import SCENES
from microtrace.distributed.pictures import parts_of, tiles_of

pytestmark = pytest.mark.filterwarnings("ignore::microtrace.SceneWarning")


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    with Cluster(tmp_path_factory.mktemp("cluster")) as cluster:
        cluster.worker("a")
        cluster.worker("b")
        with cluster.client() as client:
            client.wait_for_workers(2, timeout=60)
            yield client


def test_documented_arguments_are_missing():
    text = (SCENES.parent / "docs" / "distributed.md").read_text()
    exceptions = re.search(
        r"arguments of `microtrace.render`(?: except `(\w+)` and `(\w+)`)?", text
    )
    assert exceptions is not None
    local, remote = (set(inspect.signature(each).parameters) for each in (mt.render, md.render))
    assert local - remote == set(exceptions.groups()) and remote - local == {"client", "retries"}


@pytest.mark.parametrize("size", [(1, 1), (8, 8), (17, 23), (64, 9)])
def test_ranges_of_tiles_cover_pictures(size):
    count = 3 * tiles_of(*size)
    for first in range(0, count, max(1, count // 9)):
        for last in range(first + 1, count + 1, max(1, count // 7)):
            seen = np.zeros((3, size[1], size[0]), int)
            for begin, end in ((0, first), (first, last), (last, count)):
                for picture, (x0, y0, x1, y1) in parts_of(begin, end, *size):
                    seen[picture, y0:y1, x0:x1] += 1
            assert (seen == 1).all()


def test_the_client_warns_about_a_missing_ground(client):
    scene = mt.Scene()
    scene.add_plane((0, 0, -5), (0, 0, 1))
    camera = mt.look_at((0, 0, 0), (0, 0, -1))
    with pytest.warns(mt.SceneWarning, match="no lowest point") as caught:
        md.render(client, scene, camera, (24, 16), spp=1, ground=True)
    assert [w.filename for w in caught] == [__file__]


@pytest.mark.parametrize(
    "scene, arguments",
    [
        ("gltf/materials.glb", {"size": (83, 47), "spp": 4, "aovs": ["color", "id", "variance"]}),
        ("gltf/materials.glb", {"size": (83, 47), "aovs": ["depth", "uv"]}),
        ("gltf/materials.glb", {"size": (83, 47), "spp": 1, "exposure": 3, "bsdf": "spec"}),
        ("gltf/materials.glb", {"size": (83, 47), "spp": 1, "exposure": "auto"}),
        ("gltf/materials.glb", {"size": (83, 47), "spp": 1, "ground": True, "transparent": True}),
        ("perspective1.json", {}),
    ],
)
def test_pictures_equal_those_of_one_process(client, scene, arguments):
    if "id" in arguments.get("aovs", ()):
        arguments = {**arguments, "aovs": ["color", "object", "variance"], "transparent": True}
    loaded = mt.load(SCENES / scene)
    shares = []
    far = md.render(client, loaded, progress=shares.append, **arguments)
    near = mt.render(loaded, **arguments)
    assert list(far) == list(near)
    for name in near:
        assert far[name].dtype == near[name].dtype
        assert far[name].shape == near[name].shape
        assert far[name].tobytes() == near[name].tobytes(), name
    if "color" in near:
        assert np.array_equal(far.tonemap(), near.tonemap())
    assert shares == sorted(shares) and shares[-1] == 1


def test_several_cameras_make_a_stack(client):
    scene = mt.load(SCENES / "perspective1.json").prepare()
    cameras = [mt.frame(scene, azimuth) for azimuth in (0, 90)]
    far = md.render(client, scene, cameras, (40, 30))
    near = mt.render(scene, cameras, (40, 30))
    assert far.color.tobytes() == near.color.tobytes()
    assert far.color.shape == (2, 30, 40, 3)


def test_a_part_of_a_picture_equals_the_whole():
    scene = mt.load(SCENES / "perspective1.json").prepare()
    whole = mt.render(scene, size=(40, 30), aovs=["color", "depth"])
    part = mt.render(scene, size=(40, 30), aovs=["color", "depth"], crop=(3, 5, 20, 30))
    depth = mt.render(scene, size=(40, 30), aovs=["depth"], crop=(3, 5, 20, 30))
    assert np.array_equal(part.color, whole.color[5:30, 3:20])
    assert np.array_equal(part.depth, whole.depth[5:30, 3:20])
    assert np.array_equal(depth.depth, whole.depth[5:30, 3:20])
    for crop in [(0, 0, 41, 30), (5, 0, 5, 30), (-1, 0, 5, 5), (0, 0, 5)]:
        with pytest.raises(ValueError, match="crop"):
            mt.render(scene, size=(40, 30), crop=crop)


def test_the_program_accepts_the_data_set(client, program, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    expected = chaos.single_run(program, tmp_path / "one", 3)
    arguments = {"views": "random:3", "formats": FORMATS, "options": OPTIONS}
    assert md.dataset(client, SCENE, "many", **arguments) == md.Summary(3, 3, 0)
    assert chaos.files_of(tmp_path / "many") == expected
    (tmp_path / "many" / "000001.exr").write_bytes(b"damaged")
    assert md.dataset(client, SCENE, "many", **arguments) == md.Summary(3, 1, 2)
    assert chaos.files_of(tmp_path / "many") == expected
    subprocess.run([program, "verify", "many", "--quiet"], check=True)
    with pytest.raises(mt.UsageError, match="another number of views|other options"):
        md.dataset(client, SCENE, "many", **{**arguments, "views": "random:2"})


def test_files_of_the_scene_and_environments_reach_the_workers(
    client, program, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "views.json").write_text(
        '{"views": [{"environment": {"light": "sky.exr"}}, {"environment": {"light": "studio"}}]}'
    )
    mt.render(mt.load(SCENES / "perspective1.json"), size=(16, 8)).save("sky.exr")
    (tmp_path / "scene.glb").write_bytes(SCENE.read_bytes())
    options = ["--size=16x12", "--spp=1", "--env", "sky.exr"]
    words = ["scene.glb", "-o", "one", "--views", "views.json", "--formats", "png", *options]
    subprocess.run([program, "dataset", *words, "--quiet"], check=True)
    md.dataset(client, "scene.glb", "many", views="views.json", options=options)
    assert chaos.files_of(tmp_path / "many") == chaos.files_of(tmp_path / "one")


def test_errors_name_the_files_of_the_client(client, tmp_path):
    scene = SCENES / "gltf" / "moving.glb"
    options = ["--frames=0:1", "--size=16x12", "--spp=1"]
    with pytest.raises(mt.UsageError) as caught:
        md.dataset(client, scene, tmp_path / "set", formats=["bop"], options=options)
    diagnostic = caught.value.diagnostic
    assert diagnostic.file == str(scene)
    assert str(caught.value) == diagnostic.text and diagnostic.text.startswith(f"{scene}: ")


def test_wrong_arguments(client, tmp_path):
    scene = SCENES / "perspective1.json"
    with pytest.raises(ValueError, match="--shard"):
        md.dataset(client, scene, tmp_path, options=["--shard=1/2"])
    with pytest.raises(mt.UsageError, match="--bogus"):
        md.dataset(client, scene, tmp_path, options=["--bogus"])
    with pytest.raises(FileNotFoundError):
        md.dataset(client, "missing.glb", tmp_path / "set")
    for name, value in [
        ("scene", None),
        ("scene", "\udcff"),
        ("url", 3),
        ("views", np.eye(4)),
        ("formats", "png"),
        ("formats", 3),
        ("options", "--spp 1"),
        ("options", None),
        ("options", ["--spp", 1]),
        ("storage_options", 3),
        ("retries", "many"),
        ("progress", 3),
    ]:
        arguments = {"scene": scene, "url": tmp_path / "set", "options": ["--size=8x8"]}
        with pytest.raises((TypeError, ValueError), match=f"^(a word of )?{name} must"):
            md.dataset(client, **{**arguments, name: value})
    with pytest.raises(TypeError, match="retries must be an integer"):
        md.render(client, mt.load(scene), retries="many")
    with pytest.raises(TypeError, match="Client"):
        md.render(None, mt.load(scene))
    with pytest.raises(ValueError, match="spp"):
        md.render(client, mt.load(scene), spp=0)
    with pytest.raises(mt.CanceledError):
        md.render(client, mt.load(scene), size=(64, 64), progress=lambda share: False)


def test_workers_may_die_stop_and_have_full_disks(program, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    expected = chaos.single_run(program, tmp_path / "one", 6)
    server, _, options = chaos.object_server()
    try:
        chaos.fsspec.filesystem("s3", **options).mkdir("chaos")
        chaos.chaos_round(tmp_path, 1, 6, expected, "s3://chaos/set", options)
    finally:
        server.stop()


def test_views_of_a_task_that_fails_are_not_counted_as_kept(tmp_path, monkeypatch):
    # Each of two tasks has two small files and then a large one, which one of the workers can't
    # write.
    monkeypatch.setattr(md.datasets, "RangeRun", partial(md.datasets.RangeRun, start=3))
    camera = {"azimuth": 0, "elevation": 0}
    views = [{"camera": {**camera, "vertical_fov": f}} for f in (1e-3, 1e-3, 45)] * 2
    (tmp_path / "views.json").write_text(json.dumps({"views": views}))
    arguments = {"views": tmp_path / "views.json", "formats": ["png"]}
    arguments["options"] = ["--size=256x192", "--integrator=normal"]
    with Cluster(tmp_path) as cluster:
        cluster.worker("full", file_limit=11000)
        cluster.worker("other")
        with cluster.client() as client:
            client.wait_for_workers(2, timeout=60)
            scene, folder = SCENES / "perspective1.json", tmp_path / "set"
            assert md.dataset(client, scene, folder, **arguments) == md.Summary(6, 6, 0)
            assert (folder / "000000.png").stat().st_size < 11000
            assert (folder / "000005.png").stat().st_size > 11000
            assert md.dataset(client, scene, folder, **arguments) == md.Summary(6, 0, 6)


def test_workers_without_modules_are_refused(tmp_path, monkeypatch):
    with Cluster(tmp_path) as cluster:
        with monkeypatch.context() as own:
            own.setenv("MICROTRACE_MODULE_PATH", str(tmp_path))
            cluster.worker("poor")
        with cluster.client() as client:
            client.wait_for_workers(1, timeout=60)
            arguments = {"views": "orbit:4", "formats": ["npz"], "options": ["--size=16x12"]}
            scene = SCENES / "gltf" / "textured.glb"
            with pytest.raises(ValueError, match="tcp://.* decodes the scene's files differently"):
                md.dataset(client, scene, tmp_path / "set", **arguments)


def test_folders_with_deep_files_are_not_empty():
    files = chaos.fsspec.filesystem("memory")
    store = md.datasets.Store("memory://deep", {})
    assert store.is_empty()
    files.pipe_file("/deep/a/b/c/letter.txt", b"mine")
    try:
        assert not store.is_empty()
        assert not store.create("a/b/c/letter.txt", b"new")
        assert store.read("a/b/c/letter.txt") == b"mine"
        assert store.create("dataset.json", b"new") and store.read("dataset.json") == b"new"
    finally:
        files.rm("/deep", recursive=True)


def test_runs_that_replace_each_others_data_set_fail(tmp_path):
    words = [str(SCENES / "perspective1.json"), "--output=.", "--views=orbit:2"]
    own, other = (
        md.datasets._core.read_dataset([*words, f"--size={size}"])[0] for size in ("8x6", "6x8")
    )
    other.create(tmp_path)
    files = chaos.fsspec.filesystem("memory")
    files.pipe_file("/shared/dataset.json", (tmp_path / "dataset.json").read_bytes())
    try:
        with pytest.raises(
            ValueError, match="memory://shared: contains a data set of other options"
        ):
            md.datasets._finish(own, md.datasets.Store("memory://shared", {}), b"own")
    finally:
        files.rm("/shared", recursive=True)


def test_records_of_other_files_and_views_are_ignored(tmp_path):
    (tmp_path / "records").mkdir()
    for name in ("000001", "0000002", "000004", "000005", "1000000", "view", "00003"):
        (tmp_path / "records" / f"{name}.json").write_text("{}")
    (tmp_path / "records" / "000003.json.part").write_text("{}")
    store = md.datasets.Store(str(tmp_path), {})
    assert md.datasets.recorded_views(store, 5) == {1, 4}
    assert md.datasets.recorded_views(store, 2_000_000) == {1, 4, 5, 1_000_000}
    tracemalloc.start()
    try:
        md.datasets.recorded_views(store, 2_000_000)
        assert tracemalloc.get_traced_memory()[1] < 1_000_000  # not in proportion to the views
    finally:
        tracemalloc.stop()


def test_dask_is_optional():
    code = "import sys, microtrace; assert not {'dask', 'distributed', 'fsspec'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
    code = "import sys; sys.modules['distributed'] = None; import microtrace.distributed"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "pip install '.[distributed]'" in result.stderr
