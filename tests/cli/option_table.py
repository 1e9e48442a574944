"""Parses the options that --help lists."""

import re
from dataclasses import dataclass


@dataclass
class Option:
    names: list  # "-o", "--output"
    value: str  # "FILE", "[=KIND]", or empty
    text: str
    default: str = ""

    @property
    def name(self):
        """Returns the first long name, or the name of a positional argument."""
        return next((name for name in self.names if name.startswith("--")), self.names[0])


def parse(text):
    """Returns a dict from headings to options, given the text of --help."""
    groups, options = {}, None
    for line in text.split("\nExit codes:")[0].splitlines():
        if re.fullmatch(r"\S.*:", line):
            options = groups.setdefault(line[:-1], [])
        elif options is not None and re.match(r"  \S", line):
            head, _, text = re.sub(r"\s{2,}", "\t", line.strip()).partition("\t")
            words = head.replace("[=", " [=").split()
            names = [word.rstrip(",") for word in words if word.startswith("-")] or words[:1]
            options.append(Option(names, " ".join(words[len(names):]), text))
        elif options and line.startswith("   "):
            options[-1].text += " " * bool(options[-1].text) + line.strip()
    for options in groups.values():
        for option in options:
            option.text, option.default = re.fullmatch(r"(.*?)(?: \[(.*)\])?", option.text).groups("")
    return groups
