"""Tests the Job for Kubernetes against the published schema, and runs its pods' command."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import kubernetes_validate
import pytest
import yaml
from conftest import REPOSITORY, SCENES

JOB = yaml.safe_load((REPOSITORY / "clusters" / "kubernetes" / "dataset.yaml").read_text())
SPEC = JOB["spec"]
CONTAINER = SPEC["template"]["spec"]["containers"][0]


# Version 1.33 is the first one in which backoffLimitPerIndex is stable.
@pytest.mark.parametrize("version", ["1.33", kubernetes_validate.latest_version()])
def test_the_job_has_the_published_schema(version):
    kubernetes_validate.validate(JOB, version, strict=True)


def test_shards_are_those_of_the_job():
    values = {variable["name"]: variable.get("value") for variable in CONTAINER["env"]}
    assert values["SHARDS"] == str(SPEC["completions"])
    assert CONTAINER["name"] == SPEC["podFailurePolicy"]["rules"][0]["onExitCodes"]["containerName"]


def run_pod(program: str, folder: Path, index: int, **changes: str) -> int:
    """Runs the pod's command as the kubelet does, with other values of some variables."""
    variables = {
        variable["name"]: variable["value"] for variable in CONTAINER["env"] if "value" in variable
    }
    tools = folder / "tools"
    if not tools.exists():
        tools.mkdir()
        (tools / "microtrace").symlink_to(program)
    environment = {
        "PATH": f"{tools}:{os.environ['PATH']}",
        "THREADS": "2",
        "JOB_COMPLETION_INDEX": str(index),
    }
    return subprocess.run(
        CONTAINER["command"], env=environment | variables | changes, cwd=folder, timeout=300
    ).returncode


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != "dataset.json"
    }


def test_pods_make_the_data_set_of_one_run(program, tmp_path):
    scene = str(SCENES / "perspective1.json")
    options = "--views orbit:7 --size 48x32 --formats png,coco"
    common = {"SCENE": scene, "OUTPUT": str(tmp_path / "many"), "OPTIONS": options, "SHARDS": "3"}
    for index in (2, 0, 1, 2):
        assert run_pod(program, tmp_path, index, **common) == 0
    subprocess.run(
        [program, "dataset", scene, "-o", tmp_path / "one", "--quiet", *options.split()],
        check=True,
        timeout=300,
    )
    assert contents(tmp_path / "many") == contents(tmp_path / "one")


def test_exit_codes_that_every_pod_would_repeat_end_the_job(program, tmp_path):
    final = SPEC["podFailurePolicy"]["rules"][0]
    assert final["action"] == "FailJob"
    codes = final["onExitCodes"]["values"]
    (tmp_path / "broken.json").write_text("{")
    common = {"SCENE": str(SCENES / "perspective1.json"), "OUTPUT": str(tmp_path / "out")}
    assert run_pod(program, tmp_path, 0, **common, OPTIONS="--no-such-option") in codes
    assert run_pod(program, tmp_path, 0, **(common | {"SCENE": "broken.json"})) in codes
    missing = run_pod(program, tmp_path, 0, **(common | {"OUTPUT": "/dev/full/out"}))
    assert missing == 5
    assert missing not in codes
