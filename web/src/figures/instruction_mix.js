// Draws instructions by class, counted and weighed by their latency (LumiBench, Figure 8).
// SPDX-License-Identifier: Apache-2.0
import { stacked } from "../kinds/stacked.js";
import { kClasses, rowsOf } from "./shared.js";

const kMeasures = [
  { name: "by count", path: "gpu.core[*].instructions_by_class" },
  { name: "by latency", path: "gpu.core[*].latency_by_class" },
];

export const info = {
  id: "instruction-mix",
  wide: true,
  title: "Instruction mix",
  note: "Bars show, by class, how many warp instructions were issued, and the sum of their cycles from issue to completion. Few instructions may hold most of the latency.",
};

export function make(runs) {
  const rows = rowsOf(runs, kMeasures);
  if (!runs[0].sum("gpu.core[*].instructions")) return null;
  return stacked({
    rows: rows.map((row) => row.label),
    parts: kClasses.map(({ key, name, colour }) => ({ name, colour, values: rows.map(({ run, kind }) => run.sum(`${kind.path}::${key}`)) })),
    unit: "instructions or cycles",
  });
}
