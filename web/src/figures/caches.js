// Draws reads of the L1s by who asked (LumiBench, Figure 11), and reads of the L2.
// SPDX-License-Identifier: Apache-2.0
import { percent } from "../format.js";
import { stacked } from "../kinds/stacked.js";
import { rowsOf } from "./shared.js";

const kParts = [["hit", "hits", "green"], ["pending", "already on the way", "sky"], ["miss", "miss, held before", "orange"], ["cold", "cold miss", "red"]];
const kL1 = [
  { name: "RT unit", is: (name) => name.startsWith("rt_") },
  { name: "shaders", is: (name) => name.startsWith("shader_") },
  { name: "instructions, constants", is: (name) => name === "instruction" || name === "constant" },
];

function reads(runs, cache, kinds) {
  const at = (what) => `gpu.memory.${cache}.${what}`;
  const counts = (run, is) => {
    const cold = run.part(at("cold_misses"), is);
    return { hit: run.part(at("hits"), is), pending: run.part(at("pending_hits"), is), miss: run.part(at("misses"), is) - cold, cold, all: run.part(at("reads"), is) };
  };
  const rows = rowsOf(runs, kinds).filter(({ run, kind }) => counts(run, kind.is).all > 0);
  if (!rows.length) return null;
  const values = rows.map(({ run, kind }) => counts(run, kind.is));
  return stacked({
    rows: rows.map((row) => row.label),
    parts: kParts.map(([key, name, colour]) => ({ name, colour, values: values.map((one) => one[key]) })),
    unit: "reads",
    whole: values.map((one) => one.all),
    scale: values.map((one, i) => one.all / rows[i].run.part(at("reads"), () => true)),
    scaleFormat: (value) => percent(value, 0),
  });
}

export const l1 = {
  info: { id: "l1", title: "L1 reads", note: "A bar is as long as its share of all reads of the L1s, and its labels are shares of the bar." },
  make: (runs) => reads(runs, "core[*].l1", kL1),
};
export const l2 = {
  info: { id: "l2", title: "L2 reads", note: "The bars tell apart who had asked the L1s for what these ask of the L2." },
  make: (runs) => reads(runs, "partition[*].l2", kL1),
};
