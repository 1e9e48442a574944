#!/usr/bin/env python3
"""The manual page against --help: the same options, each with the same names.

usage: manual_test.py PROGRAM SOURCE_FOLDER [unittest arguments]
"""

import re
import sys
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from program import ProgramTest

MANUAL = (Path(sys.argv[2]) / "docs/microtrace.1.scd").read_text()


def names(line):
    return frozenset(re.findall(r"(?<![\w-])--?[a-z][\w-]*", line))


class Manual(ProgramTest):
    def setUp(self):
        super().setUp()
        self.help = self.run_program("--help").stdout.decode()

    def test_options_are_those_of_help(self):
        # A line of --help that begins with an option: its names end where a value or the text begins.
        helped = {names(re.split(r"\s{2,}| [A-Z]", line.strip())[0])
                  for line in self.help.splitlines() if re.match(r"\s+-", line)}
        described = {names(line) for line in MANUAL.splitlines() if line.startswith("*-")}
        self.assertGreater(len(helped), 20)
        self.assertEqual(helped, described, "docs/microtrace.1.scd has other options than --help")

    def test_exit_codes_are_those_of_help(self):
        footer = self.help[self.help.index("Exit codes:"):self.help.index("Examples:")]
        codes = re.findall(r"^\S*\s+\*(\d+)\*$", MANUAL, re.MULTILINE)
        self.assertEqual(re.findall(r"\b(\d+) ", footer), codes)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
