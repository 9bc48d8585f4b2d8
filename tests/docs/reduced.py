# Stands in for `glint` when the documentation's commands run: it runs the real `glint`, on smaller frames by the rule in workplace.py.
# SPDX-License-Identifier: Apache-2.0
"""usage: reduced.py GLINT ARGUMENT...; it writes what it changed to $GLINT_DOCS_LOG."""
import os
import sys

import workplace


def without(words, option):
    """Returns the words without an option and its value."""
    out, skip = [], False
    for word in words:
        if skip:
            skip = False
        elif word == option:
            skip = True
        elif not word.startswith(option + "="):
            out.append(word)
    return out


def is_scene(words):
    """Returns whether `glint run` names a scene or workload: something that is not a file, or a model. Programs have small letters."""
    return bool(words) and (("." not in words[0] and not words[0].islower()) or words[0].endswith((".obj", ".gltf", ".glb")))


def reduced(words):
    """Returns the arguments that are run instead."""
    command, rest = (words[0], words[1:]) if words else ("", [])
    if "--help" in rest:
        return words
    if command in ("run", "export") and is_scene(rest):
        # A sample needs a larger frame than this one, which is run whole instead.
        rest = [workplace.SLOW_SCENES.get(word, word) for word in without(rest, "--sample-pixels")]
    elif command == "bench":
        at = next((i for i, word in enumerate(rest) if word.startswith("-")), len(rest))
        names, options = rest[:at], without(rest[at:], "--sample-pixels")
        if len(names) != 1 or names[0].islower():
            names = os.environ["GLINT_DOCS_BENCH"].split()
        rest = [workplace.SLOW_SCENES.get(name, name) for name in names] + options
    elif command == "microbench":
        return words if "--only" in rest else [*words, *workplace.KERNEL_ONLY]
    elif command == "ablate":
        return words if "--plan" in rest else [*words, "--plan"]
    else:
        return words
    return [command, *without(without(rest, "--size"), "--spp"), "--size", workplace.SIZE, "--spp", workplace.SAMPLES]


def main():
    glint, words = sys.argv[1], sys.argv[2:]
    instead = reduced(words)
    with open(os.environ["GLINT_DOCS_LOG"], "a", encoding="utf-8") as log:
        log.write(f"{'reduced' if instead != words else 'as written'}: glint {' '.join(words)}" + (f"  ->  glint {' '.join(instead)}\n" if instead != words else "\n"))
    os.execv(glint, [glint, *instead])


if __name__ == "__main__":
    main()
