// Shows how near each resource came to what it can do at best ("speed of light").
// SPDX-License-Identifier: Apache-2.0
import { csv, download, h } from "../dom.js";
import { percent } from "../format.js";
import { ratio } from "../model.js";
import { runColour } from "../theme.js";

const kSectorBytes = 32;
const kMaxBars = 4; // with more runs, they are rows of a table

function starts(run, tests, unit) {
  const cycles = run.sum("gpu.rt_unit[*].rt.unit_cycles");
  return cycles ? (tests * run.config(`rt.${unit}.interval`)) / run.config(`rt.${unit}.units`) / cycles : null;
}
function bandwidth(run, bytes, ...peaks) {
  const known = peaks.map((peak) => run.facts.memory_peaks?.[peak]).filter(Boolean);
  if (run.facts.sample?.scale > 1) return null; // A part of the machine ran, and the peaks are those of all of it.
  return known.length && bytes !== null ? bytes / run.secondsOf(run.sum("gpu.cycles")) / Math.min(...known) : null;
}
const fetched = (run) => kSectorBytes * run.part("gpu.memory.core[*].l1.sectors_fetched", () => true);

const kBounds = [
  ["Issue slots", "an instruction a scheduler and cycle", (run) => ratio(run.sum("gpu.core[*].instructions"), run.part("gpu.core[*].issue_slots", () => true))],
  ["RT unit: requests", "that its port to the L1 takes", (run) => ratio(run.sum("gpu.rt_unit[*].rt.requests"), run.sum("gpu.rt_unit[*].rt.unit_cycles") * run.config("rt.requests_per_cycle"))],
  ["RT unit: box tests", "nodes that its box units start", (run) => starts(run, run.sum("gpu.rt_unit[*].rt.internal_nodes") + run.sum("gpu.rt_unit[*].rt.procedural_leaves"), "box")],
  ["RT unit: triangle tests", "that its triangle units start", (run) => starts(run, run.sum("gpu.rt_unit[*].rt.triangle_tests"), "triangle")],
  ["L1 data", "sectors that cores and RT units ask for, of whole lines a port", (run) => bandwidth(run, kSectorBytes * (run.sum("gpu.core[*].sectors") + run.sum("gpu.rt_unit[*].rt.sectors")), "l1_bytes_per_second")],
  ["L2 to L1", "sectors fetched, of what L2 and network carry", (run) => bandwidth(run, fetched(run), "network_bytes_per_second", "l2_bytes_per_second")],
  ["DRAM", "clocks with data", (run) => run.metric("dram_util") ?? ratio(run.sum("gpu.memory.partition[*].dram.busy_clocks"), run.sum("gpu.memory.partition[*].dram.clocks"))],
];

export function bounds(runs) {
  const rows = kBounds.map(([name, doc, value]) => ({ name, doc, values: runs.map(value) })).filter((row) => row.values.some((value) => value > 0));
  const save = () => download("bounds.csv", "text/csv", csv(["of its most", ...runs.map((run) => run.label)], rows.map((row) => [row.name, ...row.values])));
  return [runs.length > kMaxBars ? table(runs, rows) : barsOf(runs, rows), h("figcaption", {}, h("button", { type: "button", onclick: save }, "CSV"))];
}

function barsOf(runs, rows) {
  const most = Math.max(...rows.flatMap((row) => row.values));
  const bar = (value, run) =>
    h("div", { class: "bar" }, h("span", { class: "track" }, h("span", { class: runs.length === 1 && value === most ? "fill most" : "fill", style: `width:${Math.min(100, 100 * (value ?? 0)).toFixed(2)}%;${runs.length > 1 ? `background:var(--${runColour(run.index)})` : ""}` })), h("span", { class: "n", "data-value": value }, percent(value)));
  return h("div", { class: "bounds" }, rows.map((row) => h("div", { class: "bound" }, h("div", { class: "what" }, h("b", {}, row.name), h("small", {}, row.doc)), h("div", { class: "bars" }, runs.map((run, i) => bar(row.values[i], run))))));
}

// Makes a row for each run. A cell is darker the nearer it is to the limit.
function table(runs, rows) {
  const cell = (value) => h("td", { class: "n", "data-value": value, style: `background:color-mix(in srgb, var(--orange) ${Math.round(70 * Math.min(1, value ?? 0))}%, transparent)` }, percent(value));
  const head = h("tr", {}, h("th", { scope: "col" }, "Run"), rows.map((row) => h("th", { scope: "col", class: "n", title: row.doc }, row.name)));
  return h("div", { class: "scroll" }, h("table", { class: "shaded" }, h("thead", {}, head), h("tbody", {}, runs.map((run, i) => h("tr", {}, h("th", { scope: "row" }, run.label), rows.map((row) => cell(row.values[i])))))));
}
