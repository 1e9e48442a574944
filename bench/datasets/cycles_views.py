#!/usr/bin/env python3
"""Renders views of a model with Cycles: path-traced color, depth and object ids in one EXR file for each view.

usage: cycles_views.py MODEL FOLDER VIEWS WIDTH HEIGHT SAMPLES
"""

import sys
from pathlib import Path

import bpy
import mathutils

model, folder = sys.argv[1], Path(sys.argv[2])
views, width, height, samples = map(int, sys.argv[3:7])

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=model)
scene = bpy.context.scene
scene.world = bpy.data.worlds.new("world")
scene.world.use_nodes = True
meshes = [item for item in scene.objects if item.type == "MESH"]
for index, item in enumerate(meshes):
    item.pass_index = index + 1
corners = [item.matrix_world @ mathutils.Vector(corner) for item in meshes for corner in item.bound_box]
low = mathutils.Vector(map(min, zip(*corners)))
high = mathutils.Vector(map(max, zip(*corners)))
center, radius = (low + high) / 2, max((high - low).length / 2, 1e-6)

camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
camera.data.clip_start, camera.data.clip_end = radius / 100, radius * 100
scene.collection.objects.link(camera)
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.device = "CPU"
scene.cycles.samples = samples
scene.cycles.use_adaptive_sampling = False
scene.cycles.use_denoising = False
scene.render.threads_mode = "FIXED"
scene.render.threads = 1
scene.render.use_persistent_data = True
scene.render.resolution_x, scene.render.resolution_y = width, height
layer = scene.view_layers[0]
layer.use_pass_z = True
layer.use_pass_object_index = True
if hasattr(scene.render.image_settings, "media_type"):  # Blender 5
    scene.render.image_settings.media_type = "MULTI_LAYER_IMAGE"
scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
for view in range(views):
    direction = mathutils.Euler((0.9 + 0.3 * view, 0, 2.4 * view)).to_matrix() @ mathutils.Vector((0, 0, 1))
    camera.location = center + direction * radius * 3
    camera.rotation_euler = (-direction).to_track_quat("-Z", "Y").to_euler()
    scene.render.filepath = str(folder / f"{view:06d}.exr")
    bpy.ops.render.render(write_still=True)
assert len(list(folder.glob("*.exr"))) == views
