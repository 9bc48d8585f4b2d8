#!/usr/bin/env python3
"""Turns times of a card into rows that `glint microbench --compare` reads.

usage: rows.py FOLDER TIMES.csv MHZ

FOLDER is that of `glint microbench --frames`, TIMES.csv is what rt_frames wrote of its frames, and MHZ is the clock of the card's cores during the runs.
"""
# SPDX-License-Identifier: Apache-2.0
import csv
import json
import pathlib
import sys


def rows(folder, times, mhz):
    """Yields group, name, parameter, value and unit of each probe."""
    with open(times) as file:
        nanoseconds = {row["frame"]: float(row["median_ns"]) for row in csv.DictReader(file)}
    for probe in json.loads((pathlib.Path(folder) / "probes.json").read_text()):
        missing = [probe[end] for end in ("few", "many") if probe[end] not in nanoseconds]
        if missing:
            sys.exit(f"error: {times} has no row of the frame {missing[0]}")
        cycles = (nanoseconds[probe["many"]] - nanoseconds[probe["few"]]) * mhz / 1000
        if cycles <= 0:
            print(f"warning: '{probe['name']}' {probe['param']}: more rays took no longer, so the row is left out; try --runs 101", file=sys.stderr)
            continue
        value = cycles / probe["amount"] if probe["unit"] == "cycle" else probe["amount"] / cycles
        yield probe["group"], probe["name"], probe["param"], f"{value:.6g}", probe["unit"]


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["group", "name", "param", "value", "unit"])
    out.writerows(rows(sys.argv[1], sys.argv[2], float(sys.argv[3])))


if __name__ == "__main__":
    main()
