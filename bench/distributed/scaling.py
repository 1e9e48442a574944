#!/usr/bin/env python3
"""Measures what Dask adds to the rendering of a data set: compares worker processes on this machine with plain
processes that render shards.

usage: scaling.py [--views N] [--samples N] [--size WxH] [--workers 1,2] [--tasks N] [--rounds N]

Needs an idle core for each worker. The processor times of workers are counted from the moment at which all of them are
connected and have imported the package. Run it with a Python that has the packages of python/tests/requirements.txt
and this package.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "python" / "tests"))

import microtrace.distributed as md
from cluster import Cluster

SCENE = SOURCE / "scenes" / "gltf" / "materials.glb"


def processor_time(process):
    """Returns the processor time of a process so far, in seconds."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def in_shards(options, count):
    """Renders the data set by `count` processes without Dask. Returns a dictionary of seconds."""
    program = Path(sys.executable).parent / "microtrace"
    with tempfile.TemporaryDirectory() as folder:
        before, wall = os.times(), time.monotonic()
        processes = [
            subprocess.Popen([program, "dataset", SCENE, "-o", f"{folder}/views", f"--views=random:{options.views}",
                              f"--size={options.size}", f"--spp={options.samples}", "--formats=exr,coco", "--threads=1",
                              f"--shard={i + 1}/{count}", "--quiet"]) for i in range(count)]
        if any([process.wait() for process in processes]):
            sys.exit("a shard failed")
        after = os.times()
    processor = after.children_user + after.children_system - before.children_user - before.children_system
    return {"workers": processor, "wall": time.monotonic() - wall}


def import_package():
    import microtrace.distributed  # noqa: F401


class Meter:
    """Processor times of the processes of a cluster, and wall time, since the start."""

    def __init__(self, cluster):
        self._processes = {name: process.pid for name, process in cluster.processes.items()}
        self._processes["client"] = os.getpid()
        self._start = self._times()
        self._wall = time.monotonic()

    def _times(self):
        return {name: processor_time(process) for name, process in self._processes.items()}

    def read(self):
        wall, now = time.monotonic() - self._wall, self._times()
        spent = {name: now[name] - self._start[name] for name in now}
        workers = sum(seconds for name, seconds in spent.items() if name.startswith("worker-"))
        return {"workers": workers, "scheduler": spent["scheduler"], "client": spent["client"], "wall": wall}


def measure(workers, work):
    """Runs work(client) on a new cluster. Returns a dictionary of seconds."""
    with tempfile.TemporaryDirectory() as folder, Cluster(Path(folder)) as cluster:
        for i in range(workers):
            cluster.worker(f"worker-{i}")
        with cluster.client() as client:
            client.wait_for_workers(workers, timeout=60)
            client.run(import_package)
            meter = Meter(cluster)
            work(client)
            return meter.read()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--views", type=int, default=200)
    parser.add_argument("--samples", type=int, default=16)
    parser.add_argument("--size", default="96x72")
    parser.add_argument("--workers", default="1,2")
    parser.add_argument("--tasks", type=int, default=5000)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()
    counts = [int(count) for count in options.workers.split(",")]

    def render(client):
        with tempfile.TemporaryDirectory() as folder:
            md.dataset(client, SCENE, f"{folder}/views", views=f"random:{options.views}",
                       options=[f"--size={options.size}", f"--spp={options.samples}"], formats=["exr", "coco"],
                       progress=False)

    def tiny(client):
        client.gather(client.map(abs, range(options.tasks), pure=False))

    ways = {"plain processes": lambda count: in_shards(options, count),
            "Dask workers": lambda count: measure(count, render)}
    rounds = [{(way, count): run(count) for count in counts for way, run in ways.items()}
              for _ in range(options.rounds)]
    print(f"{options.views} views of {options.size} pixels, {options.samples} samples; medians in seconds")
    for way in ways:
        medians = {count: {key: statistics.median(r[way, count][key] for r in rounds) for key in rounds[0][way, count]}
                   for count in counts}
        first = medians[counts[0]]
        for count, median in medians.items():
            by_time = first["workers"] / median["workers"]
            by_wall = counts[0] * first["wall"] / (count * median["wall"])
            print(f"{count} {way}:", ", ".join(f"{key} {seconds:.2f}" for key, seconds in median.items()),
                  f"; efficiency {by_time:.3f} of processor time, {by_wall:.3f} of wall time")
    empty = measure(counts[-1], tiny)
    print(f"{options.tasks} empty tasks: {options.tasks / empty['wall']:.0f} in a second,",
          f"{1e3 * empty['scheduler'] / options.tasks:.2f} ms of the scheduler for each")


if __name__ == "__main__":
    main()
