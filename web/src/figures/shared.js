// Holds what several figures need: instruction classes, rows for runs, single values side by side.
// SPDX-License-Identifier: Apache-2.0
import { bars } from "../kinds/bars.js";
import { runColour } from "../theme.js";

export const kClasses = [
  { key: "alu", name: "ALU", colour: "blue" },
  { key: "sfu", name: "SFU", colour: "sky" },
  { key: "mem", name: "Memory", colour: "orange" },
  { key: "tex", name: "Texture", colour: "yellow" },
  { key: "ctrl", name: "Control", colour: "grey" },
  { key: "rt", name: "Ray tracing", colour: "red" },
];

// Returns one row for each run. A single run needs no name.
export const runRows = (runs) => (runs.length > 1 ? runs.map((run) => run.label) : [""]);

// Returns rows of every run and kind as [{label, run, kind}]. `kinds` are {name, ...}.
export function rowsOf(runs, kinds) {
  return kinds.flatMap((kind) => runs.map((run) => ({ run, kind, label: runs.length > 1 ? `${run.label}, ${kind.name}` : kind.name })));
}

// Draws a list of {name, value(run), colour}. Few runs become bars of their own colour beside each other; many become rows.
export function measures(runs, list, options) {
  const known = list.filter((one) => runs.some((run) => one.value(run) !== null));
  if (!known.length) return null;
  if (runs.length <= 4)
    return bars({ rows: known.map((one) => one.name), series: runs.map((run) => ({ name: run.label, colour: runColour(run.index), values: known.map((one) => one.value(run)) })), ...options });
  return bars({ rows: runs.map((run) => run.label), series: known.map((one) => ({ name: one.name, colour: one.colour, values: runs.map(one.value) })), ...options });
}
