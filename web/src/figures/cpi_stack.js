// Draws what the cycles of all schedulers were spent on, for each instruction.
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { stacked } from "../kinds/stacked.js";
import { runRows } from "./shared.js";

const kSlots = "gpu.core[*].issue_slots";
// Groups the reasons of core/stall.h that belong together.
export const kGroups = [
  { name: "issued", colour: "green", of: ["issued"] },
  { name: "pipe busy", colour: "blue", of: ["math_pipe_throttle", "register_banks", "lsu_throttle", "tex_throttle"] },
  { name: "result of fixed latency", colour: "sky", of: ["raw_fixed", "raw_sfu", "const", "branch", "operand_read"] },
  { name: "memory", colour: "orange", of: ["long_scoreboard", "local_memory", "shared_memory", "texture", "call", "membar"] },
  { name: "in the RT unit", colour: "pink", of: ["rt_wait"] },
  { name: "RT unit full", colour: "red", of: ["rt_full"] },
  { name: "instruction fetch, barrier", colour: "yellow", of: ["no_instruction", "barrier"] },
  { name: "launch, drain", colour: "grey", of: ["dispatch", "drain"] },
  { name: "no warp", colour: "pale", of: ["no_warp"] },
];

export const info = {
  id: "cpi-stack",
  wide: true,
  title: "Scheduler cycles for each warp instruction",
  note: "Every cycle of every scheduler has one reason. A bar is as long as cycles × schedulers / instructions; its green part is the one cycle that issues.",
};

export function make(runs) {
  if (!runs.every((run) => run.sum("gpu.core[*].instructions"))) return null;
  const reasons = Object.keys(runs[0].parts(kSlots));
  const chart = stacked({
    rows: runRows(runs),
    parts: kGroups.map(({ name, colour, of }) => ({ name, colour, values: runs.map((run) => run.part(kSlots, (reason) => of.includes(reason))) })),
    unit: "scheduler cycles",
    whole: runs.map((run) => run.part(kSlots, () => true)),
    scale: runs.map((run) => run.part(kSlots, () => true) / run.sum("gpu.core[*].instructions")),
    scaleName: "scheduler cycles / warp instruction",
    scaleFormat: number,
  });
  return { ...chart, columns: ["reason", ...runs.map((run) => run.label)], rows: reasons.map((reason) => [reason, ...runs.map((run) => run.sum(`${kSlots}::${reason}`))]) };
}
