#!/usr/bin/env python3
"""Renders views of a model with pyrender: rasterized color, depth and object ids as PNG files.

usage: pyrender_views.py MODEL FOLDER VIEWS WIDTH HEIGHT
"""

import sys
from pathlib import Path

import numpy as np
import pyrender
import trimesh
from PIL import Image

model, folder = sys.argv[1], Path(sys.argv[2])
views, width, height = map(int, sys.argv[3:6])

asset = trimesh.load(model, force="scene")
scene = pyrender.Scene.from_trimesh_scene(asset, ambient_light=[0.3] * 3)
low, high = asset.bounds
center, radius = (low + high) / 2, max(np.linalg.norm(high - low) / 2, 1e-6)
camera = scene.add(pyrender.PerspectiveCamera(yfov=0.6, znear=radius / 100, zfar=radius * 100))
light = scene.add(pyrender.DirectionalLight(intensity=3))
renderer = pyrender.OffscreenRenderer(width, height)
colors = {node: np.array([i & 255, i >> 8 & 255, i >> 16]) for i, node in enumerate(scene.mesh_nodes, 1)}
folder.mkdir(parents=True)
for view in range(views):
    pose = trimesh.transformations.euler_matrix(0.9 + 0.3 * view, 2.4 * view, 0)
    pose[:3, 3] = center + pose[:3, 2] * radius * 3.5
    scene.set_pose(camera, pose)
    scene.set_pose(light, pose)
    color, depth = renderer.render(scene)
    ids, _ = renderer.render(scene, flags=pyrender.RenderFlags.SEG, seg_node_map=colors)
    Image.fromarray(color).save(folder / f"{view:06d}_color.png")
    Image.fromarray((depth * (60000 / (radius * 6))).astype(np.uint16)).save(folder / f"{view:06d}_depth.png")
    Image.fromarray(ids).save(folder / f"{view:06d}_ids.png")
