// Draws the document that `glint report` embedded in the page, and puts its sections in order.
// SPDX-License-Identifier: Apache-2.0
import { readDocument } from "./document.js";
import { h } from "./dom.js";
import { drawPlaced, figure, figures as figuresOf } from "./figure.js";
import * as caches from "./figures/caches.js";
import * as cpiStack from "./figures/cpi_stack.js";
import * as dram from "./figures/dram.js";
import * as fetchMix from "./figures/fetch_mix.js";
import * as geometry from "./figures/geometry.js";
import * as instructionMix from "./figures/instruction_mix.js";
import * as ipc from "./figures/ipc.js";
import * as memoryLatency from "./figures/memory_latency.js";
import * as opCycles from "./figures/op_cycles.js";
import * as opLatency from "./figures/op_latency.js";
import * as ops from "./figures/ops.js";
import * as rayHistograms from "./figures/ray_histograms.js";
import * as rtCycles from "./figures/rt_cycles.js";
import * as rtUse from "./figures/rt_use.js";
import * as series from "./figures/series.js";
import * as stageCycles from "./figures/stage_cycles.js";
import * as stages from "./figures/stages.js";
import { timeline } from "./figures/timeline.js";
import * as traversal from "./figures/traversal.js";
import { labelRuns, Run } from "./model.js";
import { failed } from "./packed.js";
import { bounds } from "./sections/bounds.js";
import { comparable, deltas, means } from "./sections/compare.js";
import { heat } from "./sections/heat.js";
import { keys } from "./sections/keys.js";
import { metrics } from "./sections/metrics.js";
import { overview, overviewOfSuites, structure } from "./sections/overview.js";
import { source } from "./sections/source.js";
import { stalls } from "./sections/stalls.js";
import { suites } from "./sections/suites.js";
import { kMaxColours } from "./theme.js";

// Where each run has a colour, only as many runs are shown as there are colours.
function ofRuns({ info, make }, runs) {
  const shown = info.coloured ? runs.slice(0, kMaxColours) : runs;
  const note = [typeof info.note === "function" ? info.note(shown) : info.note, shown.length < runs.length ? `The first ${shown.length} runs.` : ""].join(" ");
  return { info: { ...info, note }, make: () => make(shown) };
}
// Draws one timeline for each run that has a trace.
function timelines(runs) {
  const drawn = runs.map((run) => timeline(run, run.index)).filter(Boolean);
  return drawn.length ? h("div", { class: "figures" }, drawn.map(({ info, chart }) => figure(info, chart))) : null;
}
const kNames = { profile: "profile", series: "time series", timeline: "timeline of warps", heat: "map of cost" };
const missing = (runs, what, option) => (runs.some((run) => run.data[what]) ? null : h("p", { class: "note" }, `No ${kNames[what]} was recorded; `, h("code", {}, option), " records it."));

function section(id, title, lead, ...content) {
  const known = content.flat().filter(Boolean);
  return known.length ? h("section", { id }, h("h2", {}, title), lead ? h("p", { class: "lead" }, lead) : null, known) : null;
}
// Sections that show statistics say so where these are those of a sample.
const kOfWholeRuns = ["overview", "comparison", "structure"];
function markSampled(runs) {
  if (!runs.some((run) => run.isSampled)) return;
  for (const shown of document.querySelectorAll("#figures > section"))
    if (!kOfWholeRuns.includes(shown.id)) shown.querySelector("h2")?.after(h("p", { class: "note sampled" }, "Of sampled runs this shows what was timed, not the whole run."));
  document.getElementById("overview").after(document.getElementById("estimates"));
}

function sectionsOf(data, runs) {
  if (runs.length === 0) return [overviewOfSuites(data)];
  const figures = (...list) => figuresOf(list.map((one) => ofRuns(one, runs)), runs);
  const compared = comparable(runs, data.collections);
  return [
    overview(runs),
    section("comparison", "Comparison", null, means(compared), figuresOf([ofRuns(ipc, compared)], compared), deltas(compared, data.metric_docs)),
    section("bounds", "How near to the limits", "Each bar shows what a resource did, as a share of the most that it could do in the time of the run. The highest is the one to look at first.", bounds(runs)),
    section("stalls", "Where the time goes", "These are the largest reasons why a scheduler issued nothing, as shares of all scheduler cycles, and the keys that bear on them.", stalls(runs), figures(cpiStack)),
    section("instructions", "Instructions", null, figures(instructionMix, stages, stageCycles, ops, opCycles, opLatency), missing(runs, "profile", "--profile")),
    section("rays", "Rays and RT units", null, figures(rtUse, traversal, rtCycles, fetchMix, rayHistograms.nodes, rayHistograms.latency)),
    section("memory", "Memory", null, figures(memoryLatency.stages, caches.l1, caches.l2, memoryLatency.spread, dram.use, dram.clocks)),
    section("time", "Over time", null, figures(series) ?? missing(runs, "series", "--sample CYCLES"), timelines(runs) ?? missing(runs, "timeline", "--trace")),
    section("heat", "What each pixel cost", "Colours go in even steps from 0 to what 99 of 100 pixels do not exceed.", heat(runs, data.heat_scale) ?? missing(runs, "heat", "--heat")),
    section("source", "Source", "Each cycle of a scheduler is charged to a line: to that of the instruction that issued, or of the one whose warp was nearest to issue.", source(runs) ?? missing(runs, "profile", "--profile")),
    section("structure", "Scene and structures", null, figures(geometry), structure(runs)),
  ];
}

function draw(data) {
  const docs = { ...data.stat_docs, keys: data.key_docs };
  const runs = labelRuns(data.runs.map((run, index) => new Run(run, index, docs)));
  document.getElementById("figures").append(...sectionsOf(data, runs).filter(Boolean));
  markSampled(runs);
  document.getElementById("all-keys")?.append(keys(runs, data.key_docs)); // A page of suites alone has no place for them.
  document.getElementById("all-metrics")?.append(metrics(runs, data.metric_docs));
  suites(data);
  document.getElementById("contents").append(h("a", { href: "#overview", class: "brand" }, "Glint"), ...[...document.querySelectorAll("section > h2")].map((title) => h("a", { href: `#${title.parentElement.id}` }, title.textContent)));
  document.getElementById("footer").append(`Glint ${data.version}. `, ...runs.map((run) => h("p", {}, h("code", {}, run.data.run.command.join(" ")), ` · ${run.facts.git} · ${run.facts.compiler} · ${run.facts.started}`)));
  drawPlaced();
  document.documentElement.dataset.ready = "yes"; // Tests read this: all of the above has run.
  document.getElementById(location.hash.slice(1))?.scrollIntoView(); // What the address names was not there when the browser looked.
}

readDocument().then(draw).catch(failed);
