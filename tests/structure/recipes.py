#!/usr/bin/env python3
"""Checks the recipes "To add one: ..." in the public headers. A recipe must name every source file that handles each
existing alternative of its set. Every place that it names must exist and handle these alternatives.

usage: recipes.py SOURCE_FOLDER
"""

import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1])
HEADERS = "include/microtrace"

# Maps each header to the alternatives in code, and to their names in files and on the command line.
SETS = {
    "camera": (["PerspectiveCamera", "OrthographicCamera", "EnvironmentCamera", "CalibratedCamera"],
               ["perspective", "orthographic", "environment", "calibrated"]),
    "light": (["DirectionalLight", "PointLight", "SpotLight"], ["directional", "point", "spot"]),
    "shape": (["Sphere", "Plane", "Disc", "Triangle", "Quadric"], ["sphere", "plane", "disc", "triangle", "quadric"]),
    "tone_map": (["ToneMap::khronos_pbr_neutral", "ToneMap::aces", "ToneMap::agx"], ["khronos-pbr-neutral", "aces", "agx"]),
    "aov": ([f"Aov::{name}" for name in ("depth", "distance", "position", "normal", "face_normal", "uv", "barycentric", "albedo")],
            ["depth", "distance", "position", "normal", "face_normal", "uv", "barycentric", "albedo"]),
    "sampled_aov": ([f"SampledAov::{name}" for name in ("variance", "samples", "denoise_albedo", "denoise_normal")],
                    ["variance", "samples", "denoise_albedo", "denoise_normal"]),
    "environment": (["RadianceMap", "Studio"], ["studio"]),
    "defaults": (["FlatOptions", "PathOptions"], ["flat", "path"]),
}


def recipe_of(header: Path) -> str:
    """Returns the paragraph of the header that begins with "To add", on one line."""
    text = header.read_text()
    paragraph = re.search(r"/// To add (.*?)\n(?!/// \S)", text, re.DOTALL)
    return "" if paragraph is None else re.sub(r"\s*\n/// ", " ", paragraph[1])


def places_of(recipe: str) -> list[str]:
    return re.findall(r"\b(?:src|docs|tests|scenes|python)(?:/[\w./-]*\w)?\b", recipe)


def handles(text: str, names: list[str]) -> bool:
    return all(re.search(rf"(?<!\w){re.escape(name)}\b", text) for name in names)


def faults():
    recipes = {path.stem for path in (ROOT / HEADERS).glob("*.hpp") if recipe_of(path)}
    for stem in sorted(recipes ^ SETS.keys()):
        yield f"{HEADERS}/{stem}.hpp: has a recipe that is not in SETS, or the reverse"
    sources = [*(ROOT / "src").rglob("*.?pp"), *(ROOT / "python/src").rglob("*.?pp"), *(ROOT / "python/microtrace").rglob("*.py*")]
    for stem in sorted(recipes & SETS.keys()):
        code, words = SETS[stem]
        recipe = recipe_of(ROOT / HEADERS / f"{stem}.hpp")
        places = places_of(recipe)
        for place in places:
            path = ROOT / place
            if not path.exists():
                yield f"{HEADERS}/{stem}.hpp: {place} does not exist"
            elif path.is_file() and not place.startswith("tests") and "A lens" not in recipe.split(place)[0]:
                text = path.read_text()
                if not handles(text, code) and not handles(text, words):
                    yield f"{HEADERS}/{stem}.hpp: {place} does not handle all of {', '.join(words)}"
        for path in sources:
            place = path.relative_to(ROOT).as_posix()
            named = any(place == other or place.startswith(other + "/") for other in places)
            if not named and handles(path.read_text(), code):
                yield f"{HEADERS}/{stem}.hpp: the recipe does not name {place}"


found = list(faults())
print("\n".join(found) or "every recipe names the places of its set")
sys.exit(1 if found else 0)
