#!/usr/bin/env python3
"""Compares microtrace with Open3D, embreex and Mitsuba from Python, by processor time on one thread.

usage: compare.py [views] [rays] [edges] [start] [--rounds N] [--quick] [--output FILE.json]
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np

import meshes
import peers


def median_times(jobs, rounds):
    """The median processor time of each job. The jobs take turns, after one round of warming up."""
    times = {name: [] for name in jobs}
    for k in range(rounds + 1):
        for name, job in jobs.items():
            start = time.process_time()
            job()
            if k:
                times[name].append(time.process_time() - start)
    return {name: statistics.median(values) for name, values in times.items()}


def has_llvm():
    """True if the caller has chosen a version of LLVM. The choice is the caller's, because older
    versions abort on processors with AVX-512."""
    return bool(os.environ.get("DRJIT_LIBLLVM_PATH"))


def views(quick, rounds):
    """Measures views per processor second: depth, both normals and object of a textured model."""
    vertices, faces, uv = meshes.bumpy_sphere(90, 86)
    count, size = (4, (160, 120)) if quick else (100, (640, 480))
    makers = {"microtrace": peers.microtrace_views, "Open3D": peers.open3d_views,
              "Mitsuba scalar": peers.mitsuba_scalar_views, "trimesh + embreex": peers.embreex_views}
    if has_llvm():
        makers["Mitsuba LLVM"] = peers.mitsuba_llvm_views
    renderers = {name: make(vertices, faces, uv, size) for name, make in makers.items()}
    eyes = meshes.orbit(count)
    chosen = eyes if quick else eyes[::10]
    jobs = {name: (lambda r=render: [r(eye) for eye in chosen]) for name, render in renderers.items()}
    times = median_times(jobs, rounds)
    hit = {name: int((render(eyes[0])[0] < np.inf).sum()) for name, render in renderers.items()}
    return {name: {"per_second": len(chosen) / t, "triangles": len(faces), "views": len(chosen), "hits": hit[name]}
            for name, t in times.items()}


def rays(quick, rounds):
    """Measures random rays per processor second. Queries return t and ids in NumPy arrays."""
    edge = 60 if quick else 708
    vertices, faces, _ = meshes.bumpy_sphere(edge, edge)
    batch = meshes.random_rays(10**4 if quick else 10**7)
    casters = peers.casters(vertices, faces)
    jobs = {name: (lambda c=cast: c(batch)) for name, cast in casters.items()}
    with tempfile.TemporaryDirectory() as folder:
        program = os.environ.get("MICROTRACE_MANY_RAYS")
        library = []
        if program:
            command = [program] + [os.path.join(folder, name) for name in ("vertices", "faces", "rays")]
            for path, array in zip(command[1:], (vertices, faces, batch)):
                array.tofile(path)
            jobs["C++"] = lambda: library.append(float(subprocess.check_output(command)))
        times = median_times(jobs, rounds)
    if library:
        times["C++"] = statistics.median(library[1:])
    return {name: {"per_second": len(batch) / t, "triangles": len(faces), "rays": len(batch)}
            for name, t in times.items()}


def edges(quick, _):
    """Counts the rays that miss a closed mesh although they start inside. They are aimed at
    vertices and edges."""
    count = 10**4 if quick else 10**6
    result = {}
    for shape, (vertices, faces, center) in meshes.closed_meshes().items():
        aimed = meshes.aimed_rays(vertices, faces, center, count)
        found = {}
        for name, cast in peers.casters(vertices, faces).items():
            found[name] = sum(int((cast(part)[1] < 0).sum()) for part in np.array_split(aimed, 10))
        result[shape] = found
    return result


def start(quick, rounds):
    """processor seconds and resident MiB of importing a package and loading a scene, in excess of
    importing NumPy."""
    model = os.path.join(os.path.dirname(__file__), "..", "..", "scenes", "gltf", "textured.glb")
    programs = {
        "numpy": "import numpy",
        "microtrace": f"import numpy, microtrace; microtrace.load({model!r}).prepare()",
        "Open3D": "import numpy, open3d; open3d.t.geometry.RaycastingScene()",
        "Mitsuba scalar": "import numpy, mitsuba; mitsuba.set_variant('scalar_rgb')",
        "trimesh + embreex": f"import numpy, trimesh, embreex; trimesh.load({model!r})",
    }
    # Reads VmRSS instead of ru_maxrss, because a process inherits ru_maxrss from its parent.
    tail = """
import re, time
print(time.process_time(), int(re.search(r"VmRSS:\\s+(\\d+)", open("/proc/self/status").read())[1]) / 1024)"""
    measured = {name: [] for name in programs}
    for _ in range(rounds):
        for name, text in programs.items():
            run = subprocess.run([sys.executable, "-c", text + tail], capture_output=True, text=True, check=True)
            measured[name].append([float(x) for x in run.stdout.split()[-2:]])
    middle = {name: [statistics.median(column) for column in zip(*rows)] for name, rows in measured.items()}
    base = middle.pop("numpy")
    return {name: {"seconds": s - base[0], "mebibytes": m - base[1]} for name, (s, m) in middle.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    kinds = {"views": views, "rays": rays, "edges": edges, "start": start}
    parser.add_argument("kinds", nargs="*", help=", ".join(kinds))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--quick", action="store_true", help="small inputs: does it run?")
    parser.add_argument("--output", default="bench_python.json")
    arguments = parser.parse_args()
    results = {}
    for kind in arguments.kinds or kinds:
        results[kind] = kinds[kind](arguments.quick, arguments.rounds)
        print(kinds[kind].__doc__)
        for name, row in results[kind].items():
            print(f"  {name:18}", *(f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in row.items()),
                  flush=True)
        with open(arguments.output, "w", encoding="utf-8") as file:
            json.dump(results, file, indent=1)


if __name__ == "__main__":
    main()
