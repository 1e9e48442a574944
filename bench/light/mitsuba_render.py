#!/usr/bin/env python3
"""Renders an XML scene with Mitsuba 3 on one thread and prints the processor time of each stage as JSON.

usage: mitsuba_render.py SCENE.xml [--variant NAME] [--passes N] [--out FILE.npy] [NAME=VALUE ...]
NAME=VALUE sets a parameter of the scene. Each pass uses a different seed. FILE.npy contains the mean of all passes as
float32 RGBA.
"""
import argparse
import json
import time

START = time.process_time()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("--variant", default="scalar_rgb")
    parser.add_argument("--passes", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out")
    parser.add_argument("parameters", nargs="*")
    options = parser.parse_intermixed_args()

    import drjit
    import mitsuba
    import numpy as np

    mitsuba.set_variant(options.variant)
    drjit.set_thread_count(1)
    imported = time.process_time()
    scene = mitsuba.load_file(options.scene, **dict(p.split("=", 1) for p in options.parameters))
    loaded = time.process_time()
    renders, mean = [], None
    for i in range(options.passes):
        begin = time.process_time()
        picture = np.array(mitsuba.render(scene, seed=options.seed + i), dtype=np.float64)
        renders.append(round(time.process_time() - begin, 3))
        mean = picture if mean is None else mean + picture
    if options.out:
        np.save(options.out, (mean / options.passes).astype(np.float32))
    print(json.dumps({"import_s": round(imported - START, 3), "load_s": round(loaded - imported, 3),
                      "render_s": renders}))


if __name__ == "__main__":
    main()
