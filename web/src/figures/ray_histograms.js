// Draws how many nodes rays visit, and how long they take.
// SPDX-License-Identifier: Apache-2.0
import { histogram } from "../kinds/histogram.js";
import { runColour } from "../theme.js";

function histogramOf(runs, path, unit) {
  const series = runs.map((run) => ({ name: run.label, colour: runColour(run.index), counts: run.histogram(path) })).filter((one) => one.counts.length);
  return series.length ? histogram({ series, bins: runs[0].bins(path), unit, what: "rays" }) : null;
}

export const nodes = {
  info: { id: "ray-nodes", coloured: true, title: "Nodes visited by a ray", note: "Bars are shares of all rays." },
  make: (runs) => histogramOf(runs, "gpu.rt_unit[*].rt.ray_nodes", "nodes"),
};
export const latency = {
  info: { id: "ray-latency", coloured: true, title: "Time of a ray in the RT unit", note: "A ray’s time goes from its acceptance to its stop. All stays of a ray that comes back from a shader count together." },
  make: (runs) => histogramOf(runs, "gpu.rt_unit[*].rt.ray_latency", "cycles"),
};
