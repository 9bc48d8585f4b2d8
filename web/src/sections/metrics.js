// Lists every metric of every run.
// SPDX-License-Identifier: Apache-2.0
import { h, prose } from "../dom.js";
import { number } from "../format.js";

export function metrics(runs, docs) {
  const known = docs.filter((doc) => doc.known);
  const head = (run) => h("th", { scope: "col", class: "n", title: run.data.directory }, runs.length > 1 ? run.label : "Value");
  const value = (run, { name }) => h("td", { class: "n", "data-value": run.metric(name) }, number(run.metric(name)));
  const row = (doc) => h("tr", {}, h("th", { scope: "row" }, h("code", {}, doc.name)), runs.map((run) => value(run, doc)), h("td", { class: "u" }, doc.unit), h("td", { class: "doc" }, prose(doc.doc)));
  const group = (title) => h("tbody", {}, h("tr", { class: "group" }, h("th", { scope: "rowgroup", colspan: runs.length + 3 }, title)), known.filter((doc) => doc.group === title).map(row));
  return h("div", { class: "scroll" }, h("table", { class: "metrics" }, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Metric"), runs.map(head), h("th", { scope: "col" }, "Unit"), h("th", { scope: "col" }, "Meaning"))), [...new Set(known.map((doc) => doc.group))].map(group)));
}
