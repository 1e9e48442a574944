#!/usr/bin/env python3
"""How far microtrace and the Khronos glTF validator agree on what is wrong with assets.

usage: khronos_agreement.py PROGRAM FOLDER [--list]

Takes every asset below FOLDER that has the validator's report beside it, as NAME.gltf.report.json. An asset in whose report
there are errors is expected to be refused or to be warned of at one of their places; one without, to be accepted. Required
extensions that microtrace lacks (exit code 4) are counted apart. --list names the assets on which the two differ.
"""

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

SEVERITY_ERROR = 0
UNSUPPORTED = 4


def verdict(program, asset):
    """The exit code, and the complaints as they are printed."""
    run = subprocess.run([program, "--validate", asset], capture_output=True, text=True, errors="replace", timeout=300)
    return run.returncode, run.stderr


def error_pointers(report):
    return {message.get("pointer", "") for message in report["issues"]["messages"] if message["severity"] == SEVERITY_ERROR}


def names_one_of(complaints, pointers):
    """Whether a complaint stands at, above or below the place of an error: the two programs differ in how deep they point."""
    places = [word.rstrip(":") for line in complaints.splitlines() if line.startswith(("error:", "warning:"))
              for word in line.split() if word.startswith("/") and word.endswith(":")]
    return any(place.startswith(pointer) or pointer.startswith(place) for pointer in pointers for place in places)


def main():
    program, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    listing = "--list" in sys.argv[3:]
    counts = Counter()
    for report_file in sorted(folder.rglob("*.report.json")):
        asset = Path(str(report_file).removesuffix(".report.json"))
        if not asset.exists():
            continue
        report = json.loads(report_file.read_text())
        pointers = error_pointers(report)
        code, complaints = verdict(program, asset)
        wrong = report["issues"]["numErrors"] > 0
        kind = ("errors" if wrong else "no errors",
                "unsupported" if code == UNSUPPORTED else "refused" if code else
                "warned of" if "warning:" in complaints else "accepted")
        counts[kind] += 1
        if wrong and code != UNSUPPORTED:
            counts["placed"] += names_one_of(complaints, pointers)
        differs = (wrong and kind[1] == "accepted") or (not wrong and kind[1] == "refused")
        counts["differ"] += differs
        if listing and (differs or code == 1):
            print(f"{asset}: report has {kind[0]}, microtrace: {kind[1]} {complaints.splitlines()[:1]}")
    judged = sum(n for kind, n in counts.items() if isinstance(kind, tuple))
    if not judged:
        sys.exit("no asset has a report beside it")
    for kind in sorted(k for k in counts if isinstance(k, tuple)):
        print(f"{counts[kind]:6}  report: {kind[0]:10} microtrace: {kind[1]}")
    complained = sum(n for kind, n in counts.items() if isinstance(kind, tuple) and kind[0] == "errors" and
                     kind[1] in ("refused", "warned of"))
    print(f"agreement on {judged - counts['differ']} of {judged} assets; "
          f"{counts['placed']} of {complained} complaints at a place that the report names")
    sys.exit(1 if counts["differ"] else 0)


main()
