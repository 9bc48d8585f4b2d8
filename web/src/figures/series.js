// Draws the run over time (LumiBench, Figure 6). It needs `--sample`.
// SPDX-License-Identifier: Apache-2.0
import { number, percent } from "../format.js";
import { lines } from "../kinds/lines.js";
import { runColour } from "../theme.js";

const kPanels = [
  { column: "ipc", name: "IPC (warp instructions per cycle)", format: number },
  { column: "rt_warps", name: "Warps in the RT units", format: number },
  { column: "l1d_miss_rate", name: "L1 reads that did not hit", format: (value) => percent(value, 0) },
  { column: "l2_miss_rate", name: "L2 reads that did not hit", format: (value) => percent(value, 0) },
  { column: "dram_use", name: "DRAM clocks with data", format: (value) => percent(value, 0) },
];

export const info = { id: "series", coloured: true, wide: true, title: "The run over time", note: "Each point is the mean of its interval." };

export function make(runs) {
  const sampled = runs.filter((run) => run.data.series?.cycle?.length);
  const panels = kPanels.filter(({ column }) => sampled.length && sampled.every((run) => run.data.series[column]) && sampled.some((run) => run.data.series[column].some((value) => value > 0)));
  if (!panels.length) return null;
  return lines({
    panels: panels.map(({ column, ...panel }) => ({ ...panel, series: sampled.map((run) => ({ name: run.label, colour: runColour(run.index), x: run.data.series.cycle, y: run.data.series[column] })) })),
    unit: "cycle",
  });
}
