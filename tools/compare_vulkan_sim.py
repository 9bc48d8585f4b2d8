#!/usr/bin/python3
"""Runs Glint under the preset vulkan-sim-desktop on the workloads of Vulkan-Sim's own logs, and prints both results side by side.

Usage: compare_vulkan_sim.py GLINT LOGS ASSETS [--only NAME] [--set KEY=VALUE ...] [--config NAME]
  LOGS    is a folder with logs of Vulkan-Sim named SCENE_SHADER_WxH_..., as .log or .log.xz
  ASSETS  is a folder with the original scene data, as `glint run --assets` takes it
The output is a table in Markdown. Rows beyond the bounds (rays 1 %, nodes per ray 5 %, RT memory accesses 10 %, cycles 20 %)
are bold. The exit status is 2 when there is nothing to compare.
"""
# SPDX-License-Identifier: Apache-2.0
import argparse
import json
import lzma
import re
import subprocess
import sys
import tempfile
from pathlib import Path

BOUNDS = {"rays": 1, "nodes per ray": 5, "RT memory accesses": 10, "cycles": 20}


def number(text, key):
    found = re.search(rf"^{re.escape(key)}\s*=\s*([-\d.]+)", text, re.M)
    return float(found.group(1)) if found else None


def read_log(path):
    text = (lzma.open(path, "rt") if path.suffix == ".xz" else open(path)).read()
    reads = re.search(r"RT_Total_core_cache_stats_breakdown.*?rt_read_miss_rate = ([\d.]+)", text, re.S)
    l1 = number(text, "\tL1D_total_cache_accesses")
    return {
        "rays": number(text, "rt_n_total_rays"),
        "nodes per ray": number(text, "rt_avg_nodes_per_ray"),
        "most nodes of a ray": number(text, "rt_max_nodes_per_ray"),
        "RT memory accesses": number(text, "gpgpu_n_rt_access_insn"),
        "RT writes": number(text, "rt_writes"),
        "RT misses in the L1, %": 100 * float(reads.group(1)) if reads else None,
        "RT warp latency": number(text, "rt_avg_warp_latency"),
        "RT SIMT efficiency, %": 100 * number(text, "rt_avg_efficiency"),
        "L1 accesses": l1,
        "warp instructions": number(text, "gpgpu_n_tot_w_icount"),
        "cycles": number(text, "gpu_sim_cycle"),
    }


def total(stats, parent, path):
    """Returns the sum of the statistic at `path` over all groups of `stats` whose name begins with `parent`."""
    out = 0
    for name, group in stats.items():
        if not name.startswith(parent):
            continue
        for part in path.split("/"):
            group = group[part]
        value = group["value"]
        if isinstance(value, dict) and "sum" in value:
            value = value["sum"]
        out += sum(value.values()) if isinstance(value, dict) else value
    return out


def of_class(stats, statistic, is_wanted):
    return sum(count for name, group in stats["memory"].items() if name.startswith("core")
               for traffic, count in group["l1"][statistic]["value"].items() if is_wanted(traffic))


def read_run(folder):
    stats = json.loads((folder / "stats.json").read_text())["gpu"]
    rt = lambda name: total(stats, "rt_unit", "rt/" + name)
    is_rt = lambda traffic: traffic.startswith("rt_")
    rays, nodes = rt("rays"), rt("nodes")
    reads, hits = of_class(stats, "reads", is_rt), of_class(stats, "hits", is_rt)
    return {
        "rays": rays,
        "nodes per ray": nodes / rays,
        "most nodes of a ray": max(group["rt"]["max_ray_nodes"]["value"] for name, group in stats.items() if name.startswith("rt_unit")),
        "RT memory accesses": nodes + rt("headers") + rt("descriptors"),
        "RT writes": rt("hit_writes"),
        "RT misses in the L1, %": 100 * (1 - hits / reads),
        "RT warp latency": rt("warp_latency_sum") / rt("warps"),
        "RT SIMT efficiency, %": 100 * rt("ray_cycles") / rt("lane_slots"),
        "L1 accesses": of_class(stats, "reads", lambda t: True) + of_class(stats, "writes", lambda t: True),
        "warp instructions": total(stats, "core", "instructions"),
        "cycles": stats["cycles"]["value"],
    }


def run(glint, scene, shader, size, options, folder):
    command = [glint, "run", scene, "--shader", shader, "--size", size, "--spp", "1", "--config", options.config,
               "--assets", options.assets, "--out", str(folder)]
    for setting in options.set:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return read_run(folder)


def row(name, theirs, ours):
    if theirs is None or ours is None:
        return None
    off = 100 * (ours / theirs - 1) if theirs else float("inf")
    text = f"{off:+.1f} %"
    if name in BOUNDS and abs(off) > BOUNDS[name]:
        text = f"**{text}**"
    form = "{:,.0f}" if max(theirs, ours) >= 1000 or float(theirs).is_integer() else "{:.2f}"
    return f"| {name} | {form.format(theirs)} | {form.format(ours)} | {text} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint")
    parser.add_argument("logs", type=Path)
    parser.add_argument("assets")
    parser.add_argument("--only", default="")
    parser.add_argument("--config", default="vulkan-sim-desktop")
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    logs = [(p, m) for p in sorted(options.logs.glob("*.log*"))
            if (m := re.match(r"([A-Z]+)_(PT|SH|AO)_(\d+x\d+)_1spp", p.name)) and options.only in p.name]
    if not logs or not Path(options.assets).is_dir():
        print(f"SKIPPED: no logs in {options.logs}, or no scenes in {options.assets}: nothing is compared.", file=sys.stderr)
        return 2
    for path, match in logs:
        scene, shader, size = match.groups()
        with tempfile.TemporaryDirectory() as folder:
            ours = run(options.glint, scene, shader.lower(), size, options, Path(folder) / "run")
        theirs = read_log(path)
        print(f"\n{scene} {shader} {size}\n\n| | Vulkan-Sim | Glint | |\n|---|---|---|---|")
        for name in theirs:
            if line := row(name, theirs[name], ours[name]):
                print(line)
        sys.stdout.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
