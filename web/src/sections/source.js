// Shows the source lines that schedulers spent most cycles at, and all of the source beside what became of it. It needs a profile.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { number, percent } from "../format.js";
import { sourceView } from "../source/view.js";

const kShown = 16;

function largestReason(run, line) {
  const { reasons } = run.data.profile;
  const waits = line.slots.map((cycles, i) => [reasons[i], cycles]).filter(([name, cycles]) => name !== "issued" && cycles > 0);
  return waits.length ? waits.reduce((a, b) => (b[1] > a[1] ? b : a))[0] : "issued";
}

// `view` says where a line's place leads, or is null.
function costliest(run, view) {
  const total = run.part("gpu.core[*].issue_slots", () => true);
  const most = run.data.profile.lines[0].cycles;
  const placeOf = (line) => {
    const text = `${line.file.split("/").slice(-2).join("/")}:${line.line}`;
    return view ? h("button", { type: "button", title: "Show it below", onclick: () => view.open(line.file, line.line) }, text) : text;
  };
  const row = (line) =>
    h("tr", {},
      h("td", { class: "n heat" }, h("span", { style: `width:${((100 * line.cycles) / most).toFixed(1)}%` }), h("b", { "data-value": line.cycles }, percent(line.cycles / total))),
      h("td", { class: "n" }, number(line.issues)), h("td", { class: "n" }, line.issues ? (line.lanes / line.issues).toFixed(1) : "–"),
      h("td", {}, largestReason(run, line)), h("td", { class: "place", title: `${line.file}:${line.line}` }, placeOf(line)), h("td", { class: "code" }, h("code", {}, line.text.trim())));
  const head = ["Cycles", "Issued", "Lanes", "Waits for", "Line", "Text"].map((name, i) => h("th", { scope: "col", class: i < 3 ? "n" : null }, name));
  return h("div", { class: "scroll" }, h("table", { class: "source" }, h("thead", {}, h("tr", {}, head)), h("tbody", {}, run.data.profile.lines.slice(0, kShown).map(row))));
}

export function source(runs) {
  const profiled = runs.filter((run) => run.data.profile?.lines.length);
  if (!profiled.length) return null;
  return profiled.flatMap((run) => {
    const view = run.data.source ? sourceView(run.data.source) : null;
    return [runs.length > 1 ? h("h3", {}, run.label) : null, costliest(run, view), view?.element];
  });
}
