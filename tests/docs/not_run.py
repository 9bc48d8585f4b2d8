# Checks commands of the documentation that would build or install, without running them.
# SPDX-License-Identifier: Apache-2.0
"""usage: not_run.py NAME ROOT GLINT ARGUMENT...; the exit status is 1 when the command could not work."""
import json
import os
import pathlib
import subprocess
import sys


def check(name, root, glint, words):
    """Returns what is wrong with the command, or None."""
    if name in ("demo", "check"):
        done = subprocess.run([root / name, "--help"], capture_output=True, text=True, check=False)
        return None if done.returncode == 0 and "usage" in done.stdout else f"./{name} --help fails"
    if name in ("sudo", "apt-get"):
        return None if "install" in words or "update" in words else "the command neither installs nor updates"
    presets = json.loads((root / "CMakePresets.json").read_text())
    if "--preset" in words:
        wanted = words[words.index("--preset") + 1]
        kind = "buildPresets" if "--build" in words else "testPresets" if name == "ctest" else "workflowPresets" if "--workflow" in words else "configurePresets"
        known = [preset["name"] for preset in presets[kind]]
        if wanted not in known:
            return f"there is no preset {wanted} among {known}"
    defined = [word[2:].split("=")[0] for word in words if word.startswith("-D") and "GLINT_" in word]
    unknown = [option for option in defined if f"option({option} " not in (root / "CMakeLists.txt").read_text()]
    if unknown:
        return f"CMakeLists.txt has no option {unknown}"
    return targets(glint, words) if name == "ninja" or "--target" in words else None


def targets(glint, words):
    """Returns a message about targets that the build does not have, or None. It checks nothing when `glint` is not in a build folder."""
    build = glint.parents[2]
    if not (build / "build.ninja").exists():
        return None
    named = words[words.index("--target") + 1:] if "--target" in words else words[words.index("-C") + 2:] if "-C" in words else words
    known = subprocess.run(["/usr/bin/ninja", "-C", build, "-t", "targets", "all"], capture_output=True, text=True, check=False).stdout
    missing = [word for word in named if not word.startswith("-") and f"\n{word}: " not in known]
    return f"the build has no target {missing}" if missing and known else None


def main():
    name, root, glint, words = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[4:]
    wrong = check(name, root, glint, words)
    with open(os.environ["GLINT_DOCS_LOG"], "a", encoding="utf-8") as log:
        log.write(f"NOT RUN, checked: {name} {' '.join(words)}\n")
    if wrong:
        sys.exit(f"{name} {' '.join(words)}: {wrong}")


if __name__ == "__main__":
    main()
