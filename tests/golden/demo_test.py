#!/usr/bin/env python3
"""Draws the pictures of ./demo and compares their SHA-256 digests with demo_sha256.txt, which continuous integration
expects.

usage: demo_test.py PROGRAM [--update]

--update writes the digests into the list instead.
"""

import hashlib
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
LIST = Path(__file__).with_name("demo_sha256.txt")
# The lines of ./demo that render pictures: a loop, and single commands.
DRAWING = re.compile(r"^(for name in .*|  microtrace .*|done|microtrace scenes/.*)$", re.MULTILINE)


def main():
    program = Path(sys.argv[1]).resolve()
    script = f'set -e\nmicrotrace() {{ "{program}" -q "$@"; }}\n' + "\n".join(DRAWING.findall((SOURCE / "demo").read_text()))
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "scenes").symlink_to(SOURCE / "scenes")
        Path(folder, "out").mkdir()
        subprocess.run(["bash", "-c", script], cwd=folder, check=True)
        digests = {path.relative_to(folder).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
                   for path in Path(folder, "out").iterdir()}
    listed = [line.split() for line in LIST.read_text().splitlines()]
    if "--update" in sys.argv[2:]:
        LIST.write_text("".join(f"{digests[name]}  {name}\n" for _, name in listed))
        return
    if digests.keys() != {name for _, name in listed}:
        sys.exit(f"./demo draws {sorted(digests)}")
    wrong = [name for digest, name in listed if digests[name] != digest]
    if wrong:
        sys.exit("other bytes than listed: " + ", ".join(wrong))


if __name__ == "__main__":
    main()
