#!/usr/bin/env python3
"""Checks that every source and every test is compiled or run: that a CMakeLists.txt in its folder or above names it, or
another one by its path. Checks that every source that a CMakeLists.txt names exists.

usage: sources.py SOURCE_FOLDER
"""

import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1])
PATTERNS = ("src/**/*.cpp", "tests/**/*.cpp", "bench/**/*.cpp", "python/src/**/*.cpp", "tests/**/*_test.py")
# kernel_sources() names these, tests/fuzz/CMakeLists.txt adds the ending, and package_test.cmake runs the last one.
NAMED_OTHERWISE = re.compile(r"/kernels/(portable|avx2|avx512)\.cpp$|^tests/fuzz/\w+_fuzz\.cpp$|/exported_test\.py$")


def lists_above(folder):
    while True:
        path = folder / "CMakeLists.txt"
        if path.exists():
            yield path.read_text()
        if folder == ROOT:
            return
        folder = folder.parent


ELSEWHERE = "\n".join(path.read_text() for path in ROOT.glob("tests/**/CMakeLists.txt"))


def is_named(path):
    place = path.relative_to(ROOT).as_posix()
    if place.startswith("tests/") and place.replace("tests/", "../", 1) in ELSEWHERE:
        return True
    return any(re.search(rf"(?<!\w){re.escape(path.stem)}(?!\w)", text) for text in lists_above(path.parent))


def missing_sources():
    for folder in ("src", "tests", "bench", "python"):
        for path in sorted((ROOT / folder).rglob("CMakeLists.txt")):
            for name in re.findall(r"^ +([\w./-]+\.cpp)\b", path.read_text(), re.MULTILINE):  # lines of lists
                if not (path.parent / name).exists():
                    yield f"{path.relative_to(ROOT)}: names {name}, which does not exist"


places = [path.relative_to(ROOT).as_posix() for pattern in PATTERNS for path in sorted(ROOT.glob(pattern))]
found = [f"{place}: no CMakeLists.txt names it" for place in places
         if not NAMED_OTHERWISE.search(place) and not is_named(ROOT / place)]
found += missing_sources()
print("\n".join(found) or "every source is compiled")
sys.exit(1 if found else 0)
