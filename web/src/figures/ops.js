// Draws the ops that were issued most and, for a single run, those that schedulers waited at. It needs a profile.
// SPDX-License-Identifier: Apache-2.0
import { percent } from "../format.js";
import { bars } from "../kinds/bars.js";
import { runColour } from "../theme.js";

const kShown = 12;
const kFields = { issues: ["issued", "green"], cycles: ["scheduler cycles", "orange"] };

export const info = {
  id: "ops", coloured: true,
  title: "Instructions by op",
  note: (runs) =>
    runs.filter((run) => run.data.profile).length > 1
      ? "Bars are shares of the warp instructions that were issued."
      : "Bars are shares of the warp instructions that were issued, and of scheduler cycles. A cycle is charged to the op that issued in it, or to the one whose warp was nearest to issue.",
};

export function make(runs) {
  const profiled = runs.filter((run) => run.data.profile);
  return profiled.length ? opShares(runs, profiled.length > 1 ? ["issues"] : ["issues", "cycles"]) : null;
}

// Returns bars of the ops with the largest shares. A single run has a colour for each field; several runs have a colour each, and show the first
// field.
export function opShares(runs, fields) {
  const profiled = runs.filter((run) => run.data.profile), one = profiled.length === 1;
  const ops = new Map(profiled.map((run) => [run, new Map(run.data.profile.ops.map((op) => [op.name, op]))]));
  const total = (run, field) => run.data.profile.ops.reduce((sum, op) => sum + op[field], 0);
  const share = (run, name, field) => (ops.get(run).get(name)?.[field] ?? 0) / total(run, field);
  const most = (name) => Math.max(...profiled.flatMap((run) => fields.map((field) => share(run, name, field))));
  const names = [...new Set(profiled.flatMap((run) => [...ops.get(run).keys()]))];
  const shown = names.sort((a, b) => most(b) - most(a)).slice(0, kShown);
  const values = (run, field) => shown.map((name) => share(run, name, field));
  const series = one
    ? fields.map((field) => ({ name: kFields[field][0], colour: kFields[field][1], values: values(profiled[0], field) }))
    : profiled.map((run) => ({ name: run.label, colour: runColour(run.index), values: values(run, fields[0]) }));
  return {
    ...bars({ rows: shown, series, format: (value) => percent(value), axis: (value) => percent(value, 0) }),
    columns: ["op", ...(one ? [] : ["run"]), "issues", "lanes", "scheduler cycles", "ended", "latency (cycles)"],
    rows: profiled.flatMap((run) => run.data.profile.ops.map((op) => [op.name, ...(one ? [] : [run.label]), op.issues, op.lanes, op.cycles, op.ended, op.latency])),
  };
}
