// Draws what the RT units read (LumiBench, Figure 13).
// SPDX-License-Identifier: Apache-2.0
import { stacked } from "../kinds/stacked.js";
import { runRows } from "./shared.js";

const kParts = [["rt_node", "internal nodes", "blue"], ["rt_instance", "instances", "orange"], ["rt_triangle", "triangles", "green"], ["rt_procedural", "procedurals", "pink"], ["rt_table", "candidate tables", "yellow"], ["rt_stack", "stacks", "grey"], ["rt_prefetch", "prefetches", "sky"]];

export const info = { id: "fetch-mix", title: "What the RT units fetch", note: "The bar has the read requests that the L1 took, by what they read." };

export function make(runs) {
  if (!runs.some((run) => run.part("gpu.memory.core[*].l1.reads", (name) => name.startsWith("rt_")))) return null;
  return stacked({ rows: runRows(runs), parts: kParts.map(([key, name, colour]) => ({ name, colour, values: runs.map((run) => run.sum(`gpu.memory.core[*].l1.reads::${key}`) ?? 0) })), unit: "requests" });
}
