#!/usr/bin/env python3
"""Runs the array script for Slurm with the environment variables and signals of Slurm.

usage: slurm_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import os
import signal
import subprocess
import sys
import time
import unittest
from pathlib import Path

from program import PROGRAM, ProgramTest, environment

SOURCE = Path(sys.argv[2]).resolve()
SCRIPT = SOURCE / "clusters/slurm/shard.sbatch"
SCENE = SOURCE / "scenes/perspective1.json"
FIRST, STEP, COUNT = 3, 2, 4  # --array=3-9:2


class Slurm(ProgramTest):
    def setUp(self):
        super().setUp()
        tools = self.folder / "tools"
        tools.mkdir()
        (tools / "scontrol").write_text(f'#!/bin/sh\necho "$@" >>{self.folder}/requeued\n')
        (tools / "scontrol").chmod(0o755)
        (tools / "microtrace").symlink_to(PROGRAM)
        self.path = f"{tools}:{os.environ['PATH']}"

    def start(self, index, *arguments, restarts=0, **variables):
        """Starts task `index` of the array as Slurm does: in a process group of its own. `variables` replace those of the
        array."""
        return subprocess.Popen(
            ["bash", SCRIPT, *map(str, arguments)], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            start_new_session=True,
            env={**environment(), "PATH": self.path, "SLURM_ARRAY_JOB_ID": "71",
                 "SLURM_ARRAY_TASK_ID": str(FIRST + STEP * index), "SLURM_ARRAY_TASK_MIN": str(FIRST),
                 "SLURM_ARRAY_TASK_MAX": str(FIRST + STEP * (COUNT - 1)), "SLURM_ARRAY_TASK_STEP": str(STEP),
                 "SLURM_ARRAY_TASK_COUNT": str(COUNT), "SLURM_CPUS_PER_TASK": "1",
                 "SLURM_RESTART_COUNT": str(restarts), **variables})

    def program_of(self, task):
        """Waits until the task has started the program, and returns the program's process."""
        children = Path(f"/proc/{task.pid}/task/{task.pid}/children")
        for _ in range(600):
            found = children.read_text().split()
            if found and Path(f"/proc/{found[0]}/exe").resolve() == Path(PROGRAM).resolve():
                time.sleep(0.2)  # until rendering has begun
                return int(found[0])
            time.sleep(0.05)
        self.fail("the program doesn't start")

    def wait_for(self, name):
        for _ in range(6000):
            if (self.folder / name).exists():
                return
            time.sleep(0.01)
        self.fail(f"{name} doesn't appear")

    def finish(self, task, code=0):
        output = task.communicate(timeout=120)[0].decode()
        self.assertEqual(task.returncode, code, output)
        return output

    def requeued(self):
        record = self.folder / "requeued"
        lines = record.read_text().splitlines() if record.exists() else []
        record.unlink(missing_ok=True)
        return lines

    def contents(self, folder):
        return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*")
                if path.is_file() and not path.name.startswith(".microtrace-") and path.name != "dataset.json"}

    def test_tasks_make_the_data_set_of_one_run(self):
        command = ["dataset", SCENE, "--views", "orbit:10", "--size", "48x32", "--formats", "png,coco"]
        self.assertEqual(self.run_program(*command, "-o", "one").returncode, 0)
        for index in (2, 0, 3, 1):
            self.finish(self.start(index, *command, "-o", "many"))
        self.assertEqual(self.contents(self.folder / "one"), self.contents(self.folder / "many"))
        self.assertEqual(self.requeued(), [])

    def test_a_task_that_is_terminated_is_queued_again_and_continues(self):
        command = [SCENE, "--integrator", "path", "--spp", "1000", "--size", "64x48"]
        self.assertEqual(self.run_program(*command, "-o", "one.exr").returncode, 0)
        (self.folder / "parts").mkdir()
        for index in range(COUNT):
            task = self.start(index, *command, "--checkpoint", "parts/{}")
            if index == 1:
                self.program_of(task)
                task.send_signal(signal.SIGTERM)
            self.finish(task)
        # The task may have finished before the signal, on a fast machine.
        requeued = self.requeued()
        self.assertIn(requeued, ([], ["requeue 71_5"]))
        if requeued:
            self.finish(self.start(1, *command, "--checkpoint", "parts/{}", restarts=1))
        parts = sorted((self.folder / "parts").iterdir())
        self.assertEqual([part.name for part in parts], ["1", "2", "3", "4"])
        merged = self.run_program("merge", *parts, "-o", "merged.exr")
        self.assertEqual(merged.returncode, 0, merged.stderr)
        self.assertEqual((self.folder / "merged.exr").read_bytes(), (self.folder / "one.exr").read_bytes())

    def test_signals_before_the_first_sample_queue_the_task_again(self):
        task = self.start(0, SCENE, "--integrator", "path", "--spp", "60000", "--size", "800x600", "--checkpoint", "part{}")
        self.program_of(task)
        task.send_signal(signal.SIGTERM)
        self.finish(task)
        self.assertEqual(self.requeued(), ["requeue 71_3"])

    def test_signals_at_any_command_queue_the_task_again(self):
        """BASH_ENV makes the shell signal itself before one of the script's commands."""
        program, commands = self.folder / "sleeper", self.folder / "commands"
        program.write_text("#!/bin/sh\nexec sleep 60\n")
        program.chmod(0o755)
        (self.folder / "env").write_text(
            "step_number=0\n"
            "trap 'step_number=$((step_number + 1)); echo \"$BASH_COMMAND\" >>commands; [[ $step_number != \"$SIGNAL_AT\" ]] || kill -TERM $$' DEBUG\n")
        variables = {"BASH_ENV": str(self.folder / "env"), "MICROTRACE": str(program)}
        self.finish(self.start(0, "x", **{**variables, "MICROTRACE": "true", "SIGNAL_AT": "0"}))
        names = commands.read_text().splitlines()
        trap, wait = (next(i for i, name in enumerate(names) if name.startswith(word)) for word in ("trap ", "wait "))
        self.assertGreater(wait - trap, 5)
        self.assertTrue(all("=" in name or name == "set -u" for name in names[:trap]), "nothing takes time before the trap")
        for k in range(trap + 1, wait + 1):
            self.finish(self.start(0, "x", **variables, SIGNAL_AT=str(k + 1)))
            self.assertEqual(self.requeued(), ["requeue 71_3"], names[k])

    def test_a_program_that_is_hung_up_saves_its_samples_and_is_not_queued_again(self):
        command = [SCENE, "--integrator", "path", "--spp", "12000", "--size", "64x48", "--checkpoint", "part{}", "--save-every", "0"]
        task = self.start(0, *command)
        program = self.program_of(task)
        self.wait_for("part1")
        os.kill(program, signal.SIGHUP)
        self.assertIn("the samples are saved in part1", self.finish(task, 128 + signal.SIGHUP))
        self.assertEqual(self.requeued(), [])
        self.finish(self.start(0, *command))
        again = self.run_program(*[str(word).replace("{}", "one") for word in command], "--shard", "1/4")
        self.assertEqual(again.returncode, 0, again.stderr)
        for name in ("part1", "partone"):
            self.assertEqual(self.run_program("merge", name, "--partial", "-o", f"{name}.exr").returncode, 0)
        self.assertEqual((self.folder / "part1.exr").read_bytes(), (self.folder / "partone.exr").read_bytes())

    def test_a_task_is_not_queued_forever(self):
        task = self.start(0, SCENE, "--integrator", "path", "--spp", "60000", "--size", "800x600", "--checkpoint", "part{}",
                          restarts=10)
        self.program_of(task)
        task.send_signal(signal.SIGTERM)
        self.finish(task, 143)
        self.assertEqual(self.requeued(), [])

    def test_lists_of_indices_need_the_number_of_shards(self):
        command = [SCENE, "--integrator", "path", "--spp", "8", "--size", "48x32"]
        self.assertEqual(self.run_program(*command, "-o", "one.exr").returncode, 0)
        for task in (3, 4, 1, 2):
            # --array=1,3,4 and --array=2
            one = {"SLURM_ARRAY_TASK_MIN": "2", "SLURM_ARRAY_TASK_MAX": "2", "SLURM_ARRAY_TASK_COUNT": "1"}
            more = {"SLURM_ARRAY_TASK_MIN": "1", "SLURM_ARRAY_TASK_MAX": "4", "SLURM_ARRAY_TASK_COUNT": "3"}
            variables = {**(one if task == 2 else more), "SLURM_ARRAY_TASK_STEP": "1", "SLURM_ARRAY_TASK_ID": str(task)}
            start = [0, *command, "--checkpoint", "part{}"]
            self.assertIn("set SHARDS", self.finish(self.start(*start, **variables), 2))
            self.finish(self.start(*start, **variables, SHARDS="4"))
        merged = self.run_program("merge", *(f"part{i}" for i in range(1, 5)), "-o", "merged.exr")
        self.assertEqual(merged.returncode, 0, merged.stderr)
        self.assertEqual((self.folder / "merged.exr").read_bytes(), (self.folder / "one.exr").read_bytes())
        self.assertEqual(self.requeued(), [])

    def test_wrong_options_and_scenes_are_not_tried_again(self):
        self.assertIn("--no-such-option", self.finish(self.start(0, SCENE, "--no-such-option"), 2))
        (self.folder / "broken.json").write_text("{")
        self.finish(self.start(0, "dataset", "broken.json", "-o", "out", "--views", "orbit:4"), 3)
        self.assertEqual(self.requeued(), [])

    def test_a_full_disk_queues_the_task_again(self):
        self.finish(self.start(0, "dataset", SCENE, "-o", "/dev/full/views", "--views", "orbit:4"))
        self.assertEqual(self.requeued(), ["requeue 71_3"])

    def test_a_task_whose_program_is_killed_is_queued_again(self):
        task = self.start(0, SCENE, "--integrator", "path", "--spp", "60000", "--size", "800x600", "--checkpoint", "part{}")
        os.kill(self.program_of(task), signal.SIGKILL)
        self.finish(task)
        self.assertEqual(self.requeued(), ["requeue 71_3"])

    def test_a_killed_task_leaves_no_program(self):
        task = self.start(0, SCENE, "--integrator", "path", "--spp", "60000", "--size", "800x600", "--checkpoint", "part{}")
        process = self.program_of(task)
        task.kill()
        task.communicate(timeout=30)
        program = Path(f"/proc/{process}/cmdline")
        for _ in range(100):
            if not program.exists() or not program.read_bytes():
                return
            time.sleep(0.1)
        os.kill(process, signal.SIGKILL)
        self.fail("the program still runs")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
