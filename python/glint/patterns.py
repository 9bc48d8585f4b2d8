# Implements patterns of dotted paths, with the meaning they have in docs/metrics.md.
# SPDX-License-Identifier: Apache-2.0
"""In a pattern, `*` stands for any characters except '.', and brackets stand for themselves, as in `gpu.core[*].l1.*`."""
import functools
import re
from typing import Iterable

# Each beginning of a path stands for the paths of all instances, as in the formulas of docs/metrics.md.
UNITS = {
    "core.": "gpu.core[*].",
    "rt.": "gpu.rt_unit[*].rt.",
    "l1.": "gpu.memory.core[*].l1.",
    "l2.": "gpu.memory.partition[*].l2*.",
    "dram.": "gpu.memory.partition[*].dram.",
}


def whole(pattern: str) -> str:
    """Returns the pattern with `core.`, `rt.`, `l1.`, `l2.` or `dram.` at its beginning replaced by the full path."""
    for unit, prefix in UNITS.items():
        if pattern.startswith(unit):
            return prefix + pattern[len(unit):]
    return pattern


@functools.lru_cache(maxsize=4096)
def compiled(pattern: str) -> re.Pattern[str]:
    """Returns the regular expression that matches whole paths of the pattern."""
    parts = re.escape(whole(pattern)).split(re.escape("*"))
    return re.compile(r"[^.]*".join(parts))


def near(name: str, known: Iterable[str]) -> str:
    """Returns ', did you mean ...?' with up to three names that are similar to `name`, or an empty text."""
    import difflib  # which only an error needs
    found = difflib.get_close_matches(name, list(known), n=3, cutoff=0.6)
    return ", did you mean " + " or ".join(f"'{one}'" for one in found) + "?" if found else ""
