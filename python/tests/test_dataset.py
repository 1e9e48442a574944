"""Tests data sets of the program against readers made by others."""

from __future__ import annotations

import json
import subprocess
import sys

import microtrace as mt
import numpy as np
import pytest
from conftest import REPOSITORY, SCENES
from microtrace import _core
from PIL import Image
from pycocotools import mask as coco_mask
from pycocotools.coco import COCO

sys.path.append(str(REPOSITORY / "tests" / "cli"))
from exr import Exr  # noqa: E402  (the reader of the program's own tests)

MATERIALS = SCENES / "gltf" / "materials.glb"


def dataset(program, folder, *options, scene=MATERIALS):
    subprocess.run(
        [program, "dataset", scene, "-o", folder, "--integrator", "flat", "--quiet", *options],
        check=True,
        timeout=300,
    )


@pytest.mark.parametrize("scene", ["gltf/materials.glb", "perspective1.json", "gltf/moving.glb"])
@pytest.mark.parametrize("size", ["61x47", "1x1", "8x200"])
def test_pycocotools_reads_masks(program, tmp_path, scene, size):
    scene = SCENES / scene
    dataset(
        program,
        tmp_path / "set",
        "--views",
        "random:3",
        "--size",
        size,
        "--formats",
        "exr,coco",
        "--aov",
        "id",
        scene=scene,
    )
    coco = COCO(tmp_path / "set" / "coco.json")
    width, height = map(int, size.split("x"))
    assert coco.getImgIds() == [0, 1, 2]
    annotations = 0
    for view in range(3):
        image = coco.loadImgs(view)[0]
        assert (image["width"], image["height"]) == (width, height)
        assert image["file_name"] == f"{view:06d}.exr"
        picture = Exr(tmp_path / "set" / image["file_name"])
        ids = np.array(picture.channels["id.instance"])
        covered = np.zeros((height, width), bool)
        objects = []
        for annotation in coco.loadAnns(coco.getAnnIds(imgIds=view)):
            annotations += 1
            objects.append(annotation["object"])
            mask = coco.annToMask(annotation).astype(bool)
            assert np.array_equal(mask, ids == annotation["object"] + 1)
            covered |= mask
            run_lengths = annotation["segmentation"]
            assert coco_mask.area(run_lengths) == annotation["area"] == mask.sum()
            assert list(coco_mask.toBbox(run_lengths)) == annotation["bbox"]
            encoded = coco_mask.encode(np.asfortranarray(mask.astype(np.uint8)))
            assert encoded["counts"].decode() == run_lengths["counts"]
            assert annotation["category_id"] in coco.cats
        assert np.array_equal(covered, ids != 0)
        assert objects == sorted(set(objects))
    assert annotations > 0
    assert sorted(coco.anns) == list(range(1, annotations + 1))


def test_amodal_masks_contain_visible_ones(program, tmp_path):
    dataset(
        program,
        tmp_path / "set",
        "--views",
        "orbit:3",
        "--size",
        "48x36",
        "--formats",
        "coco",
        "--amodal",
    )
    coco = COCO(tmp_path / "set" / "coco.json")
    hidden = 0
    for annotation in coco.anns.values():
        visible, amodal = (
            coco_mask.decode(annotation[name]).astype(bool)
            for name in ("segmentation", "amodal_segmentation")
        )
        assert not np.any(visible & ~amodal)
        assert annotation["amodal_area"] == amodal.sum()
        assert annotation["occlude_rate"] == pytest.approx(1 - visible.sum() / amodal.sum())
        hidden += int(amodal.sum() - visible.sum())
    assert hidden > 0


def test_npz_has_the_numbers_of_exr(program, tmp_path):
    folder = tmp_path / "set"
    dataset(
        program,
        folder,
        "--views",
        "orbit:2",
        "--size",
        "31x22",
        "--formats",
        "exr,npz",
        "--aov",
        "depth,normal,id",
        "--background",
        "transparent",
    )
    for view in range(2):
        picture = Exr(folder / f"{view:06d}.exr")
        arrays = np.load(folder / f"{view:06d}.npz")
        names = {
            "color": ["R", "G", "B", "A"],
            "depth": ["depth.Z"],
            "normal": ["normal.X", "normal.Y", "normal.Z"],
            "id": ["id.instance", "id.primitive", "id.material"],
        }
        assert set(arrays) == set(names)
        for name, channels in names.items():
            expected = np.stack([np.array(picture.channels[c]) for c in channels], -1)
            dtype = np.uint32 if name == "id" else np.float32
            expected = expected.astype(dtype).reshape(arrays[name].shape)
            assert arrays[name].dtype == dtype
            assert np.array_equal(arrays[name], expected), name


def test_bop_has_the_ids_and_depths_of_exr(program, tmp_path):
    folder = tmp_path / "set"
    dataset(
        program,
        folder,
        "--views",
        "orbit:2",
        "--size",
        "47x33",
        "--formats",
        "exr,bop",
        "--aov",
        "depth,id",
        "--depth-scale",
        "0.5",
    )
    scene = folder / "bop" / "train" / "000000"
    info = json.loads((scene / "scene_gt_info.json").read_text())
    poses = json.loads((scene / "scene_gt.json").read_text())
    cameras = json.loads((scene / "scene_camera.json").read_text())
    for view in range(2):
        picture = Exr(folder / f"{view:06d}.exr")
        ids = np.array(picture.channels["id.instance"])
        depth = np.array(picture.channels["depth.Z"])
        assert cameras[str(view)]["depth_scale"] == 0.5
        stored = np.array(Image.open(scene / "depth" / f"{view:06d}.png"))
        seen = (ids != 0) & (depth * 2000 < 65535)
        assert np.all(np.abs(stored[seen] - depth[seen] * 2000) <= 0.5001)
        assert Image.open(scene / "rgb" / f"{view:06d}.png").size == (47, 33)
        for i, (pose, counts) in enumerate(zip(poses[str(view)], info[str(view)], strict=True)):
            visible, whole = (
                np.array(Image.open(scene / name / f"{view:06d}_{i:06d}.png")) == 255
                for name in ("mask_visib", "mask")
            )
            assert np.array_equal(visible, ids == pose["obj_id"])
            assert not np.any(visible & ~whole)
            assert counts["px_count_visib"] == visible.sum()
            assert counts["px_count_all"] == whole.sum()
            assert (folder / "bop" / "models" / f"obj_{pose['obj_id']:06d}.ply").exists()


def test_categories(program, tmp_path):
    sidecar = tmp_path / "one.json"
    subprocess.run(
        [
            program,
            MATERIALS,
            "-o",
            tmp_path / "one.png",
            "--sidecar",
            sidecar,
            "--quiet",
            "--integrator",
            "flat",
        ],
        check=True,
    )
    described = json.loads(sidecar.read_text())
    for kind in ("objects", "materials"):
        dataset(
            program, tmp_path / kind, "--size", "32x24", "--formats", "coco", "--categories", kind
        )
        coco = COCO(tmp_path / kind / "coco.json")
        for annotation in coco.anns.values():
            item = described["objects"][annotation["object"]]
            name = coco.cats[annotation["category_id"]]["name"]
            if kind == "objects":
                assert name == item["name"]
            else:
                assert name == described["materials"][item["material"] - 1]["name"]


def test_a_view_that_fails_does_not_break_the_next_one(tmp_path):
    """Workers of distributed data sets go on with the same object."""
    views = tmp_path / "views.json"
    damaged = tmp_path / "damaged.exr"
    damaged.write_bytes(b"damaged")
    views.write_text(json.dumps({"views": [{}, {"environment": {"light": str(damaged)}}]}))
    words = [
        str(SCENES / "gltf" / "knot.glb"),
        f"--views={views}",
        "--spp=1",
        "--size=8x6",
        "--output=.",
    ]
    renderer = _core.Dataset(words, "", "", 1)
    renderer.create(str(tmp_path / "set"))
    first = renderer.render(str(tmp_path / "set"), 0)
    with pytest.raises(mt.FileError):
        renderer.render(str(tmp_path / "set"), 1)
    assert renderer.render(str(tmp_path / "set"), 0) == first
