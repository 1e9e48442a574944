#!/usr/bin/env python3
"""Tests that outputs never replace inputs, and that nothing outside the scene's folder is read.

usage: files_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import json
import os
import shutil
import socket
import struct
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()


class Files(ProgramTest):
    def setUp(self):
        super().setUp()
        self.asset = self.folder / "asset"
        self.asset.mkdir()
        # A triangle with a texture. Besides the asset itself, it needs two files.
        (self.asset / "data.bin").write_bytes(
            struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<6f", 0, 0, 1, 0, 0, 1))
        result = self.run_program(SOURCE / "scenes/perspective1.json", "-q", "--size", "4x4", "-o", "asset/wood.png")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.gltf = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "textures": [{"source": 0}], "images": [{"uri": "wood.png"}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 0]},
                          {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
            "buffers": [{"byteLength": 60, "uri": "data.bin"}]}
        self.write_asset()

    def write_asset(self):
        (self.asset / "model.gltf").write_text(json.dumps(self.gltf))

    def contents(self):
        return {str(path.relative_to(self.folder)): path.read_bytes()
                for path in sorted(self.folder.rglob("*")) if path.is_file()}

    def draw(self, *arguments, **options):
        size = [] if arguments[0] == "merge" else ["--size", "8x8"]
        return self.run_program(*arguments, *size, **options)

    def assert_refused(self, code, *arguments, says, **options):
        """Checks that the program fails with this exit code and a message with all fragments, and changes no file."""
        before = self.contents()
        result = self.draw(*arguments, **options)
        message = result.stderr.decode()
        self.assertEqual(result.returncode, code, message)
        for part in says:
            self.assertIn(part, message)
        self.assertEqual(self.contents(), before)

    # Inputs are not overwritten

    def test_outputs_over_parts_of_the_asset(self):
        os.symlink("asset/data.bin", self.folder / "link.ppm")
        os.link(self.asset / "wood.png", self.folder / "hard.png")
        for output, names in [("asset/wood.png", ["asset/wood.png"]), ("asset/../asset/wood.png", ["asset/wood.png"]),
                              ("link.ppm", ["link.ppm", "asset/data.bin"]), ("hard.png", ["hard.png", "asset/wood.png"])]:
            for more in [(), ("--integrator", "flat"), ("--integrator", "depth")]:
                self.assert_refused(2, "asset/model.gltf", "-o", output, *more, says=["error: ", "--output", *names])
        self.assert_refused(2, "asset/model.gltf", "-o", "a.ppm", "--sidecar", "asset/model.gltf",
                            says=["--sidecar", "asset/model.gltf"])
        self.assert_refused(2, "asset/model.gltf", "-o", "a.ppm", "--spp", "1", "--checkpoint", "asset/data.bin",
                            says=["--checkpoint", "asset/data.bin"])

    def test_outputs_over_images_that_may_not_be_read(self):
        for uri in ["../outer.png", str(self.folder / "outer.png"), "../asset/../outer.png"]:
            (self.folder / "outer.png").write_bytes(b"an image")
            self.gltf["images"][0]["uri"] = uri
            self.write_asset()
            self.assert_refused(2, "asset/model.gltf", "-o", "outer.png", says=["--output", "outer.png"])

    def test_outputs_over_a_buffer_that_is_not_read(self):
        (self.asset / "fallback.ppm").write_bytes(b"data")
        buffers = list(self.gltf["buffers"])
        for extension in ("EXT_meshopt_compression", "KHR_meshopt_compression"):
            self.gltf["buffers"] = [*buffers, {"byteLength": 4, "uri": "fallback.ppm",
                                               "extensions": {extension: {"fallback": True}}}]
            self.gltf["extensionsUsed"] = [extension]
            self.write_asset()
            self.assert_refused(2, "asset/model.gltf", "-o", "asset/fallback.ppm", says=["asset/fallback.ppm", "--output"])

    def test_the_default_picture_over_a_texture(self):
        shutil.move(self.asset / "wood.png", self.asset / "model.png")
        self.gltf["images"][0]["uri"] = "model.png"
        self.write_asset()
        self.assert_refused(2, "model.gltf", says=["model.png", "--output"], cwd=self.asset)

    def test_standard_streams(self):
        with open(self.asset / "model.gltf") as scene:
            self.assert_refused(2, "-", "-o", "model.gltf.ppm", "--sidecar", "model.gltf", says=["model.gltf", "--sidecar"],
                                cwd=self.asset, stdin=scene)

    def test_outputs_over_files_of_a_json_scene(self):
        scene = {"version": 1, "image": {"width": 8, "height": 8}, "objects": [{"type": "mesh", "file": "asset/model.gltf"}],
                 "cameras": [{"type": "perspective", "position": [0, 0, 5], "direction": [0, 0, -1], "vertical_fov": 40}]}
        (self.folder / "scene.json").write_text(json.dumps(scene))
        for path in ["scene.json", "asset/model.gltf", "asset/data.bin"]:
            self.assert_refused(2, "scene.json", "-o", "a.ppm", "--sidecar", path, says=[path, "--sidecar"])

    def test_outputs_that_cannot_be_written_are_refused_before_rendering(self):
        with socket.socket(socket.AF_UNIX) as listener:
            listener.bind(str(self.folder / "socket"))
        long = [SOURCE / "scenes/perspective1.json", "--size", "8000x8000", "--spp", "65536", "--integrator", "path", "-o"]
        with open("/dev/null") as unwritable:
            for name, options in [("socket", {}), ("-", {"stdout": unwritable}), ("-", {"preexec_fn": lambda: os.close(1)})]:
                result = subprocess.run([PROGRAM, *map(str, long), name], cwd=self.folder, stderr=subprocess.PIPE, env=environment(),
                                        timeout=60, **options)
                self.assertEqual(result.returncode, 5, result.stderr)
                self.assertIn(b"can't be written", result.stderr)

    def test_replaced_files_keep_their_access_rights(self):
        scene, picture = SOURCE / "scenes/perspective1.json", self.folder / "a.ppm"
        self.assertEqual(self.run_program(scene, "-o", picture).returncode, 0)
        picture.chmod(0o604)
        if os.getuid() == 0:
            os.chown(picture, 1234, 2345)
        # Version 2; entries are tag, permissions and id: the owner, user 3456, the group, the mask and others.
        entries = [(1, 6, -1), (2, 6, 3456), (4, 0, -1), (16, 6, -1), (32, 4, -1)]
        try:
            os.setxattr(picture, "system.posix_acl_access", struct.pack("<I", 2) + b"".join(struct.pack("<HHi", *entry) for entry in entries))
        except OSError:  # the file system has no such lists
            pass

        def rights():
            status = picture.stat()
            lists = {name: os.getxattr(picture, name) for name in os.listxattr(picture)}
            return status.st_mode, status.st_uid, status.st_gid, lists

        before, first = rights(), picture.stat().st_ino
        self.assertEqual(self.run_program(scene, "-o", picture).returncode, 0)
        self.assertNotEqual(picture.stat().st_ino, first)
        self.assertEqual(rights(), before)

    def test_access_rights_that_cannot_be_kept(self):
        """Nobody gets access to a replaced file who had none."""
        if os.getuid() != 0:
            self.skipTest("needs root")
        scene, picture = self.folder / "scene.json", self.folder / "a.ppm"
        shutil.copy(SOURCE / "scenes/perspective1.json", scene)
        self.folder.chmod(0o777)
        user = {"user": 4001, "group": 6001, "extra_groups": []}

        def run(*arguments):
            try:
                return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True, env=environment(), **user)
            except PermissionError:
                self.skipTest("other users can't run the program")

        run("--version")
        for before, after in [(0o640, 0o600), (0o604, 0o600), (0o606, 0o600), (0o666, 0o666), (0o664, 0o644), (0o660, 0o600)]:
            picture.write_bytes(b"")
            os.chown(picture, 4001, 5001)  # of a group to which the user doesn't belong
            picture.chmod(before)
            result = run(scene, "-o", picture)
            self.assertEqual(result.returncode, 0, result.stderr)
            status = picture.stat()
            self.assertEqual((status.st_uid, status.st_gid, oct(status.st_mode & 0o777)), (4001, 6001, oct(after)))

    def test_frames(self):
        shutil.move(self.asset / "wood.png", self.asset / "wood3.png")
        self.gltf["images"][0]["uri"] = "wood3.png"
        self.write_asset()
        arguments = ["asset/model.gltf", "--spp", "1", "-o"]
        self.assert_refused(2, *arguments, "asset/wood%d.png", "--frames", "0:4", says=["asset/wood3.png", "--output"])
        self.assert_refused(2, *arguments, "a%d.ppm", "--sidecar", "./a%d.ppm", "--frames", "0:4", says=["a0.ppm"])
        self.assert_refused(2, *arguments, "a%d1.ppm", "--sidecar", "a1%d.ppm", "--frames", "1:11", says=["a11.ppm"])
        result = self.draw(*arguments, "asset/wood%d.png", "--frames", "0:2")
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_checkpoints(self):
        draw = ["asset/model.gltf", "--spp", "2", "-o", "a.ppm"]
        self.assertEqual(self.draw(*draw, "--checkpoint", "ck").returncode, 0)
        os.symlink("ck", self.folder / "link.ppm")
        os.remove(self.folder / "a.ppm")
        for path in ["ck", "./ck"]:
            self.assert_refused(2, *draw, "--checkpoint", "ck", "--sidecar", path, says=["ck", "--sidecar"])
            self.assert_refused(2, *draw, "--resume", path, "--sidecar", "ck", says=["ck", "--sidecar"])
        draw[-1] = "link.ppm"
        self.assert_refused(2, *draw, "--checkpoint", "ck", says=["--output", "--checkpoint"])
        self.assert_refused(2, *draw, "--resume", "ck", says=["link.ppm", "--output"])
        self.assert_refused(2, "merge", "ck", "-o", "link.ppm", says=["link.ppm", "ck"])
        # --checkpoint may name the resumed checkpoint.
        draw[-1] = "a.ppm"
        self.assertEqual(self.draw(*draw, "--resume", "ck", "--checkpoint", "ck").returncode, 0)

    def test_two_outputs_with_one_file(self):
        os.symlink("b.ppm", self.folder / "link.ppm")  # a link whose target doesn't exist yet
        draw = ["asset/model.gltf", "--spp", "1", "-o", "b.ppm"]
        for path in ["b.ppm", "./b.ppm", "asset/../b.ppm", "link.ppm"]:
            self.assert_refused(2, *draw, "--sidecar", path, says=["--output", "--sidecar"])
            self.assert_refused(2, *draw, "--checkpoint", path, says=["--output", "--checkpoint"])
        self.assert_refused(2, *draw, "--checkpoint", "c", "--sidecar", "./c", says=["--sidecar", "--checkpoint"])
        os.symlink("f_0001.ppm", self.folder / "f_0000.ppm")
        draw[-1] = "f_%04d.ppm"
        self.assert_refused(2, *draw, "--frames", "0:1", says=["f_0001.ppm", "--output"])

    # Files outside the scene's folder are not read

    def test_links_out_of_the_folder(self):
        outside = self.folder / "outside"
        outside.mkdir()
        for part in ["data.bin", "wood.png"]:
            shutil.move(self.asset / part, outside / part)
            os.symlink(outside / part, self.asset / part)
            self.assert_refused(3, "asset/model.gltf", "-o", "a.ppm", says=[part, str(outside.resolve() / part), "--allow-path"])
            result = self.draw("asset/model.gltf", "--spp", "1", "-o", "a.ppm", "--allow-path", "outside")
            self.assertEqual(result.returncode, 0, result.stderr)
            os.remove(self.folder / "a.ppm")
            os.remove(self.asset / part)
            shutil.move(outside / part, self.asset / part)
        # Tests a file behind a link to a folder. The asset is loaded directly, and as a part of a JSON scene.
        os.symlink("../outside", self.asset / "more")
        shutil.move(self.asset / "data.bin", outside / "data.bin")
        self.gltf["buffers"][0]["uri"] = "more/data.bin"
        self.write_asset()
        self.assert_refused(3, "asset/model.gltf", "-o", "a.ppm", says=["more/data.bin", "--allow-path"])
        scene = {"version": 1, "image": {"width": 8, "height": 8}, "objects": [{"type": "mesh", "file": "mesh.glb"}],
                 "cameras": [{"type": "perspective", "position": [0, 0, 5], "direction": [0, 0, -1], "vertical_fov": 40}]}
        shutil.copy(SOURCE / "scenes/gltf/cube.glb", outside / "cube.glb")
        os.symlink("../outside/cube.glb", self.asset / "mesh.glb")
        (self.asset / "scene.json").write_text(json.dumps(scene))
        self.assert_refused(3, "asset/scene.json", "-o", "a.ppm", says=["/objects/0/file", "mesh.glb", "--allow-path"])
        result = self.draw("asset/scene.json", "-o", "a.ppm", "--allow-path", "outside")
        self.assertEqual(result.returncode, 0, result.stderr)
        scene["environment"] = {"type": "map", "file": "sky.hdr"}
        scene["objects"] = [{"type": "sphere", "center": [0, 0, 0], "radius": 1}]
        (outside / "sky.hdr").write_bytes(b"#?RADIANCE\n")
        os.symlink("../outside/sky.hdr", self.asset / "sky.hdr")
        (self.asset / "scene.json").write_text(json.dumps(scene))
        os.remove(self.folder / "a.ppm")
        self.assert_refused(3, "asset/scene.json", "-o", "a.ppm", says=["/environment/file", "sky.hdr", "--allow-path"])

    def test_links_within_the_folder(self):
        (self.asset / "sub").mkdir()
        shutil.move(self.asset / "wood.png", self.asset / "sub/oak.png")
        os.symlink("sub/oak.png", self.asset / "wood.png")
        os.symlink("asset", self.folder / "other")
        for scene in ["asset/model.gltf", "other/model.gltf"]:
            result = self.draw(scene, "--spp", "1", "-o", "a.ppm")
            self.assertEqual(result.returncode, 0, result.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
