#!/usr/bin/env python3
"""Renders views of models as data sets with microtrace, with Blender's Cycles (the approach of BlenderProc), and with
pyrender, and prints the views per second of processor time.

usage: compare.py PROGRAM MODEL... [--views N] [--peer-views N] [--samples N] [--size WxH] [--output FILE.json]

microtrace writes the files of COCO and BOP with amodal masks, once path traced and once without light. The peers write
the color, depth and object ids of each view, but no masks and no annotations. All use one thread. Times include the
start of the programs and the loading of the models. A model that a renderer rejects is left out for this renderer.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent


def processor_time(command, environment):
    """Runs a command. Returns its processor time in seconds, or None if it fails."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = subprocess.run(command, env={**os.environ, **environment}, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        print(f"{command[0]} {command[1]} ended with {result.returncode}: {result.stderr.strip()[-200:]}", file=sys.stderr)
        return None
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def microtrace_command(options, integrator):
    return lambda model, folder: [
        options.program, "dataset", model, "-o", folder, "--views", f"random:{options.views}", "--seed", "1",
        "--size", f"{options.size[0]}x{options.size[1]}", "--formats", "coco,bop", "--amodal", "--threads", "1",
        "--integrator", integrator, *(["--samples", str(options.samples)] if integrator == "path" else [])]


def peer_command(script, views, *options):
    return lambda model, folder: [sys.executable, HERE / script, model, folder, *map(str, (views, *options))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("models", nargs="+", metavar="MODEL")
    parser.add_argument("--views", type=int, default=50, help="views of each model by microtrace")
    parser.add_argument("--peer-views", type=int, default=2, help="views of each model by the peers")
    parser.add_argument("--samples", type=int, default=16, help="samples per pixel of path-traced colors")
    parser.add_argument("--size", type=lambda text: [int(n) for n in text.split("x")], default=[640, 480])
    parser.add_argument("--output")
    options = parser.parse_args()

    # Rasterizing is fast, so more views make the start of the program count less.
    rasterized = 5 * options.peer_views
    jobs = {"microtrace, path traced": (microtrace_command(options, "path"), options.views),
            "microtrace, without light": (microtrace_command(options, "flat"), options.views),
            "Cycles": (peer_command("cycles_views.py", options.peer_views, *options.size, options.samples),
                       options.peer_views),
            "pyrender": (peer_command("pyrender_views.py", rasterized, *options.size), rasterized)}
    environment = {"PYOPENGL_PLATFORM": "osmesa", "LP_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    totals = {name: [0.0, 0] for name in jobs}
    for model in options.models:
        for name, (command, views) in jobs.items():
            with tempfile.TemporaryDirectory() as folder:
                seconds = processor_time(command(model, Path(folder) / "views"), environment)
            if seconds is not None:
                totals[name][0] += seconds
                totals[name][1] += views
        print(Path(model).name, {name: round(seconds, 2) for name, (seconds, _) in totals.items()}, file=sys.stderr)
    rates = {name: views / seconds for name, (seconds, views) in totals.items()}
    print("| renderer | views | seconds | views per second |\n|---|---|---|---|")
    for name, (seconds, views) in totals.items():
        print(f"| {name} | {views} | {seconds:.1f} | {rates[name]:.2f} |")
    if options.output:
        Path(options.output).write_text(json.dumps(totals, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
