// Draws how long accesses and traces took, op by op. It needs a profile.
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { bars } from "../kinds/bars.js";
import { runColour } from "../theme.js";

const kShown = 12;

export const info = {
  id: "op-latency", coloured: true,
  title: "Latency by op",
  note: "Bars show mean cycles from issue to completion, of accesses that went to the L1 and of traces. The op with the largest sum comes first.",
};

export function make(runs) {
  const profiled = runs.filter((run) => run.data.profile);
  if (!profiled.length) return null;
  const op = (run, name) => run.data.profile.ops.find((one) => one.name === name);
  const names = [...new Set(profiled.flatMap((run) => run.data.profile.ops.filter((one) => one.ended > 0).map((one) => one.name)))];
  const weight = (name) => Math.max(...profiled.map((run) => op(run, name)?.latency ?? 0));
  const shown = names.sort((a, b) => weight(b) - weight(a)).slice(0, kShown);
  if (!shown.length) return null;
  const mean = (run, name) => (op(run, name)?.ended ? op(run, name).latency / op(run, name).ended : null);
  return bars({ rows: shown, series: profiled.map((run) => ({ name: run.label, colour: runColour(run.index), values: shown.map((name) => mean(run, name)) })), unit: "cycles", format: (value) => number(value === null ? null : Math.round(value)) });
}
