// Compares several runs: which configuration is faster on the whole, and which metrics changed most.
// SPDX-License-Identifier: Apache-2.0
import { csv, download, h } from "../dom.js";
import { change, number } from "../format.js";
import { geometricMean } from "../model.js";

const kShown = 25; // rows before the rest is folded away
const kWide = 2; // pairs; with more, paper has room for the changes only
const kFewRuns = 4; // runs that may be compared with the first without any work in common
const kOfTheHost = "sim_rate"; // It says nothing of the machine that is simulated.

// Returns the runs that can be compared. A run of several launches or frames is their sum, so it is compared with other whole runs, and its parts are
// compared with each other where there is no other whole run.
export function comparable(runs, collections) {
  const parts = new Set((collections ?? []).filter(({ kind }) => kind === "launches" || kind === "frames").flatMap(({ points }) => points.map(({ directory }) => directory)));
  const isPart = (run) => parts.has(run.data.directory);
  const wholes = runs.filter((run) => !isPart(run));
  return parts.size && wholes.length === 1 ? runs.filter(isPart) : wholes;
}

// Returns the speed-up of each configuration over the first, over the workloads that both have.
export function means(runs) {
  const configs = [...new Set(runs.map((run) => run.configLabel))];
  if (configs.length < 2) return null;
  const tasks = [...new Set(runs.map((run) => run.taskLabel))];
  const of = (config, task) => runs.find((run) => run.configLabel === config && run.taskLabel === task);
  const rows = configs.map((config) => {
    const pairs = tasks.map((task) => [of(configs[0], task), of(config, task)]).filter(([base, run]) => base && run);
    return { config, workloads: pairs.length, speedup: geometricMean(pairs.map(([base, run]) => base.seconds / run.seconds)), ipc: geometricMean(pairs.map(([, run]) => run.ipc)) };
  });
  const head = ["Configuration", "Workloads", "Speed-up", "IPC"];
  return h(
    "div",
    { class: "scroll" },
    h("table", { class: "facts", id: "means" }, h("caption", {}, `Geometric means over the workloads shared with ${configs[0]}; time counts, not cycles`), h("thead", {}, h("tr", {}, head.map((name, i) => h("th", { scope: "col", class: i ? "n" : null }, name)))),
      h("tbody", {}, rows.map((row) => h("tr", {}, h("th", { scope: "row" }, row.config), h("td", { class: "n" }, number(row.workloads)), h("td", { class: "n", "data-value": row.speedup }, row.speedup === null ? "–" : `${row.speedup.toFixed(3)}×`), h("td", { class: "n", "data-value": row.ipc }, row.ipc === null ? "–" : row.ipc.toFixed(3)))))),
  );
}

// Returns what each run is compared with: the first run of its task. Where no two runs have a task in common and the runs are few, it is the first of
// all.
function pairsOf(runs) {
  const first = (run) => runs.find((one) => one.taskLabel === run.taskLabel);
  const pairs = runs.map((run) => [first(run), run]).filter(([base, run]) => base !== run);
  return pairs.length || runs.length > kFewRuns ? pairs : runs.slice(1).map((run) => [runs[0], run]);
}

function changeOf(base, run, name) {
  const [was, is] = [base.metric(name), run.metric(name)];
  return was === null || is === null ? null : was === is ? 1 : is / was;
}

// Returns metrics ordered by the largest change of any pair, or null where there is nothing to compare.
export function deltas(runs, docs) {
  const pairs = pairsOf(runs);
  if (!pairs.length) return null;
  const bases = [...new Set(pairs.map(([base]) => base))];
  const one = bases.length === 1 ? bases[0] : null;
  const rows = docs
    .filter((doc) => doc.known && doc.name !== kOfTheHost)
    .map((doc) => {
      const ratios = pairs.map(([base, run]) => changeOf(base, run, doc.name));
      return { doc, ratios, size: Math.max(0, ...ratios.map((r) => (r === null ? 0 : Math.abs(r - 1)))) };
    })
    .filter((row) => row.ratios.some((r) => r !== null))
    .sort((a, b) => b.size - a.size);
  const tone = (r) => (r === null || r === 1 ? "n same" : "n moved");
  const value = (run, doc) => h("td", { class: "n value", "data-value": run.metric(doc.name) }, number(run.metric(doc.name)));
  const line = ({ doc, ratios }, i) =>
    h("tr", { class: i >= kShown ? "folded" : null }, h("th", { scope: "row", title: doc.doc }, h("code", {}, doc.name)), h("td", { class: "u" }, doc.unit), one ? value(one, doc) : null, pairs.map(([, run], k) => [value(run, doc), h("td", { class: tone(ratios[k]) }, ratios[k] === Infinity ? "new" : change(ratios[k]))]).flat());
  const head = h("tr", {}, h("th", { scope: "col" }, "Metric"), h("th", { scope: "col", class: "u" }, "Unit"), one ? h("th", { scope: "col", class: "n value" }, one.label) : null, pairs.map(([base, run]) => [h("td", { class: "value" }), h("th", { scope: "col", class: "n" }, run.label, one ? null : h("small", {}, `against ${base.label}`))]).flat());
  const table = h("table", { class: pairs.length === 1 ? "deltas pair" : pairs.length > kWide ? "deltas wide" : "deltas" }, h("thead", {}, head), h("tbody", {}, rows.map(line)));
  const columns = ["metric", "unit", ...pairs.flatMap(([base, run]) => [base.label, run.label, "ratio"])];
  const save = () => download("changes.csv", "text/csv", csv(columns, rows.map(({ doc, ratios }) => [doc.name, doc.unit, ...pairs.flatMap(([base, run], k) => [base.metric(doc.name), run.metric(doc.name), Number.isFinite(ratios[k]) ? ratios[k] : null])])));
  const unfold = h("button", { type: "button", onclick: () => { table.classList.add("whole"); unfold.remove(); } }, `All ${rows.length} metrics`);
  const note = `Metrics come in order of their relative change${one ? ` against ${one.label}` : ", each run against the first of its workload"}, the largest of either sign first; before them comes what was 0 and is not any more.`;
  return h("figure", { id: "deltas", class: "wide" }, h("h3", {}, "What changed most"), h("p", { class: "note" }, note), h("div", { class: "scroll" }, table), h("figcaption", {}, rows.length > kShown ? unfold : null, h("button", { type: "button", onclick: save }, "CSV")));
}
