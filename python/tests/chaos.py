"""Renders on a cluster whose workers die, stop and have full disks, and compares the bytes with
those of one run.

    python python/tests/chaos.py [ROUNDS [SEED]]

test_distributed.py runs one round. The cluster has three workers, of which one can't write files of
more than 1 kB. Two are killed at random times and replaced; the third one is stopped for some time.
"""

from __future__ import annotations

import logging
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import fsspec
import microtrace as mt
import microtrace.distributed as md
from cluster import Accidents, Cluster

SCENE = Path(__file__).parents[2] / "scenes" / "gltf" / "materials.glb"
OPTIONS = ["--size=64x48", "--spp=16", "--aov=depth,id"]
FORMATS = ["exr", "coco", "bop"]


def files_of(folder: Path) -> dict[str, bytes]:
    """Returns the files of a folder, except for temporary files of processes that were killed."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and not path.name.startswith(".microtrace-")
    }


def files_at(url: str, options: dict[str, Any]) -> dict[str, bytes]:
    """Returns the files of a folder of an object store."""
    files, root = fsspec.core.url_to_fs(url, **options)
    files.invalidate_cache()
    paths = files.find(root)
    return {p[len(root) + 1 :]: b for p, b in files.cat(paths).items()} if paths else {}


def single_run(program: str, folder: Path, views: int) -> dict[str, bytes]:
    """Returns the files of one run of the program."""
    words = [SCENE, "-o", folder, f"--views=random:{views}", "--formats=" + ",".join(FORMATS)]
    subprocess.run([program, "dataset", *words, *OPTIONS, "--quiet"], check=True, timeout=600)
    return files_of(folder)


def chaos_round(
    folder: Path, seed: int, views: int, expected: dict[str, bytes], url: str, options: Any
) -> dict[str, Any]:
    """Renders a data set and a picture while workers die. Raises AssertionError if bytes differ."""
    with Cluster(folder) as cluster:
        full = random.Random(seed).choice(["a", "b", "c"])
        for name in ("a", "b", "c"):
            cluster.worker(name, file_limit=1000 if name == full else None)
        with cluster.client() as client:
            client.wait_for_workers(3, timeout=60)
            accidents = Accidents(cluster, seed, seconds=4)
            accidents.start()
            begin = time.monotonic()
            try:
                summary = md.dataset(
                    client,
                    SCENE,
                    url,
                    views=f"random:{views}",
                    formats=FORMATS,
                    options=OPTIONS,
                    storage_options=options,
                    retries=10,
                )
                middle = time.monotonic()
                scene = mt.load(SCENE)
                arguments: dict[str, Any] = {"size": (160, 120), "spp": 64}
                arguments["aovs"] = ["color", "depth", "object", "variance"]
                picture = md.render(client, scene, retries=10, **arguments)
            finally:
                accidents.end()
            found = files_at(url, options) if "://" in url else files_of(Path(url))
            assert sorted(found) == sorted(expected)
            for name, data in expected.items():
                assert found[name] == data, name
            for name, array in mt.render(scene, **arguments).items():
                assert picture[name].tobytes() == array.tobytes(), name
            return {
                "seed": seed,
                "full": full,
                "killed": accidents.killed,
                "rendered": summary.rendered,
                "seconds": (round(middle - begin, 1), round(time.monotonic() - middle, 1)),
            }


def object_server() -> tuple[Any, str, dict[str, Any]]:
    """Starts an object server on this machine. Returns it, its address and options for fsspec."""
    from moto.server import ThreadedMotoServer

    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    address = f"http://{host}:{port}"
    options = {"key": "a", "secret": "b", "client_kwargs": {"endpoint_url": address}}
    return server, address, options


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    views = 60
    program = os.environ.get("MICROTRACE_PROGRAM") or str(
        Path(sys.executable).parent / "microtrace"
    )
    server, _, options = object_server()
    fsspec.filesystem("s3", **options).mkdir("chaos")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.chdir(folder)
        expected = single_run(program, folder / "expected", views)
        for number in range(rounds):
            place = folder / f"round-{number}"
            place.mkdir()
            is_local = number % 2 == 0
            url = f"{place}/set" if is_local else f"s3://chaos/{number}/set"
            result = chaos_round(
                place, seed + number, views, expected, url, {} if is_local else options
            )
            print(number, "local" if is_local else "s3", result, flush=True)
    server.stop()


if __name__ == "__main__":
    main()
