#!/usr/bin/env python3
"""Checks that no function of the AVX2 and AVX-512 kernels is also defined in another translation unit.

The linker keeps one copy of a function that several translation units define (a weak symbol). If it kept a copy compiled
for AVX-512, the program would end with an illegal instruction on older processors.

usage: kernels.py NM LIBRARY.a
"""

import subprocess
import sys

symbols = subprocess.run([sys.argv[1], "-A", "--defined-only", sys.argv[2]], capture_output=True, text=True,
                         check=True).stdout
owners = {}  # object files by the weak function that they define
for line in symbols.splitlines():
    _, place, symbol = line.split(":", 2)  # the library, the object file, and "address kind name"
    _, kind, name = symbol.split(maxsplit=2)
    if kind == "W":
        owners.setdefault(name, []).append(place)
shared = {name: places for name, places in owners.items()
          if len(places) > 1 and any("avx" in place for place in places)}
for name, places in sorted(shared.items()):
    print(f"{name}: in {', '.join(sorted(places))}")
kernels = sum(any("avx" in place for place in places) for places in owners.values())
print(f"{len(shared)} of the kernels' {kernels} functions stand elsewhere too")
sys.exit(1 if shared or kernels == 0 else 0)
