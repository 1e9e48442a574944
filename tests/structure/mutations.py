#!/usr/bin/env python3
"""Checks that each fault in the lists of mutations can still be applied to the source. The programs that apply the faults
take too long for ctest, so a stale fault would not be noticed.

usage: mutations.py SOURCE_FOLDER
"""

import importlib.util
import sys
from pathlib import Path

SOURCE = Path(sys.argv[1]).resolve()
LISTS = ["tests/golden/mutations.txt", "tests/property/bounds/mutations.txt"]

spec = importlib.util.spec_from_file_location("golden_mutations", SOURCE / "tests/golden/mutations.py")
golden = importlib.util.module_from_spec(spec)
spec.loader.exec_module(golden)

stale = 0
for path in LISTS:
    for name, file, before, after in golden.read(SOURCE / path):
        count = (SOURCE / "src" / file).read_text(encoding="utf-8").count(before)
        # If a proof is cited instead of a fault, the text may occur several times.
        if count != 1 and not (after == "proof" and count > 0):
            print(f"{path}: {name}: src/{file} contains the text {count} times: {before}")
            stale += 1
if stale:
    sys.exit(1)
print("all faults can be applied")
