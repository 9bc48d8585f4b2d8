# Patterns of dotted paths, with the meaning they have in docs/metrics.md.
# SPDX-License-Identifier: Apache-2.0
"""`*` stands for any characters but '.'; brackets are themselves: `gpu.core[*].l1.*` is what it looks like."""
import difflib
import functools
import re
from typing import Iterable

# Beginnings of paths that stand for those of all instances (as in formulas of docs/metrics.md).
UNITS = {
    "core.": "gpu.core[*].",
    "rt.": "gpu.rt_unit[*].rt.",
    "l1.": "gpu.memory.core[*].l1.",
    "l2.": "gpu.memory.partition[*].l2*.",
    "dram.": "gpu.memory.partition[*].dram.",
}


def whole(pattern: str) -> str:
    """The pattern with `core.`, `rt.`, `l1.`, `l2.` or `dram.` at its beginning written out."""
    for unit, prefix in UNITS.items():
        if pattern.startswith(unit):
            return prefix + pattern[len(unit):]
    return pattern


@functools.lru_cache(maxsize=4096)
def compiled(pattern: str) -> re.Pattern[str]:
    """The regular expression that matches whole paths of the pattern."""
    parts = re.escape(whole(pattern)).split(re.escape("*"))
    return re.compile(r"[^.]*".join(parts))


def near(name: str, known: Iterable[str]) -> str:
    """', did you mean ...?' with up to three names that are like `name`, or nothing."""
    found = difflib.get_close_matches(name, list(known), n=3, cutoff=0.6)
    return ", did you mean " + " or ".join(f"'{one}'" for one in found) + "?" if found else ""
