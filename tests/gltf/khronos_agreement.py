#!/usr/bin/env python3
"""Compares microtrace's validation of glTF assets with that of the Khronos validator.

usage: khronos_agreement.py PROGRAM FOLDER [--list]

Examines every asset in FOLDER or below with a report of the validator beside it, NAME.gltf.report.json. The two agree if the
report has errors and microtrace calls the asset invalid, or has none and microtrace calls it valid. Assets that microtrace
does not check because of a required extension (exit code 4) count as agreement. --list names the assets on which they differ.
"""

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

SEVERITY_ERROR = 0
UNSUPPORTED = 4


def verdict(program, asset):
    """Returns microtrace's verdict about the asset, and the printed messages."""
    run = subprocess.run([program, "--validate", asset], capture_output=True, text=True, errors="replace", timeout=300)
    if run.returncode == UNSUPPORTED:
        return "unsupported", run.stderr
    if run.returncode == 0:
        return "valid", run.stderr
    return "invalid, but drawable" if ": invalid, but drawable: " in run.stdout else "refused", run.stderr


def error_pointers(report):
    return {message.get("pointer", "") for message in report["issues"]["messages"] if message["severity"] == SEVERITY_ERROR}


def names_one_of(complaints, pointers):
    """Returns True if a message points to the place of an error, or to a place above or below it.

    The two programs differ in the depth of pointers.
    """
    places = [word.rstrip(":") for line in complaints.splitlines() if line.startswith("error:")
              for word in line.split() if word.startswith("/") and word.endswith(":")]
    return any(place.startswith(pointer) or pointer.startswith(place) for pointer in pointers for place in places)


def main():
    program, folder = Path(sys.argv[1]).resolve(), Path(sys.argv[2])
    listing = "--list" in sys.argv[3:]
    counts = Counter()
    placed = differ = 0
    for report_file in sorted(folder.rglob("*.report.json")):
        asset = Path(str(report_file).removesuffix(".report.json"))
        if not asset.exists():
            continue
        report = json.loads(report_file.read_text())
        ours, complaints = verdict(program, asset)
        wrong = report["issues"]["numErrors"] > 0
        counts["errors" if wrong else "no errors", ours] += 1
        placed += wrong and names_one_of(complaints, error_pointers(report))
        differs = ours == "valid" if wrong else ours in ("refused", "invalid, but drawable")
        differ += differs
        if listing and differs:
            print(f"{asset}: the report has {'errors' if wrong else 'no errors'}, microtrace: {ours}; {complaints[:200]}")
    judged = counts.total()
    if not judged:
        sys.exit("no asset has a report beside it")
    for (theirs, ours), number in sorted(counts.items()):
        print(f"{number:6}  report: {theirs:10} microtrace: {ours}")
    wrong = sum(number for (theirs, _), number in counts.items() if theirs == "errors")
    print(f"agreement on {judged - differ} of {judged} assets; of {wrong} with errors {placed} have a complaint at a place that "
          "the report names")
    sys.exit(1 if differ else 0)


main()
