#!/usr/bin/env python3
"""Checks that a library exports the functions and classes that its headers declare for export, and nothing else. An archive
must not contain functions that the linker may replace by the application's copies either.

usage: exported_test.py LIBRARY INCLUDE_FOLDER
"""

import re
import subprocess
import sys
from pathlib import Path

is_archive = sys.argv[1].endswith(".a")
listed = subprocess.run(["nm", "--extern-only" if is_archive else "--dynamic", "--defined-only", "--demangle", "--format=posix",
                         sys.argv[1]], capture_output=True, text=True, check=True).stdout
lines = [line for line in listed.splitlines() if line and not line.endswith(":")]  # omits names of files
symbols = [re.sub(r" [A-Za-z] [0-9a-f ]*$", "", line) for line in lines]
replaceable = [line for line in lines if is_archive and re.search(r" [Wu] [0-9a-f ]*$", line)]

headers = "\n".join(path.read_text() for path in Path(sys.argv[2]).rglob("*.hpp"))
headers = re.sub(r"//.*|^#.*", "", headers, flags=re.MULTILINE)
classes = set(re.findall(r"\b(?:class|struct)\s+MICROTRACE_EXPORT\s+(\w+)", headers))
c_functions = {name for path in Path(sys.argv[2]).rglob("*.h")
               for name in re.findall(r"^MT_API\b[^;()]*?(\w+)\(", path.read_text(), flags=re.MULTILINE)}
functions = set(re.findall(r"MICROTRACE_EXPORT\s+[^;()]*?(\w+)\(", headers)) - classes


def is_declared(symbol):
    symbol = re.sub(r"^(?:typeinfo name|typeinfo|vtable) for |\[abi:\w+\]", "", symbol)
    name = re.match(r"microtrace::(\w+)(::)?", symbol)
    if not name:
        return False
    # Omits classes within a class.
    is_nested = re.match(r"microtrace::\w+::([A-Z]\w*)::", symbol)
    return name[1] in classes and not is_nested or not name[2] and name[1] in functions


leaked = [symbol for symbol in symbols if symbol not in c_functions and not is_declared(symbol)]
missing = [*(c_functions - set(symbols)),
           *(name for name in functions | classes if not any(re.search(rf"\b{name}\b", symbol) for symbol in symbols))]
for symbol in leaked:
    print("exported without a declaration:", symbol)
for line in replaceable:
    print("replaced by copies of applications:", line)
for name in missing:
    print("declared but not exported:", name)
print(len(symbols), "symbols exported,", len(functions) + len(c_functions), "functions and", len(classes), "classes declared")
sys.exit(bool(leaked or missing or replaceable or not symbols))
