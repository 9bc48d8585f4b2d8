// Draws geometry and structures of scenes beside each other (LumiBench, Figure 7). It needs runs that differ in them.
// SPDX-License-Identifier: Apache-2.0
import { bytes, number, percent } from "../format.js";
import { bars } from "../kinds/bars.js";
import { runColour } from "../theme.js";

const kMeasures = [
  ["triangles", (run) => run.metric("triangles"), number],
  ["procedurals", (run) => run.metric("procedurals"), number],
  ["bottom levels", (run) => run.metric("blas_count"), number],
  ["instances", (run) => run.metric("instances"), number],
  ["depth", (run) => run.metric("bvh_depth"), number],
  ["size", (run) => run.metric("bvh_bytes"), bytes],
];

export const info = {
  id: "geometry", coloured: true, wide: true,
  title: "Geometry and structures",
  note: "Each row shows shares of its largest value. Depth is that of the deepest path through both levels, and size that of all structures.",
};

export function make(runs) {
  const built = runs.filter((run) => run.facts.structures);
  const differ = ([, value]) => new Set(built.map(value)).size > 1;
  if (!kMeasures.some(differ)) return null;
  const shown = kMeasures.filter(([, value]) => built.some((run) => value(run) > 0)), cycles = ["cycles", (run) => run.cycles, number];
  const rows = [...shown, cycles].map(([name, value, text]) => ({ name, values: built.map(value), text, most: Math.max(...built.map(value)) }));
  const series = built.map((run, k) => ({ name: run.label, colour: runColour(run.index), values: rows.map((row) => row.values[k] / row.most), labels: rows.map((row) => row.text(row.values[k])) }));
  return {
    ...bars({ rows: rows.map((row) => row.name), series, max: 1, axis: (value) => percent(value, 0) }),
    columns: ["", ...built.map((run) => run.label)],
    rows: rows.map((row) => [row.name === "size" ? "size (bytes)" : row.name, ...row.values]),
  };
}
