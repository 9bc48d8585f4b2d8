// Draws what the warps of one SM did in a window of cycles. It needs `--trace`.
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { gantt } from "../kinds/gantt.js";
import { kGroups } from "./cpi_stack.js";

const kFirstPlace = 1001; // thread of the RT unit's first slot: report/files/trace_files.h
const kStages = [
  { name: "intersection", colour: "yellow" }, { name: "any_hit", colour: "orange" }, { name: "closest_hit", colour: "blue" }, { name: "miss", colour: "grey" },
  { name: "callable", colour: "pink" }, { name: "ray_generation", colour: "dark" }, { name: "compute", colour: "dark" },
];
const kRunning = { name: "running", colour: "green" };

const trackName = (thread) => (thread >= kFirstPlace ? `RT place ${thread - kFirstPlace}` : `warp slot ${thread - 1}`);

// Groups the bars by how they are drawn: states in the groups of the CPI stack, stages as strips, stays in the RT unit.
function groupsOf(data, tracks) {
  const groups = new Map();
  const add = (key, name, colour, bar) => {
    if (!groups.has(key)) groups.set(key, { name, colour, bars: [] });
    groups.get(key).bars.push(bar);
  };
  for (const [thread, kind, after, length, what, rays, nodes] of data.slices) {
    const title = data.names[what], bar = { track: tracks.indexOf(thread), begin: data.begin + after, length, title, lines: [] };
    const kindName = data.kinds[kind];
    if (kindName === "state") {
      const { name, colour } = title === "running" ? kRunning : kGroups.find((group) => group.of.includes(title));
      add(name, name, colour, bar);
    } else if (kindName === "stage") {
      const { colour } = kStages.find((stage) => stage.name === title) ?? kStages[0];
      add(`stage ${title}`, `stage ${title}`, colour, { ...bar, strip: true });
    } else if (kindName === "rays") {
      add("rays", "in the RT unit", "pink", { ...bar, apart: true, title: `${number(rays)} rays`, lines: [["nodes visited", nodes]] });
      const inside = groups.get("in the RT unit"); // The warp's own wait has the same name and colour.
      if (inside) inside.bars.push(...groups.get("rays").bars.splice(0));
    }
  }
  const order = [kRunning, ...kGroups].map(({ name }) => name);
  return [...groups.values()].sort((a, b) => (order.indexOf(a.name) + 1 || 99) - (order.indexOf(b.name) + 1 || 99));
}

export function timeline(run, index) {
  const data = run.data.timeline;
  if (!data?.slices.length) return null;
  const tracks = [...new Set(data.slices.map(([thread]) => thread))].sort((a, b) => a - b);
  const chart = gantt({ tracks: tracks.map(trackName), groups: groupsOf(data, tracks), begin: data.begin, end: data.end, unit: "cycle" });
  const note = [`The figure shows SM ${data.core}, cycles ${number(data.begin)} to ${number(data.end)} of a trace from ${number(data.trace_begin)} to ${number(data.trace_end)}.`,
    data.cut ? "It ends early: no more bars than these are drawn." : "", "The strip above a bar is the shader stage. Another window: glint report --timeline FROM:TO --timeline-sm N; all of it: trace.json.gz at ui.perfetto.dev."];
  const rows = data.slices.map(([thread, kind, after, length, what, rays = null, nodes = null]) => [trackName(thread), data.kinds[kind], data.names[what], data.begin + after, length, rays, nodes]);
  return {
    info: { id: `timeline-${index}`, wide: true, title: run.label ? `Warps over time: ${run.label}` : "Warps over time", note: note.filter(Boolean).join(" ") },
    chart: { ...chart, columns: ["track", "kind", "what", "begin (cycle)", "cycles", "rays", "nodes"], rows },
  };
}
