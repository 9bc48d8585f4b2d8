# Measures one small frame with each registered policy, for tests/cli/policies.csv.
# SPDX-License-Identifier: Apache-2.0
import csv
import hashlib
import io
import pathlib
import re
import subprocess
import tempfile

PATH = "tests/cli/policies.csv"
# One core with a small L1, so that a few warps compete for all of its parts.
FRAME = ["WKND_PT", "--config", "mobile", "--size", "24x16", "--spp", "1", "--set", "cores=1", "--set", "memory.l1.size=4096"]
# Lists keys that stand for several, and what else a key or one of its policies needs to have an effect.
KEYS = {"*.replacement": "memory.l1.replacement"}
TREELETS = ["bvh.layout=treelet_breadth_first"]
NEEDS = {"memory.dram.scheduler": ["memory.dram.model=banked"], "rt.child_order=octant": ["bvh.format=cwbvh"], "rt.order=two_stacks": TREELETS,
         "rt.pool=predicted": ["rt.entry=predictor"], "rt.pool=treelet_queues": TREELETS,
         "rt.prefetch=treelet": TREELETS, "rt.scheduler=omr": [*TREELETS, "rt.prefetch=treelet"], "rt.scheduler=pmr": [*TREELETS, "rt.prefetch=treelet"]}


def listed(glint) -> list[list[str]]:
    """Returns folder, key, name and doc of every policy, as `glint list policies` prints them."""
    lines = subprocess.run([glint, "list", "policies"], capture_output=True, text=True, check=True).stdout.splitlines()
    return [re.split(r" {2,}", line.strip(), maxsplit=3) for line in lines]


def policies(glint) -> list[tuple[str, str]]:
    """Returns key and name of every policy that a configuration can choose."""
    return [(KEYS.get(key, key), name) for _, key, name, _ in listed(glint) if not key.startswith("(")]


def measure(glint, key: str, name: str, folder: pathlib.Path) -> tuple[int, str]:
    """Returns the cycles of the frame with the policy, and a hash of its picture."""
    settings = [f"--set={setting}" for setting in [*NEEDS.get(key, []), *NEEDS.get(f"{key}={name}", []), f"{key}={name}"]]
    subprocess.run([glint, "run", *FRAME, *settings, "--out", folder], capture_output=True, text=True, check=True)
    cycles = next(row["value"] for row in csv.DictReader((folder / "stats.csv").read_text().splitlines()) if row["path"] == "gpu.cycles")
    return int(cycles), hashlib.sha256((folder / "image.png").read_bytes()).hexdigest()


def table(glint) -> str:
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["key", "name", "cycles"])
    with tempfile.TemporaryDirectory() as folder:
        for key, name in policies(glint):
            rows.writerow([key, name, measure(glint, key, name, pathlib.Path(folder) / "out")[0]])
    return out.getvalue()
