// Draws what the cycles of the RT units were spent on.
// SPDX-License-Identifier: Apache-2.0
import { stacked } from "../kinds/stacked.js";
import { runRows } from "./shared.js";

const kParts = [
  ["node_request", "sends a request", "green"], ["test_busy", "waits for a test unit", "blue"], ["test_latency", "tests in flight", "sky"],
  ["waiting_memory", "waits for memory", "orange"], ["l1_refused", "refused by the L1", "red"], ["mshr_full", "no entry free", "pink"],
  ["prefetch", "sends a prefetch", "grey"], ["handover", "hand-over", "yellow"], ["idle", "idle", "pale"],
];

export const info = { id: "rt-cycles", title: "Cycles of the RT units", note: "The bar has the cycles of all units from the launch to its end." };

export function make(runs) {
  if (!runs.some((run) => run.sum("gpu.rt_unit[*].rt.rays"))) return null;
  return stacked({ rows: runRows(runs), parts: kParts.map(([key, name, colour]) => ({ name, colour, values: runs.map((run) => run.sum(`gpu.rt_unit[*].rt.cycles::${key}`) ?? 0) })), unit: "cycles" });
}
