# Reads what `glint --help` and `glint COMMAND --help` print.
# SPDX-License-Identifier: Apache-2.0
"""The documentation site, the manual pages and the completions of shells are made from it."""
import dataclasses
import re
import subprocess


@dataclasses.dataclass
class Entry:
    written: str  # as the help has it: "-j,--jobs UINT:UINT in [0 - 1024]=0", "NAMES TEXT ..."
    meaning: str

    @property
    def names(self) -> list[str]:
        return self.written.split(" ")[0].split(",")

    @property
    def takes(self) -> str:
        return self.written.partition(" ")[2]


@dataclasses.dataclass
class Help:
    summary: str
    usage: str
    sections: list[tuple[str, list[Entry]]]  # heading ("Options", "Positionals") and entries, in order

    @property
    def options(self) -> list[Entry]:
        return [entry for _, entries in self.sections for entry in entries if entry.written.startswith("-")]

    @property
    def commands(self) -> list[Entry]:
        return next((entries for heading, entries in self.sections if heading == "Subcommands"), [])


def parse(text: str) -> Help:
    summary, _, rest = text.strip().partition("Usage:")
    usage, _, rest = rest.partition("\n")
    sections: list[tuple[str, list[Entry]]] = []
    for line in rest.splitlines():
        entry = re.match(r"  (\S.*?)(?: {2,}(\S.*))?$", line)
        if re.match(r"\S.*:$", line):
            sections.append((line[:-1], []))
        elif entry and sections:
            sections[-1][1].append(Entry(entry[1], entry[2] or ""))
        elif line.strip() and sections and sections[-1][1]:  # a meaning that stands on the next line
            last = sections[-1][1][-1]
            last.meaning = f"{last.meaning} {line.strip()}".strip()
    return Help(" ".join(summary.split()).rstrip("."), usage.strip(), sections)


def read(glint: str, *words: str) -> Help:
    return parse(subprocess.run([glint, *words, "--help"], capture_output=True, text=True, check=True).stdout)


def read_all(glint: str) -> dict[str, Help]:
    """Returns the help of the program (key "") and of each command, in the program's order."""
    top = read(glint)
    return {"": top} | {command.written: read(glint, command.written) for command in top.commands}
