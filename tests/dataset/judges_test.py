#!/usr/bin/env python3
"""Lets pycocotools, NumPy and loaders of BOP read a data set, and compares it with ids and depths.

usage: judges_test.py WRITE_DATA_SET

bop_toolkit is in no package registry. load_scene() and load_ply() follow the documented format, as its
loaders do: the same members, keys that are numbers, shapes of matrices, and types in PLY files.
"""

import io
import json
import contextlib
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from pycocotools import mask as coco_mask
from pycocotools.coco import COCO

VIEWS, OBJECTS = 5, 12


def load_scene(folder):
    def load(name):
        values = json.loads((folder / name).read_text())
        assert list(values) == [str(view) for view in range(VIEWS)]
        return {int(key): value for key, value in values.items()}

    cameras, poses = load("scene_camera.json"), load("scene_gt.json")
    for camera in cameras.values():
        for key, shape in ("cam_K", (3, 3)), ("cam_R_w2c", (3, 3)), ("cam_t_w2c", (3, 1)):
            camera[key] = np.array(camera[key], float).reshape(shape)
    for objects in poses.values():
        for pose in objects:
            pose["cam_R_m2c"] = np.array(pose["cam_R_m2c"], float).reshape(3, 3)
            pose["cam_t_m2c"] = np.array(pose["cam_t_m2c"], float).reshape(3, 1)
    return cameras, poses, load("scene_gt_info.json")


def load_ply(path):
    header, _, data = path.read_bytes().partition(b"end_header\n")
    lines = header.decode().splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    points = next(int(line.split()[-1]) for line in lines if line.startswith("element vertex"))
    faces = next(int(line.split()[-1]) for line in lines if line.startswith("element face"))
    vertices = np.frombuffer(data, "<f4", 3 * points).reshape(-1, 3)
    triangles = np.frombuffer(data, [("n", "u1"), ("i", "<i4", 3)], offset=12 * points)
    assert len(triangles) == faces and (triangles["n"] == 3).all()
    return vertices.astype(float), triangles["i"]


def box_of(mask):
    ys, xs = mask.nonzero()
    return [xs.min(), ys.min(), xs.max() - xs.min() + 1, ys.max() - ys.min() + 1]


def judge_coco(path, truth):
    with contextlib.redirect_stdout(io.StringIO()):
        coco = COCO(path)
    assert sorted(coco.getImgIds()) == list(range(VIEWS))
    names = {c["id"]: c["name"] for c in coco.loadCats(coco.getCatIds())}
    assert set(names.values()) == {"even", *(f'odd "{k}"' for k in range(1, OBJECTS, 2))}
    assert sorted(coco.anns) == list(range(1, len(coco.anns) + 1))
    hidden = 0
    for view, data in enumerate(truth):
        annotations = coco.loadAnns(coco.getAnnIds(imgIds=[view]))
        assert {a["object"] for a in annotations} == set(np.unique(data["objects"])) - {0xFFFFFFFF}
        for a in annotations:
            assert names[a["category_id"]] == a["object_name"]
            visible, whole = data["objects"] == a["object"], data["amodal ä"][a["object"]]
            assert (coco.annToMask(a) == visible).all()
            encoded = coco_mask.encode(np.asfortranarray(visible.astype(np.uint8)))
            assert a["segmentation"]["counts"] == encoded["counts"].decode()
            assert a["area"] == coco_mask.area(encoded) == visible.sum()
            assert a["bbox"] == coco_mask.toBbox(encoded).tolist() == box_of(visible)
            assert (coco_mask.decode(a["amodal_segmentation"]) == whole).all()
            assert a["amodal_area"] == whole.sum() and a["amodal_bbox"] == box_of(whole)
            assert a["occlude_rate"] == 1 - a["area"] / a["amodal_area"] or abs(
                a["occlude_rate"] - (1 - a["area"] / a["amodal_area"])
            ) < 1e-15
            hidden += a["occlude_rate"] > 0
    assert hidden > 5


def judge_bop(folder, truth):
    scene = folder / "train/000000"
    cameras, poses, infos = load_scene(scene)
    models = {k: load_ply(folder / f"models/obj_{k:06d}.ply") for k in range(1, OBJECTS + 1)}
    for key, info in json.loads((folder / "models/models_info.json").read_text()).items():
        points = models[int(key)][0]
        assert [info[f"min_{axis}"] for axis in "xyz"] == points.min(axis=0).tolist()
        assert [info[f"size_{axis}"] for axis in "xyz"] == np.ptp(points, axis=0).tolist()
        pairs = np.linalg.norm(points[:, None] - points[None], axis=2)
        assert abs(info["diameter"] - pairs.max()) < 1e-9 * pairs.max()
    checked = 0
    for view, data in enumerate(truth):
        depth = np.array(Image.open(scene / f"depth/{view:06d}.png"))
        assert depth.dtype == np.uint16
        assert (depth == np.where(np.isinf(data["depth"]), 0, np.round(data["depth"].astype(float) * 4000))).all()
        camera = cameras[view]
        assert len(poses[view]) == len(infos[view]) == sum(m.any() for m in data["amodal ä"])
        for gt, (pose, info) in enumerate(zip(poses[view], infos[view])):
            masks = [np.array(Image.open(scene / f"{kind}/{view:06d}_{gt:06d}.png")) for kind in ("mask", "mask_visib")]
            for mask in masks:
                assert mask.dtype == np.uint8 and set(np.unique(mask)) <= {0, 255}
            whole, visible = (mask == 255 for mask in masks)
            assert (whole == data["amodal ä"][pose["obj_id"] - 1]).all()
            assert (visible == (data["objects"] == pose["obj_id"] - 1)).all()
            assert info["px_count_all"] == whole.sum() and info["px_count_visib"] == visible.sum()
            assert info["px_count_valid"] == (depth[whole] > 0).sum()
            assert info["visib_fract"] == visible.sum() / whole.sum()
            for key, mask in ("bbox_obj", whole), ("bbox_visib", visible):
                x, y, width, height = box_of(mask) if visible.any() else (-1, -1, 0, 0)
                assert info[key] == [x, y, width - 1, height - 1], info
            # Pixels, moved back to the model by K, R, t and the depth, lie on its plane.
            r, t = pose["cam_R_m2c"], pose["cam_t_m2c"]
            assert np.allclose(r @ r.T, np.eye(3)) and np.isclose(np.linalg.det(r), 1)
            assert (r == camera["cam_R_w2c"]).all()
            ys, xs = visible.nonzero()
            pixels = np.stack([xs, ys, np.ones(len(xs))]).astype(float)
            z = depth[ys, xs] * camera["depth_scale"]
            points = (r.T @ (np.linalg.inv(camera["cam_K"]) @ pixels * z - t)).T
            corners, triangles = models[pose["obj_id"]]
            a, b, c = corners[triangles[0]]
            normal = np.cross(b - a, c - a)
            normal /= np.linalg.norm(normal)
            assert (np.abs((points - a) @ normal) < 0.2).all()  # mm; half a step is 0.125
            assert (points > corners.min(axis=0) - 0.5).all() and (points < corners.max(axis=0) + 0.5).all()
            checked += len(points)
    assert checked > 1000


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([sys.argv[1], folder], check=True)
        truth = [dict(np.load(folder / f"{view}.npz")) for view in range(VIEWS)]
        for data in truth:
            assert {k: v.dtype.str for k, v in data.items()} == {
                "objects": "<u4",
                "depth": "<f4",
                "amodal ä": "|u1",
                "nothing": "<f4",
                "number": "<f4",
            }
            assert data["nothing"].shape == (0, 3) and data["number"] == data["depth"][0, 0]
        judge_coco(folder / "coco.json", truth)
        judge_bop(folder / "bop", truth)
        before = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}
        subprocess.run([sys.argv[1], folder], check=True)
        assert before == {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}


main()
