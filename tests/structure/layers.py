#!/usr/bin/env python3
"""Checks that each part of the source includes only what it may; see docs/architecture.md.

usage: layers.py SOURCE_FOLDER
"""

import functools
import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1])

# Maps each part of src/ to the other parts that it may include. Public headers belong to no part. HIDDEN below restricts
# them.
MAY_INCLUDE = {
    "base": set(),
    "simd": {"base"},
    "exact": {"base"},
    "scene": {"base", "simd", "exact"},
    "accel": {"base", "simd", "exact", "scene"},
    "queries": {"base", "simd", "exact", "scene", "accel"},
    "render": {"base", "simd", "scene", "accel"},
    "explain": {"base", "exact", "scene", "accel", "render"},
    "io": {"base", "scene"},
    "denoise": {"base", "io"},
    "dataset": {"base", "scene", "queries", "io"},
    "cli": {"base", "scene", "io"},
    "capi": {"base", "scene"},
    "modules": {"io"},
}
# The folders of large parts. Each may include itself and those before it. BESIDE stands for the files beside the folders. The
# folders of other parts have no fixed order, but must not include each other in a cycle.
BESIDE = "."
ORDERED_FOLDERS = {
    "io/gltf": ["document", "bytes", "extensions", "check", "material", "mesh", "animation", "pose", "scene"],
    "render": ["lanes", "sampling", "film", "bsdf", "media", "textures", "shading", "guiding", "lights", "lighting", "prepared",
               "aovs", "integrators", "samples", "kernels", BESIDE],
}
MOST_FILES = 20  # in a folder of these parts
# Public headers that a part must not include.
HIDDEN = {
    "base": {"scene", "camera", "film", "io", "render", "integrator", "aov", "sidecar", "bvh", "primitives"},
    "exact": {"scene", "camera", "film", "io", "render", "integrator", "aov", "sidecar", "bvh", "primitives"},
    "simd": {"scene", "camera", "film", "io", "render", "integrator", "aov", "sidecar", "bvh", "primitives"},
    "scene": {"film", "io", "render", "integrator", "aov", "sidecar", "bvh"},
    "accel": {"camera", "film", "io", "render", "integrator", "aov", "sidecar"},
    "queries": {"camera", "film", "io", "render", "integrator", "aov", "sidecar"},
    "render": {"io", "sidecar"},
    "explain": {"io", "sidecar", "aov"},
    "io": {"render", "bvh", "integrator", "aov"},
}
# Libraries that only these folders may include.
LIBRARIES = {
    r"CGAL/|gmp": ["tests/oracle"],
    r"tiny_gltf": ["src/io/gltf/document/model.cpp"],
    r"nlohmann/": ["src/io/json", "src/io/sidecar", "src/cli/view", "tests"],
    r"OpenImageIO/": ["src/modules/openimageio", "tests/image"],
    r"Imf": ["src/modules/openexr"],
    r"draco/|meshoptimizer\.h": ["src/modules", "tests/gltf"],
    r"png\.h|jpeglib\.h|webp/|zstd\.h": ["src/modules/codecs"],
    r"CLI/": ["src/cli"],
    r"boost/": ["src/modules/http"],
    r"embree|benchmark/": ["bench"],
    r"\w*mmintrin\.h": ["src/simd/vectors.hpp", "src/accel/kernels/simd.hpp"],
}


@functools.cache
def includes(path):
    lines = enumerate(path.read_text().splitlines(), 1)
    matches = ((number, re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)) for number, line in lines)
    return [(number, match[1]) for number, match in matches if match]


def folder_of(parts):
    return parts[0] if len(parts) > 1 else BESIDE


def inner_includes(part, path):
    """The includes of a file of this part that are of the same part, as line and path within it."""
    return [(number, name.removeprefix(part + "/").split("/")) for number, name in includes(path) if name.startswith(part + "/")]


def order_complaints(part, folders):
    folder = ROOT / "src" / part
    for path in sorted(p for p in folder.rglob("*") if p.suffix in (".hpp", ".cpp")):
        own = folder_of(path.relative_to(folder).parts)
        if own not in folders:
            yield f"{path.relative_to(ROOT)}: belongs in one of {', '.join(folders)}"
            continue
        allowed = folders[:folders.index(own) + 1]
        for number, parts in inner_includes(part, path):
            if folder_of(parts) not in allowed:
                yield f"{path.relative_to(ROOT)}:{number}: {own} may not include {part}/{'/'.join(parts)}"
    for sub in sorted(p for p in folder.rglob("*") if p.is_dir()):
        files = sum(p.is_file() for p in sub.iterdir())
        if files > MOST_FILES:
            yield f"{sub.relative_to(ROOT)}: {files} files; split what is over {MOST_FILES}"


def cycle_complaints(part):
    folder = ROOT / "src" / part
    wanted = {}  # the folders that each folder includes
    for path in (p for p in folder.rglob("*") if p.suffix in (".hpp", ".cpp")):
        own = folder_of(path.relative_to(folder).parts)
        wanted.setdefault(own, set()).update(folder_of(parts) for _, parts in inner_includes(part, path))
    # Files beside the folders may be shared by them, and may use them.
    wanted.pop(BESIDE, None)
    for own, others in wanted.items():
        others.discard(own)
    while free := [name for name, others in wanted.items() if not others & wanted.keys()]:
        for name in free:
            del wanted[name]
    if wanted:
        yield f"src/{part}: some of the folders {', '.join(sorted(wanted))} include each other"


def complaints():
    files = [p for folder in ("include", "src", "tests", "bench") for p in (ROOT / folder).rglob("*")
             if p.suffix in (".hpp", ".cpp")]
    assert len(files) > 20, "the sources are not where this script looks"
    for path in files:
        place = path.relative_to(ROOT)
        part = place.parts[1] if place.parts[0] == "src" and len(place.parts) > 2 else None
        for number, name in includes(path):
            first = name.split("/")[0]
            if part and first in MAY_INCLUDE and first != part and first not in MAY_INCLUDE[part]:
                yield f"{place}:{number}: {part} may not include {name}"
            if part == "modules" and first == "io" and not name.endswith("_abi.hpp"):
                yield f"{place}:{number}: modules may include only the C interfaces of io, not {name}"
            if part and first == "microtrace" and name[11:-4] in HIDDEN.get(part, ()):
                yield f"{place}:{number}: {part} may not include <{name}>"
            if place.parts[0] == "include" and first not in ("microtrace", "glm") and "/" in name:
                yield f"{place}:{number}: a public header may include only std, GLM and microtrace"
            for library, folders in LIBRARIES.items():
                if re.match(library, name) and not any(str(place).startswith(f) for f in folders):
                    yield f"{place}:{number}: {name} belongs in {' or '.join(folders) or 'no file yet'}"
        lines = len(path.read_text().splitlines())
        if lines > 300 and place.parts[0] in ("src", "include"):
            yield f"{place}: {lines} lines; split what is over 300"


def umbrella_complaints():
    folder = ROOT / "include/microtrace"
    included = {name for _, name in includes(folder / "microtrace.hpp")}
    for header in sorted(folder.glob("*.hpp")):
        name = f"microtrace/{header.name}"
        if header.name != "microtrace.hpp" and name not in included:
            yield f"include/microtrace/microtrace.hpp: does not include <{name}>"


ordered = (complaint for part, folders in ORDERED_FOLDERS.items() for complaint in order_complaints(part, folders))
cycles = (complaint for part in MAY_INCLUDE for complaint in cycle_complaints(part))
found = [*complaints(), *ordered, *cycles, *umbrella_complaints()]
print("\n".join(found) or "every include is within its layer")
sys.exit(1 if found else 0)
