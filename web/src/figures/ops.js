// Figure: the ops that were issued most, and those that schedulers waited at. Needs a profile.
// SPDX-License-Identifier: Apache-2.0
import { percent } from "../format.js";
import { bars } from "../kinds/bars.js";
import { runColour } from "../theme.js";

const kShown = 12;

export const info = {
  id: "ops", coloured: true,
  title: "Instructions by op",
  note: (runs) =>
    runs.filter((run) => run.data.profile).length > 1
      ? "Share of the scheduler cycles charged to the op: it issued, or its warp waited nearest to issue."
      : "Share of the warp instructions issued, and of the scheduler cycles charged to the op: it issued, or its warp waited nearest to issue.",
};

function ops(run) {
  return new Map((run.data.profile?.ops ?? []).map((op) => [op.name, op]));
}
const total = (run, field) => run.data.profile.ops.reduce((sum, op) => sum + op[field], 0);

export function make(runs) {
  const profiled = runs.filter((run) => run.data.profile);
  if (!profiled.length) return null;
  const share = (run, name, field) => (ops(run).get(name)?.[field] ?? 0) / total(run, field);
  const names = [...new Set(profiled.flatMap((run) => [...ops(run).keys()]))];
  const most = (name) => Math.max(...profiled.map((run) => Math.max(share(run, name, "issues"), share(run, name, "cycles"))));
  const shown = names.sort((a, b) => most(b) - most(a)).slice(0, kShown);
  const one = profiled.length === 1;
  const series = one
    ? [
        { name: "issued", colour: "green", values: shown.map((name) => share(profiled[0], name, "issues")) },
        { name: "scheduler cycles", colour: "orange", values: shown.map((name) => share(profiled[0], name, "cycles")) },
      ]
    : profiled.map((run) => ({ name: run.label, colour: runColour(run.index), values: shown.map((name) => share(run, name, "cycles")) }));
  const chart = bars({ rows: shown, series, format: (value) => percent(value), axis: (value) => percent(value, 0) });
  return {
    ...chart,
    columns: ["op", ...(one ? [] : ["run"]), "issues", "lanes", "scheduler cycles", "ended", "latency (cycles)"],
    rows: profiled.flatMap((run) => run.data.profile.ops.map((op) => [op.name, ...(one ? [] : [run.label]), op.issues, op.lanes, op.cycles, op.ended, op.latency])),
  };
}
