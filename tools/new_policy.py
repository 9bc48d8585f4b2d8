#!/usr/bin/env python3
# Begins a new policy: its file, its row in the test of all policies, and its line in the changelog.
# SPDX-License-Identifier: Apache-2.0
"""The new file is a copy of an existing policy of the same kind under the new name, so it builds and keeps the contract
before its first change. With --plugin it becomes a project of its own that needs only an installed Glint."""
import argparse
import functools
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
TABLE = ROOT / "tests/cli/policies.csv"
CHANGELOG = ROOT / "CHANGELOG.md"


def fail(message: str, note: str = "") -> None:
    sys.exit(f"error: {message}" + (f"\n  note: {note}" if note else ""))


def registrations() -> dict[str, dict[str, pathlib.Path]]:
    """Returns a map from interfaces to names of policies to their files."""
    found: dict[str, dict[str, pathlib.Path]] = {}
    for path in sorted(path for depth in ("*/*/*.cpp", "*/*/*/*.cpp") for path in ROOT.glob(depth)):
        if path.relative_to(ROOT).parts[0] in ("tests", "build"):
            continue
        text = path.read_text()
        interface = re.search(r"const Register<(\w+), \w+> ", text)
        name = re.search(r'kName = "(\w+)"', text)
        if interface and name:
            found.setdefault(interface[1], {})[name[1]] = path
    return found


@functools.cache
def keys() -> dict[str, str]:
    """Returns a map from interfaces to their keys."""
    found = {}
    for path in (path for depth in ("*/*.h", "*/*/*.h") for path in ROOT.glob(depth)):
        if key := re.search(r'class (\w+) \{(?:(?!\nclass ).)*?kKind\{"([^"]+)"', path.read_text(), re.S):
            found[key[1]] = key[2]
    return found


def key_of(interface: str) -> str:
    return keys().get(interface, "")


def names_kind(words: str, interface: str) -> bool:
    """Says whether the words are an interface or its key. The star of `*.replacement` stands for one cache or another."""
    key = key_of(interface)
    return words in (interface, key) or (key.startswith("*.") and words.endswith(key[1:]))


def choice_of(interface: str, words: str, name: str) -> str:
    """Returns what chooses a policy on the command line."""
    key = key_of(interface)
    if key.startswith("*."):
        key = words if words.endswith(key[1:]) and words != key else f"memory.l1{key[1:]}"
    return f"--set {key}={name}" if not key.startswith("(") else f"{key.strip('()')} {name}" if key.startswith("(--") else ""


def class_name(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


def begin(source: pathlib.Path, old: str, new: str) -> str:
    """Returns the text of a policy under a new name, with a first line that says what is left to do."""
    text = source.read_text()
    old_class = re.search(r"const Register<\w+, (\w+)> ", text)[1]
    first, rest = text.split("\n// SPDX", 1)
    what = re.sub(r"\(.*|:.*", "", first.split("\n")[0]).replace(f"`{old}`", f"`{new}`") if f"`{old}`" in first.split("\n")[0] else f"// Implements the policy `{new}`"
    rest = re.sub(rf"\b{old_class}\b", class_name(new), rest).replace(f'"{old}"', f'"{new}"')  # the name, and that of its statistics
    rest = re.sub(r'(kDoc\s*=\s*)(?:"(?:[^"\\]|\\.)*"\s*)+;', rf'\1"A copy of {old}, to be changed.";', rest)
    return f"{what}: a copy of `{old}`, to be changed.\n// SPDX{rest}"


def main() -> None:
    known = registrations()
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("interface", metavar="INTERFACE", help=f"one of {', '.join(sorted(known))}, or its key, such as core.issue")
    parser.add_argument("name", metavar="NAME", help="name of the new policy, in lower case: the value of the key")
    parser.add_argument("--like", metavar="POLICY", help="existing policy to copy (default: the shortest of its kind)")
    parser.add_argument("--plugin", metavar="FOLDER", type=pathlib.Path, help="write a project that builds a plugin into this new folder, and change nothing here")
    options = parser.parse_args()
    interface = next((one for one in known if names_kind(options.interface, one)), None)
    if interface is None:
        fail(f"no kind of policy '{options.interface}'", f"there are {', '.join(f'{one} ({key_of(one)})' for one in sorted(known))}")
    if not re.fullmatch(r"[a-z][a-z0-9_]*", options.name):
        fail(f"'{options.name}' is not a name of lower-case letters, digits and underscores")
    policies = known[interface]
    if options.name in policies:
        fail(f"{interface} has a policy '{options.name}' already: {policies[options.name].relative_to(ROOT)}")
    like = options.like or min(policies, key=lambda name: len(policies[name].read_text()))
    if like not in policies:
        fail(f"{interface} has no policy '{like}'", f"there are {', '.join(policies)}")
    text = begin(policies[like], like, options.name)
    if options.plugin:
        if options.plugin.exists():
            fail(f"{options.plugin} exists already")
        options.plugin.mkdir(parents=True)
        (options.plugin / f"{options.name}.cpp").write_text(text)
        (options.plugin / "CMakeLists.txt").write_text(f"cmake_minimum_required(VERSION 3.25)\nproject({options.name} LANGUAGES CXX)\n"
                                                       f"find_package(glint REQUIRED COMPONENTS plugin)\nglint_add_plugin({options.name} {options.name}.cpp)\n")
        print(f"wrote {options.plugin}\nbuild it, where PREFIX is that of cmake --install: cmake -S {options.plugin} -B {options.plugin}/build -DCMAKE_BUILD_TYPE=Release"
              f" -DCMAKE_PREFIX_PATH=PREFIX && cmake --build {options.plugin}/build\n"
              f"use it: glint --plugin {options.plugin}/build/{options.name}.so run WKND_PT {choice_of(interface, options.interface, options.name)}".rstrip())
        return
    file = policies[like].parent / f"{options.name}.cpp"
    file.write_text(text)
    # The table has each replacement policy once, with the L1.
    key = "memory.l1.replacement" if key_of(interface) == "*.replacement" else key_of(interface)
    if not key.startswith("("):
        rows = TABLE.read_text().splitlines()
        at = max(i for i, row in enumerate(rows) if row.startswith(f"{key},")) + 1
        TABLE.write_text("\n".join([*rows[:at], f"{key},{options.name},", *rows[at:]]) + "\n")
    log = CHANGELOG.read_text()
    line = f"- `{key} = \"{options.name}\"` is a new policy.\n"
    CHANGELOG.write_text(re.sub(r"### Added\n\n(?:[^-\n].*\n)?", lambda heading: heading[0] + line, log, count=1))  # behind a group's name
    print(f"wrote {file.relative_to(ROOT)}, a row in {TABLE.relative_to(ROOT)} and a line in CHANGELOG.md\n"
          f"build it: cmake --build --preset release; then tools/update_golden.py GLINT records its cycles and its keys")


if __name__ == "__main__":
    main()
