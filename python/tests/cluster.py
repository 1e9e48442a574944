"""Real Dask processes on this machine, which can be killed and stopped."""

from __future__ import annotations

import ctypes
import os
import random
import resource
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

from distributed import Client

_PR_SET_PDEATHSIG = 1


class Cluster:
    """A scheduler and workers as processes. They end with this process, however it ends."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.file = folder / "scheduler.json"
        self.processes: dict[str, subprocess.Popen[bytes]] = {}
        self._start(
            "scheduler", "scheduler", "--host=127.0.0.1", "--port=0", "--no-dashboard", "--no-show"
        )

    def _start(self, name: str, *words: str, file_limit: int | None = None, nice: int = 0) -> None:
        def prepare() -> None:
            ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
            os.nice(nice)
            if file_limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (file_limit, file_limit))

        command = [sys.executable, "-m", "distributed.cli.dask_" + words[0], *words[1:]]
        with open(self.folder / f"{name}.log", "wb") as log:
            self.processes[name] = subprocess.Popen(
                [*command, f"--scheduler-file={self.file}"],
                stdout=subprocess.DEVNULL if file_limit else log,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=prepare,
                cwd=self.folder,
            )

    def worker(self, name: str, file_limit: int | None = None, nice: int = 0) -> None:
        """Starts a worker. It can't write files of more than `file_limit` bytes."""
        words = ["--host=127.0.0.1", "--no-nanny", "--nthreads=1", "--no-dashboard"]
        words += ["--death-timeout=20", f"--local-directory={self.folder / name}"]
        self._start(name, "worker", *words, f"--name={name}", file_limit=file_limit, nice=nice)

    def client(self) -> Client:
        deadline = time.monotonic() + 60
        while not self.file.exists():
            assert self.processes["scheduler"].poll() is None, "the scheduler ended"
            assert time.monotonic() < deadline, "the scheduler doesn't start"
            time.sleep(0.05)
        return Client(scheduler_file=str(self.file), timeout=60, set_as_default=False)

    def send(self, name: str, number: int) -> None:
        self.processes[name].send_signal(number)

    def close(self) -> None:
        for process in self.processes.values():
            process.kill()
            process.wait()

    def __enter__(self) -> Cluster:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()


class Accidents(threading.Thread):
    """Kills two of the workers a, b and c at random times and starts others in their place. Stops
    another worker for some time."""

    def __init__(self, cluster: Cluster, seed: int, seconds: float) -> None:
        super().__init__(daemon=True)
        self._cluster = cluster
        self._random = random.Random(seed)
        self._seconds = seconds
        self._ended = threading.Event()
        self.killed = 0

    def run(self) -> None:
        names = self._random.sample(["a", "b", "c"], 2)
        times = sorted(self._random.uniform(0, self._seconds) for _ in names)
        begin = time.monotonic()
        for number, (name, when) in enumerate(zip(names, times)):
            if self._ended.wait(max(0.0, begin + when - time.monotonic())):
                return
            self._cluster.send(name, signal.SIGKILL)
            self.killed += 1
            replacement = f"replacement-{number}"
            self._cluster.worker(replacement)
            if number == 0:
                slow = ({"a", "b", "c"} - set(names)).pop()
                self._cluster.send(slow, signal.SIGSTOP)
                self._ended.wait(self._random.uniform(0, self._seconds))
                self._cluster.send(slow, signal.SIGCONT)
        self._ended.wait()  # processes end with the thread that started them

    def end(self) -> None:
        self._ended.set()
        self.join()
