// Draws where the time of a miss goes, and how it is spread.
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { histogram } from "../kinds/histogram.js";
import { stacked } from "../kinds/stacked.js";
import { ratio } from "../model.js";
import { runColour } from "../theme.js";
import { runRows } from "./shared.js";

const kL1 = "gpu.memory.core[*].l1";
const kStages = [
  ["l1_queue", "leaves the L1", "yellow"], ["request", "network there", "blue"], ["l2_queue", "waits for the L2", "pink"], ["l2_service", "L2", "green"],
  ["dram_way", "way to DRAM", "grey"], ["dram_queue", "DRAM queue, rows", "red"], ["dram_service", "DRAM data", "orange"], ["reply", "network back, fill", "sky"],
];

export const stages = {
  info: { id: "miss-stages", wide: true, title: "Latency of an L1 miss by stage", note: "The bar has the mean cycles of a read that did not hit, under the load of the run. The stages add up exactly." },
  make: (runs) => {
    const mean = runs.map((run) => ratio(run.sum(`${kL1}.miss_cycles`), run.sum(`${kL1}.timed_misses`)));
    if (mean.some((value) => value === null)) return null;
    return stacked({
      rows: runRows(runs),
      parts: kStages.map(([key, name, colour]) => ({ name, colour, values: runs.map((run) => run.sum(`${kL1}.miss_stages::${key}`)) })),
      unit: "cycles",
      scale: mean,
      scaleName: "cycles / miss",
      scaleFormat: number,
    });
  },
};

export const spread = {
  info: { id: "miss-latency", coloured: true, title: "Latency of L1 misses", note: (runs) => (runs.length > 1 ? "Values are shares of the reads that did not hit." : "Values are shares of the reads that each level answered.") },
  make: (runs) => {
    const one = runs.length === 1;
    const series = one
      ? [["L2 answered", "l2_latency", "green"], ["DRAM answered", "dram_latency", "orange"]].map(([name, stat, colour]) => ({ name, colour, counts: runs[0].histogram(`${kL1}.${stat}`) }))
      : runs.map((run) => ({ name: run.label, colour: runColour(run.index), counts: run.histogram(`${kL1}.miss_latency`) }));
    const known = series.filter((each) => each.counts.length);
    return known.length ? histogram({ series: known, bins: runs[0].bins(`${kL1}.miss_latency`), unit: "cycles", what: "reads" }) : null;
  },
};
