#!/usr/bin/env python3
"""Checks that relative links in Markdown files lead to files, and their fragments to headings.

usage: links.py FOLDER    every Markdown file in it, at any depth, except in build folders
"""

import re
import sys
from pathlib import Path
from urllib.parse import unquote

LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^()\s>]*(?:\([^()\s]*\)[^()\s>]*)*)>?(?:\s+\"[^\"]*\")?\s*\)|(?:src|href)=\"([^\"]+)\"")


def prose(text):
    """Returns the text without code, where brackets have another meaning."""
    text = re.sub(r"^(```|~~~).*?^\1", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"(`+).*?\1", "", text, flags=re.DOTALL)


def anchors(text):
    """Returns the fragments that GitHub generates for the headings."""
    found = {}
    for heading in re.findall(r"^#{1,6} +(.*?) *#*$", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S), re.MULTILINE):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {name + (f"-{i}" if i else "") for name, count in found.items() for i in range(count + 1)}


def dead_links(files):
    for file in files:
        for link in LINK.finditer(prose(file.read_text())):
            target = unquote(link[1] or link[2] or "")
            if re.match(r"[a-z][a-z0-9+.-]*:", target):
                continue
            path, _, fragment = target.partition("#")
            aim = file.parent / path if path else file
            if not aim.exists():
                yield f"{file}: {target}: there is no such file"
            elif fragment and aim.suffix == ".md" and fragment not in anchors(aim.read_text()):
                yield f"{file}: {target}: there is no such heading"


def main():
    folder = Path(sys.argv[1])
    files = sorted(file for file in folder.rglob("*.md")
                   if file.relative_to(folder).parts[0] not in ("build", "out", ".cache"))
    complaints = list(dead_links(files))
    if not files:
        complaints.append(f"{folder}: there is no Markdown file in it")
    print("\n".join(complaints) or f"{len(files)} files, no dead link")
    sys.exit(bool(complaints))


if __name__ == "__main__":
    main()
