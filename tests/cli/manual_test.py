#!/usr/bin/env python3
"""Compares docs/ with --help: the manual page must have the same texts, and docs/command-line.md a row for each option.

--update replaces the options in the manual page.

usage: manual_test.py PROGRAM SOURCE_FOLDER [--update | unittest arguments]
"""

import re
import subprocess
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
import option_table
from program import PROGRAM, ProgramTest

DOCS = Path(sys.argv[2]) / "docs"
MANUAL = DOCS / "microtrace.1.scd"
PARTS = re.compile(r"(?s)(.*; The options are written by tests/cli/manual_test\.py --update\.\n)(.*)(; End of the options\.\n.*)")


def help_text(*command):
    return subprocess.run([PROGRAM, *command, "--help"], capture_output=True, text=True, check=True).stdout


def groups():
    """Returns all options by heading. Each option occurs once."""
    all_groups = option_table.parse(help_text())
    more = {"Merging": "merge", "Data set": "dataset", "Verification": "verify", "Explanation": "explain", "Comparison": "compare", "Page": "view"}
    return {**all_groups, **{title: option_table.parse(help_text(command))[title] for title, command in more.items()}}


def bold_options(text):
    text = re.sub(r"([_*\\<>])", r"\\\1", text)
    return re.sub(r"(?<![\w-])(--[a-z][a-z-]*)", r"*\1*", text)


def wrapped(text, width=118):
    """Wraps the text. Each line begins with a word, because scdoc interprets other characters at the start of a line."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + 1 + len(word) > width and re.match(r"\w|\*--", word):
            lines.append(word)
        else:
            lines[-1] += " " * bool(lines[-1]) + word
    return "".join(f"\t{line}\n" for line in lines)


def entry(option):
    names = ", ".join(f"*{name}*" for name in option.names)
    optional = option.value.startswith("[=")
    value = option.value.strip("[=].")
    value = f"[=_{value}_]" if optional else f" _{value}_" if value else ""
    text = option.text[0].upper() + option.text[1:] + "."
    if option.default:
        text += f" Default: {option.default}."
    return f"{names}{value}\n{wrapped(bold_options(text))}\n"


def written_options():
    return "\n" + "".join(f"## {title}\n\n{''.join(map(entry, options))}" for title, options in groups().items())


class Manual(ProgramTest):
    def test_every_option_is_described(self):
        manual, page = MANUAL.read_text(), (DOCS / "command-line.md").read_text()
        in_manual = set(re.findall(r"\*(--?[a-z][a-z-]*)\*(?=[^\n]*\n\t)", manual))
        rows = set(re.findall(r"`(--?[a-z][a-z-]*)", "\n".join(re.findall(r"(?m)^\| ([^|]*(?:\\\|[^|]*)*) \|", page))))
        known = {name for options in groups().values() for option in options for name in option.names if name.startswith("-")}
        self.assertGreater(len(known), 40)
        self.assertEqual(known - in_manual, set(), "missing in docs/microtrace.1.scd")
        self.assertEqual(known - rows, set(), "missing in the tables of docs/command-line.md")
        self.assertEqual(in_manual - known, set(), "docs/microtrace.1.scd describes options that there are not")
        self.assertEqual(rows - known, set(), "docs/command-line.md describes options that there are not")

    def test_manual_page_has_the_texts_of_help(self):
        self.maxDiff = None
        self.assertEqual(PARTS.fullmatch(MANUAL.read_text())[2], written_options(),
                         "run tests/cli/manual_test.py PROGRAM SOURCE_FOLDER --update")

    def test_every_named_value_is_described(self):
        page = (DOCS / "outputs.md").read_text()
        texts = {option.name: option.text for options in groups().values() for option in options}
        for option, tables in (("--integrator", 2), ("--aov", 1), ("--tonemap", 1)):
            message = self.run_program("scene.json", option, "nonsense").stderr.decode()
            names = re.split(", | or ", re.search("expects (?:.* list of )?(.*), not nonsense", message)[1])
            self.assertGreater(len(names), 3)
            for name in names:
                if name in ("flat", "path"):
                    continue
                self.assertTrue(option == "--integrator" or re.search(rf"\b{name}\b", texts[option]), f"missing in the help of {option}: {name}")
                rows = re.findall(rf"(?m)^\|[^|]*`{name}`[^|]*\|", page)
                self.assertGreaterEqual(len(rows), tables, f"missing in a table of docs/outputs.md: {name}")

    def test_exit_codes_are_those_of_help(self):
        text = help_text()
        footer = text[text.index("Exit codes:"):text.index("Examples:")]
        codes = re.findall(r"^\S*\s+\*(\d+)\*$", MANUAL.read_text(), re.MULTILINE)
        self.assertEqual(re.findall(r"\b(\d+) ", footer), codes)


if __name__ == "__main__":
    if sys.argv[3:] == ["--update"]:
        head, _, tail = PARTS.fullmatch(MANUAL.read_text()).groups()
        MANUAL.write_text(head + written_options() + tail)
    else:
        unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
