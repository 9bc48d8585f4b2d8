// Lists every key of the configuration, folded away.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { number } from "../format.js";

export function keys(runs, docs) {
  const all = [...new Set(runs.flatMap((run) => Object.keys(run.data.config)))];
  const text = (value) => (value === undefined ? "–" : typeof value === "number" ? number(value) : String(value));
  const row = (key) => h("tr", { class: runs.some((run) => key in run.changes) ? "changed" : null }, h("th", { scope: "row" }, h("code", {}, key)), runs.map((run) => h("td", { class: "n" }, text(run.config(key)))), h("td", { class: "u" }, docs[key]?.unit ?? ""), h("td", { class: "doc" }, docs[key]?.doc ?? ""));
  return h("details", {}, h("summary", {}, `All ${all.length} keys`), h("div", { class: "scroll" }, h("table", { class: "config" }, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Key"), runs.map((run) => h("th", { scope: "col", class: "n" }, runs.length > 1 ? run.label : "Value")), h("th", { scope: "col" }, "Unit"), h("th", { scope: "col" }, "Meaning"))), h("tbody", {}, all.map(row)))));
}
