"""Tests the page that shows a scene. tests/view tests the page itself."""

from __future__ import annotations

import errno
import gc
import io
import json
import os
import subprocess
import sys
import time
import urllib.error
import urllib.request

import microtrace as mt
import numpy as np
import pytest
from conftest import SCENES
from PIL import Image


def send(view, method, path, body=""):
    request = urllib.request.Request(
        view.url + path, method=method, data=body.encode() if method != "GET" else None
    )
    with urllib.request.urlopen(request, timeout=60) as response:
        return response.status, response.headers, response.read()


def picture(view, words=()):
    """Returns the finished picture as an array."""
    name = json.loads(send(view, "POST", "pictures")[2])["id"]
    send(view, "PUT", f"pictures/{name}", "\n".join(words))
    after, done = 0, False
    while not done:
        status, headers, body = send(view, "GET", f"pictures/{name}?after={after}")
        if status == 204:
            continue
        described = json.loads(headers["Microtrace-Picture"])
        after, done = described["sequence"], described["done"]
    assert headers["Content-Type"] == "image/png", body
    return np.asarray(Image.open(io.BytesIO(body)))


def expected(scene, tmp_path, **options):
    mt.render(scene, **options).save(tmp_path / "expected.png")
    return np.asarray(Image.open(tmp_path / "expected.png"))


def triangle(**options):
    scene = mt.Scene(**options)
    scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    return scene


@pytest.mark.parametrize("name", ["perspective1.json", "gltf/cube.glb"])
def test_files_are_shown_as_rendered(name, tmp_path):
    scene = mt.load(SCENES / name)
    with scene.prepare().view() as view:
        words = ["--size", "64x48"] + (["--spp", "4"] if scene.integrator == "path" else [])
        samples = {"spp": 4} if scene.integrator == "path" else {}
        shown = picture(view, words)
        assert np.array_equal(shown, expected(scene, tmp_path, size=(64, 48), **samples))


@pytest.mark.parametrize("options", [{}, {"background": (0.1, 0.2, 0.3)}, {"integrator": "flat"}])
def test_arrays_are_shown_as_rendered(options, tmp_path):
    scene = triangle(**options)
    samples = {} if scene.integrator == "flat" else {"spp": 4}
    start = "--size 40x30" + (" --spp 4" if samples else "")
    with scene.view(start) as view:
        words = json.loads(send(view, "POST", "scene")[2])["words"]
        shown = picture(view, words)
        assert np.array_equal(shown, expected(scene, tmp_path, size=(40, 30), **samples))
        with pytest.raises(urllib.error.HTTPError) as error:
            send(view, "POST", "scene", "--time\n1")
        assert b"need a scene file" in error.value.read()


def test_notebook_and_address():
    with triangle().view(height=500) as view:
        assert view.url.startswith(f"http://127.0.0.1:{view.port}/")
        html = view._repr_html_()
        assert html.startswith("<iframe ") and view.url in html and 'height="500"' in html
        assert repr(view) == f"View({view.url})"
    assert repr(view) == "View(closed)" and view._repr_html_() is None
    view.close()
    ended = triangle().view()
    send(ended, "POST", "end")
    deadline = time.monotonic() + 10
    while repr(ended) != "View(closed)" and time.monotonic() < deadline:
        time.sleep(0.05)
    assert repr(ended) == "View(closed)"
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(view.url, timeout=5)


def test_two_pages_and_ports():
    scene = triangle().prepare()
    with scene.view() as first, scene.view() as second:
        assert first.url != second.url
        assert picture(first, ["--size", "8x8", "--spp", "1"]).shape == (8, 8, 3)
        assert picture(second, ["--size", "9x9", "--spp", "1"]).shape == (9, 9, 3)
        with pytest.raises(mt.FileError, match="can't be used") as caught:
            scene.view(port=first.port)
        with pytest.raises(mt.FileError, match="choose another port"):
            scene.view(f"--port {first.port}")
        assert caught.value.errno == errno.EADDRINUSE
        assert not isinstance(caught.value, FileNotFoundError)
        port = first.port
    with scene.view(port=port) as again:
        assert again.port == port


def test_wrong_arguments():
    scene = triangle()
    with pytest.raises(mt.UsageError, match="--nothing"):
        scene.view("--nothing")
    with pytest.raises(mt.UsageError, match="--spp"):
        scene.view(["--spp", "0"])
    with pytest.raises(ValueError, match="port"):
        scene.view(port=65536)
    with pytest.raises(ValueError, match="options can't be divided into words"):
        scene.view("--view 'front")
    with pytest.raises(TypeError, match="options must be a str or a list, not 3"):
        scene.view(3)


def test_pages_close_at_any_time():
    scene = triangle().prepare()
    for delay in [0, 0, 0, 1e-5, 1e-4, 1e-3, 1e-2]:
        view = scene.view()
        time.sleep(delay)
        view.close()


def test_pages_leave_nothing_behind():
    scene = triangle().prepare()

    def resources():
        gc.collect()
        return len(os.listdir("/proc/self/task")), len(os.listdir("/proc/self/fd"))

    with scene.view() as view:
        picture(view, ["--size", "8x8", "--spp", "1"])
    before = resources()
    for i in range(20):
        view = scene.view()
        picture(view, ["--size", "8x8", "--spp", "1"])
        if i % 2:
            view.close()
        del view  # the page also ends with its object
    assert resources() == before


def test_forked_processes_do_not_keep_the_port():
    prepared = triangle().prepare()
    with prepared.view() as view:
        port = view.port
        reader, writer = os.pipe()
        if (child := os.fork()) == 0:
            os.close(writer)
            os.read(reader, 1)  # until the parent closes its end
            os._exit(0)
        os.close(reader)
        send(view, "POST", "scene")
    with prepared.view(port=port) as again:
        send(again, "POST", "scene")
    os.close(writer)
    os.waitpid(child, 0)


def test_python_exits_while_a_page_is_served():
    code = (
        "import microtrace as mt, urllib.request\n"
        f"view = mt.load({str(SCENES / 'gltf/cube.glb')!r}).view()\n"
        "urllib.request.urlopen(view.url + 'style.css')\n"
        "request = urllib.request.Request(view.url + 'pictures', data=b'', method='POST')\n"
        "urllib.request.urlopen(request)\n"
        "request = urllib.request.Request(view.url + 'pictures/1', data=b'--spp\\n65536')\n"
        "request.method = 'PUT'\n"
        "urllib.request.urlopen(request)\n"
    )
    start = time.monotonic()
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=60)
    assert (result.returncode, result.stderr) == (0, b"")
    assert time.monotonic() - start < 30
