#!/usr/bin/env python3
"""Checks that constants of namespaces and classes are spelled kCamelCase, and that comments and messages use American spelling.

usage: names.py SOURCE_FOLDER
"""

import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1])
# Type traits such as is_mesh are predicates, like std::is_same_v. PlainFeatures has the members of Features as constants.
MEMBERS = {"layers"}
CONSTANT = re.compile(r"^(?:  )?((?:static |inline )*constexpr [\w:<>*&, ]*?)\b([A-Za-z_]\w*)(?:\[[^\]]*\])?(?: =|\{)", re.MULTILINE)
BRITISH = re.compile(r"\b\w*(?:colour|grey|normalis|behaviour|neighbour|centre\b|honour|optimis|initialis|quantis|favour)\w*", re.IGNORECASE)


def faults():
    for path in sorted(path for folder in ("include", "src", "python") for path in (ROOT / folder).rglob("*.?pp")):
        text, place = path.read_text(), path.relative_to(ROOT).as_posix()
        for match in CONSTANT.finditer(text):
            is_local = match[0].startswith("  ") and "static" not in match[1]
            if not is_local and not re.match(r"k[A-Z]|is_|has_", match[2]) and match[2] not in MEMBERS:
                line = text.count("\n", 0, match.start()) + 1
                yield f"{place}:{line}: the constant {match[2]} is not kCamelCase"
    for path in sorted(path for pattern in ("include/**/*.?pp", "src/**/*.?pp", "python/src/*.?pp", "python/**/*.py", "tests/**/*.?pp", "docs/*.md", "*.md") for path in ROOT.glob(pattern)):
        for number, line in enumerate(path.read_text().splitlines(), 1):
            for match in BRITISH.finditer(line):
                if f'"{match[0]}' not in line and f'\\"{match[0]}' not in line:
                    yield f"{path.relative_to(ROOT).as_posix()}:{number}: {match[0]} is not American spelling"


found = list(faults())
print("\n".join(found) or "constants and spelling are uniform")
sys.exit(1 if found else 0)
