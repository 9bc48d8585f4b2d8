// Makes the head of the page: which run, its picture, its key numbers.
// SPDX-License-Identifier: Apache-2.0
import { csv, download, h } from "../dom.js";
import { bytes, duration, number, percent, short } from "../format.js";
import { ratio } from "../model.js";
import { runColour } from "../theme.js";

// Each entry is a name, a value, what it is, and the statistic behind it. The value of a key number carries the exact one for machines.
const kNumbers = [
  { name: "Cycles", value: (run) => run.cycles, text: number, sub: (run) => `${duration(run.seconds)} at ${number(run.config("clock_mhz"))} MHz`, stat: "gpu.cycles" },
  { name: "IPC", value: (run) => run.ipc, text: (v) => v?.toFixed(2) ?? "–", sub: (run) => `${number(run.sum("gpu.core[*].instructions"))} warp instructions`, stat: "gpu.core[*].instructions / gpu.cycles" },
  { name: "SIMT efficiency", value: (run) => run.metric("simt_efficiency"), text: (v) => percent(v), sub: () => "of 32 lanes execute", stat: "simt_efficiency" },
  { name: "Rays", value: (run) => run.metric("rays_total"), text: number, sub: (run) => `${short(run.metric("rays_total") / run.seconds)} rays/s`, stat: "gpu.rt_unit[*].rt.rays", rays: true },
  { name: "Nodes per ray", value: (run) => run.metric("avg_nodes_per_ray"), text: (v) => v?.toFixed(1) ?? "–", sub: (run) => `depth ${number(run.metric("bvh_depth"))}, at most ${number(run.metric("max_nodes_per_ray"))}`, stat: "avg_nodes_per_ray", rays: true },
  { name: "RT-unit occupancy", value: (run) => run.metric("rt_occupancy"), text: (v) => percent(v), sub: (run) => `of ${run.config("rt.warps")} warp slots, while it has any`, stat: "rt_occupancy", rays: true },
  { name: "L1 hits", value: (run) => hits(run, "core[*].l1"), text: (v) => percent(v), sub: (run) => `${short(run.metric("l1d_accesses"))} accesses`, stat: "l1 hits / reads" },
  { name: "L2 hits", value: (run) => hits(run, "partition[*].l2"), text: (v) => percent(v), sub: (run) => `${short(run.metric("l2_accesses"))} accesses`, stat: "l2 hits / reads" },
  { name: "DRAM utilisation", value: (run) => run.metric("dram_util"), text: (v) => percent(v), sub: (run) => `of ${short(run.facts.memory_peaks?.dram_bytes_per_second ?? null)}B/s`, stat: "dram_util" },
];

// These are the key numbers of sampled runs: estimates of the whole run.
const kEstimates = [
  { name: "Cycles", of: "cycles", text: (v) => number(Math.round(v)) },
  { name: "IPC", of: "ipc", text: (v) => v.toFixed(2) },
  { name: "Warp instructions", of: "instructions", text: short },
  { name: "Nodes visited", of: "nodes", text: short },
  { name: "L1 hits", of: "l1_hit_rate", text: (v) => percent(v) },
  { name: "L2 hits", of: "l2_hit_rate", text: (v) => percent(v) },
  { name: "DRAM utilisation", of: "dram_utilisation", text: (v) => percent(v) },
].map((one) => ({ ...one, stat: `gpu.sample.${one.of}`, value: (run) => run.estimate(one.of)?.value ?? null }));

const intervalOf = (run, { of, text }) => {
  const found = run.estimate(of);
  return found.low === found.high ? "exact" : `${text(found.low)} to ${text(found.high)}`;
};

function hits(run, cache) {
  const all = () => true;
  return ratio(run.part(`gpu.memory.${cache}.hits`, all), run.part(`gpu.memory.${cache}.reads`, all));
}

function about(run) {
  const { facts } = run;
  const words = [facts.config.name, run.size, facts.samples ? `${facts.samples} spp` : ""];
  const changed = Object.keys(run.changes).length;
  if (changed) words.push(`${changed} ${changed === 1 ? "key" : "keys"} changed`);
  return words.filter(Boolean).join(" · ");
}

// A row of a table has the numbers that all runs have. Where some are sampled, these are the ones that can be estimated.
function numbersOf(runs) {
  if (!runs.some((run) => run.isSampled)) return ofWholeRuns(runs);
  if (runs.every((run) => run.isSampled))
    return kEstimates.filter((one) => runs.some((run) => one.value(run) !== null)).map((one) => ({ ...one, sub: (run) => (one.value(run) === null ? "" : intervalOf(run, one)) }));
  return kNumbers.filter(({ name }) => ["Cycles", "IPC"].includes(name)).map((one, i) => ({ ...one, sub: (run) => (run.isSampled ? intervalOf(run, kEstimates[i]) : "") }));
}
const ofWholeRuns = (runs) => kNumbers.filter((one) => !one.rays || runs.some((run) => run.metric("rays_total")));

const kPictureWidth = 288; // as in report.css

// Shows a picture. A small one is enlarged by a whole factor, so that every pixel is a square.
function enlarged(source, width, alt) {
  const factor = Math.floor(kPictureWidth / width);
  return h("img", { class: factor ? "picture pixels" : "picture", style: factor ? `width:${factor * width}px` : null, src: source, alt });
}

// Shows the picture of a scene, or the first image that a pipeline saved.
function pictureOf(run) {
  const { picture, images } = run.data;
  if (picture) return enlarged(picture, run.facts.width, `Picture of ${run.workload}`);
  return images ? imageOf(run, images[0]) : null;
}

const imageOf = (run, image) => h("figure", { class: "image", "data-image": image.name }, enlarged(image.picture, image.width, `${image.name} of ${run.workload}`), h("figcaption", { class: "note" }, `${image.name} (${image.file}, ${image.width}×${image.height})`));

const thumbOf = (run) => run.data.picture ?? run.data.images?.[0].picture;

// Says what a run changed in its scene, and which part of the frame it has.
function changesOf({ overrides, crop }) {
  const changed = Object.entries(overrides ?? {}).map(([key, value]) => `${key} = ${value}`);
  const sentences = changed.length ? [`The scene was changed: ${changed.join("; ")}.`] : [];
  if (crop) sentences.push(`The picture is the window of a frame of ${crop.frame_width}×${crop.frame_height} that begins at (${crop.x}, ${crop.y}).`);
  return sentences.join(" ");
}

// Ends a text with a full stop. The note of a program is its input, which has none.
const sentence = (text) => (!text || /[.!?]$/.test(text) ? text : `${text}.`);

function single(run) {
  const { facts } = run;
  const picture = pictureOf(run);
  const numbers = numbersOf([run]).map((one) => h("div", { class: "number" }, h("dt", {}, one.name), h("dd", { "data-stat": one.stat, "data-value": one.value(run) }, one.text(one.value(run))), h("dd", { class: "sub" }, run.isSampled ? `95 %: ${one.sub(run)}` : one.sub(run))));
  const details = [run.isSampled ? "These are estimates of the whole run, with their 95 % intervals." : "", sentence(facts.scene.note), changesOf(facts), facts.residency ? `${facts.residency.warps} warps fit a core, limited by ${facts.residency.limit}.` : ""].filter(Boolean).join(" ");
  return [
    h("header", { class: "hero" }, h("p", { class: "kicker" }, "Glint report"), h("h1", {}, run.workload), h("p", { class: "about" }, about(run))),
    h("div", { class: picture ? "key with-picture" : "key" }, picture, h("dl", { class: "numbers" }, numbers)),
    run.data.images?.length > 1 ? h("div", { class: "images" }, run.data.images.slice(1).map((image) => imageOf(run, image))) : null,
    details ? h("p", { class: "note" }, details) : null,
  ];
}

function several(runs) {
  const numbers = numbersOf(runs);
  const values = numbers.map((one) => runs.map((run) => one.value(run)));
  const sampled = runs.some((run) => run.isSampled); // Intervals stand below the numbers then.
  const best = values.map((column) => Math.max(...column.map((value) => value ?? -Infinity)));
  const row = (run, i) =>
    h(
      "tr",
      {},
      h("td", { class: "thumb" }, thumbOf(run) ? h("img", { src: thumbOf(run), alt: "" }) : null),
      h("th", { scope: "row", title: run.data.directory }, h("span", { class: "dot", style: `background:var(--${runColour(run.index)})` }), run.label, h("small", {}, about(run))),
      numbers.map((one, k) => h("td", { class: "n", "data-stat": one.stat, "data-value": values[k][i], "data-best": values[k][i] === best[k] }, values[k][i] === null ? "–" : one.text(values[k][i]), sampled ? h("small", {}, one.sub(run)) : null)),
    );
  return [
    h("header", { class: "hero" }, h("p", { class: "kicker" }, "Glint report"), h("h1", {}, `${runs.length} runs`), h("p", { class: "about" }, [...new Set(runs.map((run) => run.workload))].join(", "))),
    h("div", { class: "scroll" }, h("table", { class: "runs" }, h("thead", {}, h("tr", {}, h("th", {}), h("th", { scope: "col" }, "Run"), numbers.map((one) => h("th", { scope: "col", class: "n" }, one.name)))), h("tbody", {}, runs.map(row)))),
  ];
}

export function overview(runs) {
  return h("section", { id: "overview" }, runs.length === 1 ? single(runs[0]) : several(runs));
}

// Makes the head of a page without runs. Its title is the document's.
export function overviewOfSuites(data) {
  const sources = [...new Set([...data.characterizations, ...data.models, ...(data.labs ?? [])].map((one) => one.source))];
  return h("section", { id: "overview" }, h("header", { class: "hero" }, h("p", { class: "kicker" }, "Glint report"), h("h1", {}, document.title.split(" – ")[0]), h("p", { class: "about" }, sources.join(", "))));
}

// Lists facts of scene and structures, which have one column for each run. An entry is a name, a value, and how it is written.
const kFacts = [
  ["Triangles", (run) => run.metric("triangles"), number],
  ["Procedural primitives", (run) => run.metric("procedurals"), number],
  ["Bottom-level structures", (run) => run.metric("blas_count"), number],
  ["Instances", (run) => run.metric("instances"), number],
  ["Size of all structures", (run) => run.metric("bvh_bytes"), bytes],
  ["Depth of the top level", (run) => run.metric("tlas_depth"), number],
  ["Deepest path, both levels", (run) => run.metric("bvh_depth"), number],
  ["Node format", (run) => run.config("bvh.format") ?? "–", String],
  ["Internal nodes of those visited", (run) => shareOf(run, "%internal"), percent],
  ["Instance leaves", (run) => shareOf(run, "%tlas_leaf"), percent],
  ["Primitive leaves", (run) => shareOf(run, "%leaf"), percent],
  ["Rays for the closest hit", (run) => run.metric("rays_closest"), number],
  ["Rays for any hit", (run) => run.metric("rays_any"), number],
  ["Box tests", (run) => run.metric("box_tests"), number],
  ["Triangle tests", (run) => run.metric("tri_tests"), number],
  ["Closest-hit shaders", (run) => run.metric("n_chit"), number],
  ["Miss shaders", (run) => run.metric("n_miss"), number],
  ["Any-hit shaders", (run) => run.metric("n_anyhit"), number],
  ["Intersection shaders", (run) => run.metric("n_intersection"), number],
];
const shareOf = (run, metric) => (run.metric(metric) === null ? null : run.metric(metric) / 100);

export function structure(runs) {
  if (!runs.some((run) => run.facts.structures)) return null;
  const head = runs.length > 1 ? h("thead", {}, h("tr", {}, h("th", {}), runs.map((run) => h("th", { scope: "col", class: "n" }, run.label)))) : null;
  const rows = kFacts.map(([name, value, text]) => h("tr", {}, h("th", { scope: "row" }, name), runs.map((run) => h("td", { class: "n" }, text(value(run))))));
  const save = () => download("structure.csv", "text/csv", csv(["", ...runs.map((run) => run.label)], kFacts.map(([name, value]) => [name, ...runs.map(value)])));
  return [h("div", { class: "scroll" }, h("table", { class: "facts" }, head, h("tbody", {}, rows))), h("figcaption", {}, h("button", { type: "button", onclick: save }, "CSV"))];
}
