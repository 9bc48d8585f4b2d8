// Holds the measures of the source view: what stands beside a line, and how hot it is drawn.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { kGroups } from "../figures/cpi_stack.js";
import { number, percent } from "../format.js";

const kLanes = 32; // lanes of a warp

// Returns the groups of reasons with their parts of a cost, without "issued": [{name, colour, cycles}].
export function waits(cost, reasons) {
  return kGroups
    .filter((group) => group.name !== "issued")
    .map(({ name, colour, of }) => ({ name, colour, cycles: of.reduce((sum, reason) => sum + (cost.slots[reasons.indexOf(reason)] ?? 0), 0) }))
    .filter((part) => part.cycles > 0);
}
const waiting = (cost, reasons) => waits(cost, reasons).reduce((sum, part) => sum + part.cycles, 0);

// `value` is compared and drawn as a bar, and `text` is read. `whole` is the cycles of all schedulers of the run.
export const kMeasures = [
  { id: "cycles", name: "Cycles", value: (cost) => cost.cycles, text: (cost, { whole }) => percent(cost.cycles / whole, 2), note: "shares of all scheduler cycles of the run" },
  { id: "stalls", name: "Stall cycles by reason", value: (cost, { reasons }) => waiting(cost, reasons), text: (cost, { reasons, whole }) => percent(waiting(cost, reasons) / whole, 2), note: "cycles in which nothing issued, as shares of all scheduler cycles" },
  { id: "issues", name: "Issues", value: (cost) => cost.issues, text: (cost) => number(cost.issues), note: "warp instructions issued" },
  { id: "lanes", name: "Active lanes", value: (cost) => (cost.issues ? cost.lanes / cost.issues : 0), text: (cost) => (cost.issues ? (cost.lanes / cost.issues).toFixed(1) : "–"), most: () => kLanes, note: "mean of the 32 of a warp" },
  { id: "sectors", name: "Memory sectors", value: (cost) => cost.sectors, text: (cost) => (cost.sectors ? number(cost.sectors) : ""), note: "of 32 bytes, asked of the L1" },
  { id: "latency", name: "Latency", value: (cost) => (cost.ended ? cost.latency / cost.ended : 0), text: (cost) => (cost.ended ? number(Math.round(cost.latency / cost.ended)) : ""), note: "mean cycles of an access or trace, issue to completion" },
];

const bar = (share, colour) => h("i", { style: `width:${(100 * share).toFixed(2)}%;background:var(--${colour})` });

// Fills the column of a line. `most` is the largest value of the pane.
export function fill(cell, cost, measure, most, context) {
  cell.replaceChildren();
  if (!cost) return;
  const value = measure.value(cost, context);
  const share = most > 0 ? Math.min(1, value / most) : 0;
  const parts = measure.id === "stalls" ? waits(cost, context.reasons) : [];
  const bars = parts.length ? parts.map((part) => bar((share * part.cycles) / value, part.colour)) : [bar(share, "orange")];
  cell.append(h("span", { class: "bars" }, bars), h("b", {}, measure.text(cost, context)));
  cell.title = parts.map((part) => `${part.name} ${percent(part.cycles / value)}`).join(", ");
}

// Names the largest parts of a cost: "long_scoreboard 62 %, issued 20 %".
export function mostly(cost, reasons) {
  const all = [...cost.slots].map((cycles, i) => [reasons[i], cycles]).filter(([, cycles]) => cycles > 0);
  return all.sort((a, b) => b[1] - a[1]).slice(0, 3).map(([name, cycles]) => `${name} ${percent(cycles / cost.cycles)}`).join(", ");
}

// Shows the colours of "stalls".
export function legend() {
  return kGroups.filter(({ name }) => name !== "issued" && name !== "no warp").map(({ name, colour }) => h("span", {}, h("i", { style: `background:var(--${colour})` }), name));
}
