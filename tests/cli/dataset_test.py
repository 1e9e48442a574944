#!/usr/bin/env python3
"""Data sets: microtrace dataset and microtrace verify.

usage: dataset_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import json
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest
from pathlib import Path

from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
SCENE = SOURCE / "scenes/perspective1.json"
SMALL = ["--size", "24x16"]


class Dataset(ProgramTest):
    def dataset(self, *arguments, code=0, scene=SCENE, output="out"):
        result = self.run_program("dataset", scene, "-o", output, *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr.decode()

    def verify(self, *arguments, code=0):
        result = self.run_program("verify", "out", *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        return result.stderr.decode()

    def contents(self, folder="out"):
        root = self.folder / folder
        return {str(path.relative_to(root)): path.read_bytes() for path in root.rglob("*")
                if path.is_file() and not path.name.startswith(".microtrace-")}

    def views(self, *views, defaults=None):
        text = {"views": list(views), **({"defaults": defaults} if defaults else {})}
        (self.folder / "views.json").write_text(json.dumps(text))
        return ["--views", "views.json"]

    def test_views_are_the_pictures_of_the_program(self):
        self.dataset("--views", "orbit:3,40", *SMALL, "--formats", "png,exr", "--aov", "depth,id")
        for view, azimuth in enumerate((0, 120, 240)):
            for extension, options in ((".png", []), (".exr", ["--aov", "depth,id"])):
                name = f"alone{extension}"
                result = self.run_program(SCENE, *SMALL, "--view", f"{azimuth},40", *options, "-o", name)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual((self.folder / name).read_bytes(), self.contents()[f"{view:06d}{extension}"])

    def test_warnings_about_views_are_printed_once(self):
        message = self.dataset("--views", "orbit:5", *SMALL, "--formats", "bop", "--depth-scale", "0.001")
        self.assertEqual(len(re.findall(r"view \d stores \d+ depths beyond 65535 steps as 0", message)), 1, message)
        self.assertIn("beyond 65535 steps",
                      self.dataset("--views", "orbit:5", *SMALL, "--formats", "bop", "--depth-scale", "0.001", "--strict",
                                   code=3, output="strict"))

    def test_depths_below_half_a_step_are_reported(self):
        message = self.dataset(*SMALL, "--formats", "bop", "--depth-scale", "50000")
        self.assertRegex(message, r"view 0 stores \d+ depths below half a step as 0")

    def test_calibrated_cameras_of_views_have_the_size_of_their_images(self):
        camera = {"type": "calibrated", "position": [0, 0, 6], "direction": [0, 0, -1],
                  "image": {"width": 50, "height": 30}, "fx": 45, "fy": 90, "cx": 20, "cy": 18}
        self.dataset(*self.views({"camera": camera}), "--formats", "png,bop")
        size = struct.unpack(">II", self.contents()["000000.png"][16:24])
        self.assertEqual(size, (50, 30))
        k = json.loads(self.contents()["bop/train/000000/scene_camera.json"])["0"]["cam_K"]
        self.assertEqual((k[0], k[4]), (45, 90))

    def test_listed_views(self):
        camera = {"type": "perspective", "position": [0, 1, 8], "direction": [0, 0, -1], "vertical_fov": 30}
        self.dataset(*self.views({"name": "front", "camera": camera},
                                 {"name": "side", "camera": {"azimuth": 90, "elevation": 10}, "size": {"width": 8, "height": 9}},
                                 {"name": "own", "camera": "0"},
                                 defaults={"size": {"width": 12, "height": 10}}), "--name", "{scene}/{name}_{view}")
        files = self.contents()
        self.assertEqual({name for name in files if name.endswith(".png")},
                         {"perspective1/front_0.png", "perspective1/side_1.png", "perspective1/own_2.png"})
        for name, options in (("side_1", ["--size", "8x9", "--view", "90,10"]),
                              ("own_2", ["--size", "12x10", "--camera", "0"]),
                              ("front_0", ["--size", "12x10", "--eye", "0,1,8", "--target", "0,1,0", "--fov", "30"])):
            self.assertEqual(self.run_program(SCENE, *options, "-o", "alone.png").returncode, 0)
            self.assertEqual((self.folder / "alone.png").read_bytes(), files[f"perspective1/{name}.png"], name)

    def test_light_and_time_of_views(self):
        scene = SOURCE / "scenes/gltf/knot.glb"
        path = ["--integrator", "path", "--spp", "2", *SMALL]
        self.dataset(*self.views({"environment": {"light": "#ff0000"}}, {}, {"environment": {"intensity": 0.5}},
                                 {"environment": {"light": "#ff0000", "rotation": 30, "intensity": 2}}), *path, scene=scene)
        for view, options in enumerate((["--env", "#ff0000"], [], ["--env-intensity", "0.5"],
                                        ["--env", "#ff0000", "--env-rotation", "30", "--env-intensity", "2"])):
            self.assertEqual(self.run_program(scene, *path, *options, "-o", "alone.png").returncode, 0)
            self.assertEqual((self.folder / "alone.png").read_bytes(), self.contents()[f"{view:06d}.png"], view)

    def test_frames_are_views(self):
        scene = SOURCE / "scenes/gltf/moving.glb"
        options = [*SMALL, "--integrator", "flat"]
        self.dataset("--frames", "3:5", "--fps", "4", *options, "--views", "orbit:2", scene=scene)
        pictures = [content for name, content in sorted(self.contents().items()) if name.endswith(".png")]
        self.assertEqual(len(pictures), 6)
        self.assertGreater(len(set(pictures)), 2)
        for view, picture in enumerate(pictures):
            self.run_program(scene, *options, "--time", str((3 + view // 2) / 4), "--view", f"{180 * (view % 2)},25", "-o", "alone.png")
            self.assertEqual((self.folder / "alone.png").read_bytes(), picture, view)

    def test_one_camera_frames_the_poses_of_all_frames(self):
        scene = SOURCE / "scenes/gltf/moving.glb"
        options = ["--view", "30,20", "--frames", "0:2", "--fps", "4", *SMALL, "--integrator", "flat"]
        self.dataset(*options, scene=scene)
        self.run_program(scene, *options, "-o", "frame%06d.png")
        for frame in range(3):
            name = f"{frame:06d}.png"
            self.assertEqual((self.folder / f"frame{name}").read_bytes(), self.contents()[name], frame)

    def test_bop_needs_objects_that_do_not_move(self):
        scene = SOURCE / "scenes/gltf/moving.glb"
        options = [*SMALL, "--integrator", "flat", "--formats", "bop", "--views", "orbit:2"]
        for shard in ([], ["--shard", "1/2"]):
            message = self.dataset("--frames", "0:2", "--fps", "2", *options, *shard, scene=scene, code=2, output="moving")
            self.assertIn("objects that move", message)
            self.assertFalse((self.folder / "moving").exists())
        self.dataset("--time", "0.5", *options, scene=scene, output="still")

    def test_shards_give_the_bytes_of_one_run(self):
        options = ["--views", "hemisphere:7", *SMALL]
        self.dataset(*options)
        text = self.dataset(*options, "--shard", "3/3", output="parts")
        self.assertIn("4 views of other shards are not rendered yet", text)
        self.assertNotIn("manifest.json", self.contents("parts"))
        self.dataset(*options, "--shard", "1/3", "-t", "1", output="parts")
        self.dataset(*options, "--shard", "2/3", "-t", "3", output="parts")
        self.assertEqual(self.contents("parts"), self.contents())

    def test_annotations_are_the_same_in_shards(self):
        options = ["--views", "random:4", *SMALL, "--formats", "png,npz,coco,bop", "--amodal"]
        self.dataset(*options)
        coco = json.loads((self.folder / "out/coco.json").read_text())
        self.assertEqual([image["file_name"] for image in coco["images"]], [f"{view:06d}.png" for view in range(4)])
        self.assertGreater(len(coco["annotations"]), 4)
        for name in ("coco.json", "bop/train/000000/scene_gt.json", "000002.npz"):
            self.assertIn(name, (self.folder / "out/manifest.json").read_text())
        for shard in ("2/2", "1/2"):
            self.dataset(*options, "--shard", shard, output="parts")
        self.assertEqual(self.contents("parts"), self.contents())
        self.verify("--redraw", "4")

    def test_whole_views_are_kept(self):
        options = ["--views", "random:5", *SMALL]
        self.dataset(*options)
        whole = self.contents()
        (self.folder / "out/000001.png").unlink()
        (self.folder / "out/000002.png").write_bytes(b"x" * len(whole["000002.png"]))
        (self.folder / "out/records/000003.json").unlink()
        self.assertIn("rendered 3 views", self.dataset(*options))
        self.assertEqual(self.contents(), whole)
        self.assertIn("rendered 0 views", self.dataset(*options))

    def test_kills_lose_nothing(self):
        """MICROTRACE_KILLS is the number of kills (12)."""
        options = ["--views", "random:30", "--size", "64x48", "--formats", "png,npz,coco,bop", "--amodal", "--quiet"]
        start = time.monotonic()
        self.dataset(*options)
        seconds = time.monotonic() - start
        whole = self.contents()
        wanted = int(os.environ.get("MICROTRACE_KILLS", "12"))
        kills = 0
        randomness = random.Random(7)
        for _ in range(10 * wanted):
            process = subprocess.Popen([PROGRAM, "dataset", SCENE, "-o", "killed", *options], cwd=self.folder, env=environment())
            time.sleep(randomness.uniform(0, seconds / 2))
            process.send_signal(signal.SIGKILL)
            status = process.wait()
            kills += status == -signal.SIGKILL
            if kills == wanted:
                break
            if status == 0:
                self.assertEqual(self.contents("killed"), whole)
                shutil.rmtree(self.folder / "killed")
            elif (self.folder / "killed").exists():
                for name, content in self.contents("killed").items():
                    self.assertEqual(content, whole[name], name)
        self.assertEqual(kills, wanted)
        self.dataset(*options, output="killed")
        self.assertEqual(self.contents("killed"), whole)

    def test_verification(self):
        self.dataset("--views", "orbit:4", *SMALL)
        self.assertIn("4 views, 5 files, all whole; 2 views rendered again: the same", self.verify("--redraw", "2"))
        file = self.folder / "out/000002.png"
        content = file.read_bytes()
        file.write_bytes(content[:-1] + b"x")
        self.assertIn("000002.png: is missing or was changed", self.verify(code=5))
        file.write_bytes(content)
        (self.folder / "out/records/000003.json").unlink()
        self.assertIn("lacks 1 of 4 views", self.verify(code=5))

    def test_records_that_a_power_failure_left_empty_are_replaced(self):
        self.dataset("--views", "orbit:3", *SMALL)
        whole = self.contents()
        for damage in (b"", bytes(200), b'{"view": 1, "fil'):
            (self.folder / "out/records/000001.json").write_bytes(damage)
            self.assertIn("lacks 1 of 3 views", self.verify(code=5))
            self.dataset("--views", "orbit:3", *SMALL)
            self.assertEqual(self.contents(), whole)
        # The shard of the record may have ended long ago.
        (self.folder / "out/records/000001.json").write_bytes(b"")
        (self.folder / "out/000002.png").unlink()
        self.assertIn("rendered 2 views", self.dataset("--views", "orbit:3", *SMALL, "--shard", "3/3"))
        self.assertEqual(self.contents(), whole)

    def test_exchanged_records_are_replaced(self):
        self.dataset("--views", "orbit:3", *SMALL)
        whole = self.contents()
        first, second = (self.folder / f"out/records/00000{view}.json" for view in (1, 2))
        content = first.read_bytes()
        first.write_bytes(second.read_bytes())
        second.write_bytes(content)
        self.assertIn("lacks 2 of 3 views", self.verify(code=5))
        self.dataset("--views", "orbit:3", *SMALL)
        self.assertEqual(self.contents(), whole)

    def test_pipes_instead_of_files(self):
        self.dataset("--views", "orbit:2", *SMALL)
        for name in ("records/000001.json", "manifest.json", "dataset.json"):
            file = self.folder / "out" / name
            content = file.read_bytes()
            file.unlink()
            os.mkfifo(file)
            self.assertIn(f"{name}: is not a regular file", self.verify(code=5))
            file.unlink()
            file.write_bytes(content)
        self.verify()

    def test_verification_reads_the_common_files(self):
        self.dataset("--views", "orbit:2", "--formats", "png,coco,bop", *SMALL)
        for name in ("coco.json", "manifest.json", "bop/train/000000/scene_gt.json", "bop/models/models_info.json"):
            file = self.folder / "out" / name
            content = file.read_bytes()
            file.unlink()
            self.assertIn(f"{name}: is missing", self.verify(code=5))
            if name != "manifest.json":
                file.write_bytes(content + b" ")
                self.assertIn(f"{name}: is missing or was changed", self.verify(code=5))
            file.write_bytes(content)
        manifest = self.folder / "out/manifest.json"
        content = manifest.read_bytes()
        for damage in (b"[\n]\n", content.replace(b'"size": ', b'"size": 1', 1)):
            manifest.write_bytes(damage)
            self.assertIn("differs from the records", self.verify(code=5))
        for cut in (content.removesuffix(b"]\n"), content[:content.index(b'{"name": "coco.json"')]):
            manifest.write_bytes(cut)
            self.assertIn("manifest.json: is cut off", self.verify(code=5))
        manifest.write_bytes(content)
        self.verify()

    def test_the_last_shard_mends_files_of_others(self):
        options = ["--views", "orbit:4", *SMALL, "--formats", "png,coco,bop"]
        self.dataset(*options)
        whole = self.contents()

        def without_end(content):
            return content[:-1]

        def changed(content):
            return content.replace(b'"', b"x", 1)

        damages = {"000002.png": without_end, "annotations/000002.coco.txt": changed, "annotations/000002.bop.txt": changed,
                   "bop/train/000000/depth/000002.png": without_end}
        for name, damage in damages.items():
            file = self.folder / "out" / name
            file.write_bytes(damage(file.read_bytes()))
            (self.folder / "out/000000.png").unlink()
            self.assertIn("rendered 2 views", self.dataset(*options, "--shard", "1/2"))
            self.assertEqual(self.contents(), whole)

    def test_one_of_two_data_sets_gets_a_new_folder(self):
        for _ in range(10):
            processes = [subprocess.Popen([PROGRAM, "dataset", SCENE, "-o", self.folder / "new", "--views", "orbit:2",
                                           *SMALL, "--seed", str(seed), "-q"], stderr=subprocess.DEVNULL)
                         for seed in (1, 2)]
            self.assertEqual(sorted(process.wait() for process in processes), [0, 2])
            shutil.rmtree(self.folder / "new")

    def test_shards_start_a_folder_together(self):
        options = ["--views", "random:24", "--size", "4x4", "-t", "1", "-q"]
        for _ in range(5):
            processes = [subprocess.Popen([PROGRAM, "dataset", SOURCE / "scenes/triangle.json", "-o", self.folder / "new", *options,
                                           "--shard", f"{i}/24"], stderr=subprocess.PIPE) for i in range(1, 25)]
            self.assertEqual([process.communicate()[1] for process in processes], 24 * [b""])
            self.assertTrue((self.folder / "new/manifest.json").exists())
            shutil.rmtree(self.folder / "new")

    def test_finished_data_sets_of_other_users_are_left_alone(self):
        options = ["--views", "orbit:2", *SMALL, "--formats", "png,coco,bop"]
        self.dataset(*options)
        names = ("coco.json", "manifest.json", "bop/train/000000/scene_gt.json")
        before = [(self.folder / "out" / name).stat() for name in names]
        for shard in ("1/2", "2/2"):
            self.assertIn("rendered 0 views", self.dataset(*options, "--shard", shard))
        self.assertEqual([(self.folder / "out" / name).stat()[1:] for name in names], [status[1:] for status in before])
        whole = self.contents()
        for name in names:  # a damaged one is written again
            (self.folder / "out" / name).write_bytes(b"x")
            self.assertIn("rendered 0 views", self.dataset(*options, "--shard", "1/2"))
            self.assertEqual(self.contents(), whole)

    def test_names_that_are_not_utf_8_are_refused(self):
        scene = self.folder / os.fsdecode(b"\xff.json")
        shutil.copy(SCENE, scene)
        self.assertIn("not UTF-8", self.dataset("--views", "orbit:2", *SMALL, scene=scene, code=2))

    def test_names_of_other_files_are_refused(self):
        for name in ("bop/train/000000/depth/{view:06d}", "./records/{view}", "annotations/{view}"):
            self.assertIn("is for other files", self.dataset("--views", "orbit:2", *SMALL, "--name", name, code=2))

    def test_generated_views_count_toward_the_memory_limit(self):
        self.assertIn("the views of the data set",
                      self.dataset("--views", "random:1000000", "--memory-limit", "100M", code=6))

    def test_pictures_without_a_decoder_are_another_data_set(self):
        (self.folder / "bare").mkdir()
        bare = shutil.copy(PROGRAM, self.folder / "bare/microtrace")
        scene = SOURCE / "scenes/gltf/textured.glb"
        options = ["--views", "orbit:2", *SMALL, "--spp", "1", "--formats", "npz"]
        subprocess.run([bare, "dataset", scene, "-o", "out", *options, "--shard", "1/2", "-q"], cwd=self.folder, check=True,
                       stderr=subprocess.DEVNULL)
        self.assertIn("other decoders", self.dataset(*options, scene=scene, code=2))

    def test_names_of_scenes_may_look_like_options(self):
        shutil.copy(SCENE, self.folder / "-x.json")
        self.dataset("--views", "orbit:2", *SMALL, "--", scene="./-x.json")
        result = self.run_program("dataset", "-o", "other", "--views", "orbit:2", *SMALL, "--", "-x.json")
        self.assertEqual(result.returncode, 0, result.stderr)
        shutil.rmtree(self.folder / "out")
        (self.folder / "other").rename(self.folder / "out")
        self.verify("--redraw", "2")

    def test_verification_notices_another_scene(self):
        shutil.copy(SCENE, self.folder / "scene.json")
        self.dataset("--views", "orbit:2", *SMALL, scene="scene.json")
        text = SCENE.read_text()
        (self.folder / "scene.json").write_text(text.replace('"red": [1', '"red": [0.5', 1))
        self.assertIn("differs from the view", self.verify(code=5))

    def test_other_data_sets_are_refused(self):
        options = ["--views", "orbit:2", *SMALL]
        self.dataset(*options)
        whole = self.contents()
        self.dataset(*options, "--formats", "png", "--seed=0")  # the defaults
        for others, reason in ((["--views", "orbit:3", *SMALL], "other options, --views=orbit:2 instead of --views=orbit:3"),
                               ([*options, "--background", "#ff0000"], "other options, the default instead of --background=#ff0000"),
                               ([*options, "--formats", "exr"], "other options, the default instead of --formats=exr"),
                               (["--views", "orbit:2"], "other options, --size=24x16 instead of the default")):
            self.assertIn(reason, self.dataset(*others, code=2))
        link = self.folder / "out/000001.png"
        link.unlink()
        link.symlink_to(SCENE)
        self.assertIn("is a link", self.dataset(*options, code=2))
        link.unlink()
        self.dataset(*options)
        (self.folder / "linked").mkdir()
        (self.folder / "linked/letter.png").symlink_to(SCENE)
        (self.folder / "linked/again").symlink_to(self.folder / "out")
        subfolder = self.folder / "out/subfolder"
        subfolder.symlink_to(self.folder / "linked")
        self.assertIn("letter.png: is a link", self.dataset(*options, code=2))
        subfolder.unlink()
        copy = self.folder / SCENE.name
        copy.write_text(SCENE.read_text() + "\n")
        self.assertIn("another content", self.dataset(*options, scene=copy, code=2))
        self.assertEqual(self.contents(), whole)
        (self.folder / "mine").mkdir()
        (self.folder / "mine/letter.txt").write_text("mine")
        self.assertIn("not a data set", self.dataset(*options, output="mine", code=2))

    def test_names_that_differ_in_case_need_a_folder_that_tells_them_apart(self):
        views = [{"name": name, "camera": {"azimuth": 90 * i, "elevation": 0}} for i, name in enumerate(("Front", "front", "back"))]
        (self.folder / "views.json").write_text(json.dumps({"views": views}))
        options = ["--views", self.folder / "views.json", "--name", "{name}", *SMALL]
        self.dataset(*options)
        (self.folder / "out/DATASET.JSON").hardlink_to(self.folder / "out/dataset.json")  # as if case were ignored
        self.assertIn("ignores the case of letters, so views share the file name front", self.dataset(*options, code=2))

    def test_options_that_leave_the_files_alone_may_differ(self):
        self.dataset("--views", "orbit:2", *SMALL)
        whole = self.contents()
        self.dataset("--views", "orbit:2", *SMALL, "--instances", "copy", "--allow-path", ".", "-t", "1")
        self.assertEqual(self.contents(), whole)

    def test_options_without_effect_are_refused(self):
        lens = ["--aperture", "0.5", "--focus", "3"]
        for options, message in ((["--views", "orbit:2", "--camera", "nonsense"], "all have one"),
                                 (["--views", "orbit:2", "--eye", "1,2,3"], "all have one"),
                                 (["--target", "1,2,3"], "--target requires --eye"),
                                 (["--fov", "100"], "--fov requires"),
                                 ([*self.views({"camera": "0"}), *lens], "--aperture and --focus are for views"),
                                 (["--aov", "depth,id", "--formats", "png,coco,bop"], "--aov is for the formats"),
                                 (["--aov", "albedo"], "--aov is for the formats"),
                                 (["--animation", "0"], "--animation requires")):
            self.assertIn(message, self.dataset(*options, scene=SOURCE / "scenes/gltf/moving.glb", code=2))
        sized = self.views({"size": {"width": 8, "height": 6}})
        self.assertIn("--size is for views", self.dataset(*sized, *SMALL, code=2))
        moving = ["--animation", "0", *self.views({"time": 0.5})]
        self.dataset(*moving, *SMALL, scene=SOURCE / "scenes/gltf/moving.glb", output="moving")
        framed = [*SMALL, "--integrator", "path", "--spp", "2", "--formats", "exr"]
        self.dataset("--views", "orbit:1", *lens, *framed, output="lens")
        alone = self.run_program(SCENE, *framed[:-2], "--view", "0,25", *lens, "-o", "alone.exr")
        self.assertEqual(alone.returncode, 0, alone.stderr)
        self.assertEqual((self.folder / "alone.exr").read_bytes(), self.contents("lens")["000000.exr"])

    def test_cameras_are_checked_before_the_folder_is_made(self):
        for options, message in ((["--focus", "2"], "has no lens"),
                                 (["--views", "orbit:2", "--focus", "2"], "has no lens"),
                                 (["--views", "orbit:2", "--aperture", "1e39", "--focus", "2"], "--aperture"),
                                 (["--eye", "1,2,3", "--target", "1,2,3"], "equals the target"),
                                 (["--eye", "0,5,0", "--target", "0,0,0"], "must not be parallel")):
            self.assertIn(message, self.dataset(*options, *SMALL, "--integrator", "path", output="refused", code=2))
            self.assertFalse((self.folder / "refused").exists(), options)

    def test_files_of_other_folders_are_read_again(self):
        mesh = {"type": "mesh", "file": "link.glb"}
        scene = {"version": 1, "objects": [mesh]}
        (self.folder / "asset").mkdir()
        (self.folder / "asset/scene.json").write_text(json.dumps(scene))
        (self.folder / "asset/link.glb").symlink_to(SOURCE / "scenes/gltf/cube.glb")
        allowed = ["--views", "orbit:2", *SMALL, "--allow-path", SOURCE / "scenes"]
        self.dataset(*allowed, scene="asset/scene.json")
        self.assertIn("2 views rendered again: the same", self.verify("--redraw", "2"))

    def test_coco_names_pictures_that_exist(self):
        for formats, name in (("exr,png,npz", "000001.png"), ("exr,npz", "000001.exr"), ("npz,bop", "000001.npz"),
                              ("bop", "bop/train/000000/rgb/000001.png"), ("", None)):
            output = "out" + formats
            self.dataset("--views", "orbit:2", "--formats", formats + ",coco" if formats else "coco", *SMALL, output=output)
            image = json.loads((self.folder / output / "coco.json").read_text())["images"][1]
            self.assertEqual((image["id"], image.get("file_name")), (1, name))
            self.assertTrue(name is None or (self.folder / output / name).exists())

    def test_one_view_is_counted_in_the_singular(self):
        self.assertIn("out: rendered 1 view in ", text := self.dataset("--views", "orbit:2", *SMALL, "--shard", "2/2"))
        self.assertIn("; 1 view of other shards is not rendered yet\n", text)
        self.dataset(*SMALL, output="out1")
        self.assertTrue(self.run_program("verify", "out1", "--redraw", "0").stderr.startswith(b"out1: 1 view, 2 files, all whole; 0 views rendered"))

    def test_damaged_and_missing_lists(self):
        options = ["--views", "orbit:2", *SMALL]
        self.dataset(*options)
        folder = self.folder / "out"
        for name, command in (("manifest.json", self.verify), ("dataset.json", self.verify), ("dataset.json", lambda code: self.dataset(*options, code=code))):
            text = (folder / name).read_text()
            for damaged in ("", text[:-20], text.replace("{", "[", 1), "[" * 300):
                (folder / name).write_text(damaged)
                message = command(code=5)
                self.assertIn(name, message)
                self.assertNotIn("the same", message)
            (folder / name).write_text(text)
        self.verify()
        (folder / "dataset.json").unlink()
        self.assertEqual(self.verify(code=5), f"error: {folder}: is not a data set: it has no dataset.json\n")

    def test_signals_leave_no_temporary_folder(self):
        self.dataset("--views", "orbit:3", "--size", "120x80", "--integrator", "path", "--spp", "64", "--formats", "png,bop")
        temporary = self.folder / "temporary"
        temporary.mkdir()
        for end in (signal.SIGTERM, signal.SIGHUP):
            process = subprocess.Popen([PROGRAM, "verify", "out", "--redraw", "3"], cwd=self.folder, stderr=subprocess.PIPE,
                                       env=environment(TMPDIR=str(temporary)))
            while process.poll() is None and not any(path.is_file() for path in temporary.rglob("*")):
                time.sleep(0.01)
            process.send_signal(end)
            process.communicate()
            self.assertEqual(process.returncode, 128 + end)
            self.assertEqual(os.listdir(temporary), [])

    def test_wrong_views(self):
        for view, message in (({"camera": {"type": "fish"}}, "fish"), ({"time": -1}, "/views/0/time"),
                              ({"name": "../x"}, "/views/0/name"), ({"sizes": 1}, "sizes"),
                              ({"camera": {"azimuth": 0, "elevation": 91}}, "/views/0/camera/elevation"),
                              ({"environment": {"intensity": -1}}, "/views/0/environment/intensity")):
            self.assertIn(message, self.dataset(*self.views(view), code=3))
        self.assertIn("at least one view", self.dataset(*self.views(), code=3))
        # A wrong camera is refused before the first view, so the folder takes the corrected list.
        self.assertIn('--views: view 1: there is no camera "nobody"',
                      self.dataset(*self.views({}, {"camera": "nobody"}), code=2, output="corrected"))
        # So are wrong variants and environments.
        self.assertIn('--views: view 2: there is no variant "red"; the scene has none',
                      self.dataset(*self.views({}, {}, {"variant": "red"}), code=2, output="corrected"))
        self.assertIn("--views: view 1: no.hdr can't be opened",
                      self.dataset(*self.views({}, {"environment": {"light": "no.hdr"}}), code=5, output="corrected"))
        self.dataset(*self.views({}, {"camera": "0"}), output="corrected")
        # So are cameras that BOP can't describe, and those of --camera.
        fisheye = {"camera": {"type": "environment", "position": [0, 0, 0], "direction": [0, 0, -1]}}
        self.assertIn("--views: view 2: BOP describes cameras by a matrix K",
                      self.dataset(*self.views({}, {"camera": "0"}, fisheye), "--formats", "bop", code=2, output="new"))
        scene = self.folder / "environment.json"
        scene.write_text(json.dumps({"version": 1, "cameras": [{"name": "all", **fisheye["camera"]}],
                                     "objects": [{"type": "sphere", "center": [0, 0, -4], "radius": 1}]}))
        for options in ((), self.views({}), self.views({"camera": "all"})):
            self.assertIn("--views: view 0: BOP describes", self.dataset(*options, "--formats", "bop", scene=scene, code=2, output="new"))
        self.assertIn("--camera: there is no camera", self.dataset("--camera", "nobody", code=2, output="new"))
        self.assertFalse((self.folder / "new").exists())
        for option, format in ((["--amodal"], "coco"), (["--categories", "materials"], "coco"), (["--depth-scale", "1"], "bop")):
            self.assertIn(f"{option[0]} is for the format {format}", self.dataset(*option, "--formats", "png,npz", code=2, output="new"))
        for generator in ("orbit:0", "orbit:3,91", "hemisphere:2.5", "random:3,4", "orbit:"):
            self.assertIn("--views: expects", self.dataset("--views", generator, code=2))
        for pattern in ("fixed", "{x}", "../{view}", "/{view}", "{view"):
            self.assertIn("file name pattern", self.dataset("--views", "orbit:2", "--name", pattern, code=2))
        self.assertIn("share the file name", self.dataset(*self.views({"name": "a"}, {"name": "a"}), "--name", "{name}", code=2))
        self.dataset("--views", "nowhere.json", code=5)
        self.assertIn("--output", self.dataset("--views", "orbit:1", code=2, output="-"))

    def test_the_current_folder_may_have_been_removed(self):
        command = f"mkdir gone && cd gone && rmdir ../gone && {PROGRAM} dataset {SCENE} -o {self.folder}/out --views orbit:1 --size 8x6"
        subprocess.run(["sh", "-c", command], cwd=self.folder, check=True, stderr=subprocess.PIPE)
        self.assertIn("000000.png", self.contents())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
