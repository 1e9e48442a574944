#!/usr/bin/env python3
"""Checks the types of the Python package, and of the snippets in its README, by mypy.

usage: types_test.py SOURCE_FOLDER WORK_FOLDER, with a Python that has mypy
"""

import re
import subprocess
import sys
from pathlib import Path

source, work = Path(sys.argv[1]), Path(sys.argv[2])
work.mkdir(exist_ok=True)
package = source / "python"
snippets = re.findall(r"^```python\n(.*?)^```", (package / "README.md").read_text(), re.MULTILINE | re.DOTALL)
assert len(snippets) > 8
# NumPy's types don't allow mappings of arrays here.
text = re.sub(r"(np\.savez_compressed\(.*\*\*.*)", r"\1  # type: ignore[arg-type]", "\n".join(snippets))
(work / "readme.py").write_text(text)
sys.exit(subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", work / "cache", "--config-file", source / "pyproject.toml",
                         package / "microtrace", package / "microtrace_program", package / "tests/typed_example.py",
                         work / "readme.py"]).returncode)
