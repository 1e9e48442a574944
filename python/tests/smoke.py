"""Renders pictures with an installed package: python smoke.py FOLDER_OF_SCENES

Each decoder that the package brings along is used once, and each warning is an error.
"""

import subprocess
import sys
import tempfile
import urllib.request
import warnings
from pathlib import Path

import microtrace as mt
import numpy as np

scenes = Path(sys.argv[1])
warnings.simplefilter("error")
with tempfile.TemporaryDirectory() as name:
    folder = Path(name)
    for scene in ("knot", "textured", "textures", "draco", "meshopt", "meshopt_khr"):
        prepared = mt.load(scenes / f"{scene}.glb").prepare()
        picture = mt.render(prepared, size=(64, 48), spp=2, aovs=["color", "depth"])
        for extension in ("png", "exr", "ppm"):
            path = folder / f"{scene}.{extension}"
            picture.save(path)
            assert path.stat().st_size > 100, path
        camera = mt.frame(prepared, size=(64, 48))
        hit = prepared.intersect([*camera.position, *camera.direction], fields=("t", "object"))
        assert np.isfinite(picture.depth).any(), scene
        print(scene, picture, hit.t)
    program = Path(sys.executable).with_name("microtrace")
    path = folder / "program.png"
    subprocess.run(
        [program, scenes / "knot.glb", "--spp", "2", "--size", "64x48", "-o", path, "-q"],
        check=True,
    )
    assert path.read_bytes() == (folder / "knot.png").read_bytes()
    module = [sys.executable, "-m", "microtrace"]
    words = ["dataset", scenes / "knot.glb", "--views", "orbit:2", "--size", "64x48", "--spp", "2"]
    subprocess.run(
        [*module, *words, "--formats", "png,npz,coco,bop", "-o", folder / "set", "-q"], check=True
    )
    subprocess.run([*module, "verify", folder / "set", "-q"], check=True)
    # The page needs the module for HTTP.
    with prepared.view() as view, urllib.request.urlopen(view.url, timeout=60) as page:
        assert b"<canvas" in page.read()
    with np.load(folder / "set/000001.npz") as arrays:
        assert arrays["color"].shape == (48, 64, 3)
print(f"microtrace {mt.__version__} works, from {Path(mt.__file__).parent}")
