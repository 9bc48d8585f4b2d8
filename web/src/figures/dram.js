// Draws the use of the DRAM's data bus (LumiBench, Figure 12), and what its clocks were spent on.
// SPDX-License-Identifier: Apache-2.0
import { percent } from "../format.js";
import { stacked } from "../kinds/stacked.js";
import { measures, runRows } from "./shared.js";

const kParts = [["data", "data", "green"], ["column_wait", "waits for a column", "sky"], ["row_wait", "waits for a row", "orange"], ["turnaround", "turns the bus", "pink"], ["refresh", "refresh", "red"], ["idle", "idle", "pale"]];

export const use = {
  info: { id: "dram", title: "DRAM utilisation and efficiency", note: "Utilisation is the share of all clocks that move data, and efficiency their share of the clocks in which the channel had work. Row locality is the share of requests that found their row open." },
  make: (runs) =>
    measures(
      runs,
      [
        { name: "utilisation", colour: "blue", value: (run) => run.metric("dram_util") },
        { name: "efficiency", colour: "orange", value: (run) => run.metric("dram_eff") },
        { name: "row locality", colour: "green", value: (run) => run.metric("row_locality") },
      ],
      { format: (value) => percent(value), axis: (value) => percent(value, 0), max: 1 },
    ),
};

export const clocks = {
  info: { id: "dram-clocks", wide: true, title: "Clocks of the DRAM channels", note: "The bar has the clocks of all channels from the launch to its end." },
  make: (runs) =>
    runs.some((run) => run.sum("gpu.memory.partition[*].dram.clocks"))
      ? stacked({ rows: runRows(runs), parts: kParts.map(([key, name, colour]) => ({ name, colour, values: runs.map((run) => run.sum(`gpu.memory.partition[*].dram.use::${key}`) ?? 0) })), unit: "clocks" })
      : null,
};
