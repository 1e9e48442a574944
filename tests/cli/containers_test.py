#!/usr/bin/env python3
"""Tests the program in surroundings like those of containers: outputs that are mount points, namespaces, file systems that
refuse to execute files, limits, and system calls that the runtime refuses. Tests that need rights which this process lacks are
skipped.

usage: containers_test.py PROGRAM SOURCE_FOLDER MODULE_FOLDER [unittest arguments]
"""

import ctypes
import os
import resource
import shutil
import subprocess
import sys
import time
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from program import PROGRAM, ProgramTest, environment

SOURCE, MODULES = (Path(argument).resolve() for argument in sys.argv[2:4])
CUBE = SOURCE / "scenes/gltf/cube.glb"
SMALL = ["--size", "32x24", "--spp", "2", "-q"]
CAN_MOUNT = subprocess.run(["unshare", "-m", "true"], capture_output=True).returncode == 0


def refuse_call(number, error):
    """Makes a system call of x86-64 fail in this process and its children (seccomp)."""
    class Instruction(ctypes.Structure):
        _fields_ = [("code", ctypes.c_ushort), ("jt", ctypes.c_ubyte), ("jf", ctypes.c_ubyte), ("k", ctypes.c_uint)]

    class Program(ctypes.Structure):
        _fields_ = [("count", ctypes.c_ushort), ("instructions", ctypes.POINTER(Instruction))]

    # Loads the number, compares it, and returns SECCOMP_RET_ALLOW or SECCOMP_RET_ERRNO.
    code = (Instruction * 4)((0x20, 0, 0, 0), (0x15, 0, 1, number), (0x06, 0, 0, 0x50000 | error), (0x06, 0, 0, 0x7FFF0000))
    library = ctypes.CDLL(None, use_errno=True)
    program = Program(4, code)
    if library.prctl(38, 1, 0, 0, 0) != 0 or library.prctl(22, 2, ctypes.byref(program)) != 0:
        raise OSError(ctypes.get_errno(), "seccomp")


class Containers(ProgramTest):
    def shell(self, script, *arguments):
        """Runs a script in a mount namespace of its own."""
        return subprocess.run(["unshare", "-m", "bash", "-ec", script, "bash", PROGRAM, str(CUBE), *arguments], cwd=self.folder,
                              env=environment(), capture_output=True, text=True)

    def expected(self, name):
        result = self.run_program(CUBE, *SMALL, "-o", name)
        self.assertEqual(result.returncode, 0, result.stderr)
        return (self.folder / name).read_bytes()

    @unittest.skipUnless(CAN_MOUNT, "mounting is not permitted")
    def test_outputs_that_are_mount_points(self):
        """As with `docker run -v $PWD/host.ppm:/out.ppm`."""
        (self.folder / "host.ppm").write_text("x" * 9000)  # more than the picture
        (self.folder / "host.json").touch()
        (self.folder / "read_only").mkdir()
        for name in ("out.ppm", "out.json", "read_only/out.ppm"):
            (self.folder / name).touch()
        result = self.shell("""
            mount --bind host.ppm out.ppm
            mount --bind host.json out.json
            "$1" "$2" --size 32x24 --spp 2 -q -o out.ppm --sidecar out.json""")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "host.ppm").read_bytes(), self.expected("expected.ppm"))
        self.assertIn(b'"picture": "out.ppm"', (self.folder / "host.json").read_bytes())
        # A folder that can't be written to.
        result = self.shell("""
            mount --bind read_only read_only
            mount --bind host.ppm read_only/out.ppm
            mount -o remount,bind,ro read_only
            "$1" "$2" --size 16x12 --spp 1 -q -o read_only/out.ppm""")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.folder / "host.ppm").read_bytes().startswith(b"P6\n16 12\n"))
        # If there is too little space, the old content remains.
        before = (self.folder / "host.ppm").read_bytes()
        result = self.shell("""
            mount --bind host.ppm out.ppm
            ulimit -f 1
            "$1" "$2" --size 320x240 --spp 1 -q -o out.ppm""")
        self.assertEqual((result.returncode, "File too large" in result.stderr), (5, True), result.stderr)
        self.assertEqual((self.folder / "host.ppm").read_bytes(), before)
        self.assertEqual({path.name for path in self.folder.iterdir()},
                         {"host.ppm", "host.json", "read_only", "out.ppm", "out.json", "expected.ppm"})

    @unittest.skipUnless(CAN_MOUNT and (MODULES / "microtrace_codecs.so").exists(), "mounting is not permitted")
    def test_modules_that_may_not_be_executed(self):
        (self.folder / "modules").mkdir()
        for limit in ("unlimited", "4000000"):
            result = self.shell("""
                mount -t tmpfs -o noexec tmpfs modules
                cp "$3"/*.so modules
                ulimit -v "$4"
                MICROTRACE_MODULE_PATH=$PWD/modules "$1" "$2" --size 16x12 --spp 1 -q -o out.png""", str(MODULES), limit)
            self.assertEqual(result.returncode, 4, result.stderr)
            self.assertIn("can't be used: it is on a file system without permission to execute files (noexec)", result.stderr)

    @unittest.skipUnless(os.uname().machine == "x86_64", "the numbers are those of x86-64")
    def test_runtimes_that_refuse_new_system_calls(self):
        faccessat2, statx, memfd_create = 439, 332, 319
        expected = self.expected("expected.ppm")
        for call in (faccessat2, statx, memfd_create):
            for error in (1, 38):
                result = self.run_program(CUBE, *SMALL, "-o", "out.ppm", preexec_fn=lambda: refuse_call(call, error))
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual((self.folder / "out.ppm").read_bytes(), expected, (call, error))

    @unittest.skipUnless(os.uname().machine == "x86_64", "the numbers are those of x86-64")
    def test_file_systems_without_hard_links(self):
        """Of runs that start different data sets in one folder, only one succeeds."""
        link = 86
        for number in range(8):
            runs = [subprocess.Popen([PROGRAM, "dataset", CUBE, "--views", "orbit:1", "--size", "8x6", "--integrator", "depth",
                                      "-o", f"set{number}", "-q", "--seed", str(seed)], cwd=self.folder, env=environment(),
                                     stderr=subprocess.DEVNULL, preexec_fn=lambda: refuse_call(link, 1)) for seed in range(4)]
            self.assertEqual(sorted(run.wait() for run in runs), [0, 2, 2, 2])

    @unittest.skipUnless(CAN_MOUNT, "namespaces are not permitted")
    def test_parents_in_another_namespace(self):
        result = subprocess.run(["unshare", "-pf", "--mount-proc", PROGRAM, str(CUBE), *SMALL, "-o", "out.ppm", "--end-with-parent"],
                                cwd=self.folder, env=environment(), capture_output=True, text=True)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("--end-with-parent: the parent is in another PID namespace", result.stderr)

    @unittest.skipUnless(os.geteuid() == 0, "the limit of processes needs another user")
    def test_the_page_needs_threads(self):
        program = shutil.copy(PROGRAM, self.folder)
        shutil.copy(CUBE, self.folder)
        self.folder.chmod(0o755)
        command = ["setpriv", "--reuid=54321", "--regid=54321", "--clear-groups", "prlimit", "--nproc=1", program, "view", "cube.glb", "--no-browser"]
        result = subprocess.run(command, cwd=self.folder, env=environment(MICROTRACE_MODULE_PATH=str(MODULES)), capture_output=True, text=True,
                                timeout=60)
        self.assertEqual((result.returncode, result.stdout), (6, ""), result.stderr)
        self.assertIn("view: needs threads, which the system refuses to start", result.stderr)

    def test_limits_of_memory(self):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (60 << 20, 60 << 20))

        result = self.run_program(CUBE, "--size", "8000x8000", "--spp", "2", "-q", "-o", "out.ppm", preexec_fn=limit)
        self.assertEqual(result.returncode, 6, result.stderr)
        self.assertRegex(result.stderr.decode(), "--memory-limit|ulimit -v")

    def test_folders_for_temporary_files(self):
        result = self.run_program("dataset", CUBE, "--views", "orbit:1", "--size", "8x6", "--integrator", "depth", "-o", "set", "-q")
        self.assertEqual(result.returncode, 0, result.stderr)
        for folder, cause in (("/nonexistent", "No such file or directory"), (str(CUBE), "Not a directory")):
            result = self.run_program("verify", "set", env=environment(TMPDIR=folder))
            self.assertEqual(result.returncode, 5, result.stderr)
            self.assertRegex(result.stderr.decode(), f"error: {folder}/microtrace-......: can't be created: {cause}; set TMPDIR")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
