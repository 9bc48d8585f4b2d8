// Draws the flame graph of a profile: stages, under them the calls that the compiler inlined, under them lines. Widths are cycles.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { kGroups } from "../figures/cpi_stack.js";
import { number, percent } from "../format.js";
import { Cost } from "./program.js";

const kLeast = 0.0015; // share of the width: narrower frames cannot be seen
const kNamed = 0.03; // Narrower frames have no room for a name.
const kReached = 0.02; // Narrower frames are no stops of the Tab key.
const base = (path) => path.split("/").pop();

class Frame {
  constructor(name, place, reasons) {
    Object.assign(this, { name, place, children: new Map(), cost: new Cost(reasons) });
  }
  child(name, place) {
    const key = `${name} ${place ? `${place.path}:${place.line}` : ""}`;
    if (!this.children.has(key)) this.children.set(key, new Frame(name, place, this.cost.slots.length));
    return this.children.get(key);
  }
}

// Returns the calls of an instruction from the outermost: [function, place of its call or null].
function callsOf({ scopes, isa }, files, index) {
  const out = [];
  for (let row = scopes[isa.scope[index] - 1]; row; row = scopes[row[1] - 1]) out.unshift([row[0], row[1] ? { path: files[row[2]].path, line: row[3] } : null]);
  return out;
}

export function flameTree(source) {
  const reasons = source.reasons.length;
  const root = new Frame("all instructions", null, reasons);
  for (const row of source.counts) {
    const program = source.programs[row[0]], index = row[1], { file, line } = program.isa;
    const cost = Cost.of(row, reasons);
    const path = [[program.stage.replaceAll("_", " "), null], ...callsOf(program, source.files, index)];
    const place = line[index] ? { path: source.files[file[index]].path, line: line[index] } : null;
    path.push(place ? [`${base(place.path)}:${place.line}`, place] : ["no line", null]);
    let frame = root;
    frame.cost.add(cost);
    for (const [name, at] of path) (frame = frame.child(name, at)).cost.add(cost);
  }
  return root;
}

// Returns the group of reasons with most of a frame's cycles.
function groupOf(cost, reasons) {
  const cycles = ({ of }) => of.reduce((sum, reason) => sum + (cost.slots[reasons.indexOf(reason)] ?? 0), 0);
  return kGroups.reduce((best, group) => (cycles(group) > cycles(best) ? group : best));
}

// A click on a line calls `open(path, line)`. A click on any other frame makes it as wide as the graph. A click on a frame above it goes back.
export function flameGraph(source, open) {
  const tree = flameTree(source), whole = tree.cost.cycles;
  const rows = h("div", { class: "flames" });
  const said = h("p", { class: "said" });
  const say = (frame) => {
    const { name, place, cost } = frame;
    const at = place && !name.startsWith(`${base(place.path)}:`) ? ` called at ${base(place.path)}:${place.line}` : "";
    said.replaceChildren(h("b", {}, name), `${at} · ${number(cost.cycles)} cycles (${percent(cost.cycles / whole)} of those of instructions) · mostly ${groupOf(cost, source.reasons).name}`);
  };
  const button = (frame, left, width, depth, act) =>
    h("button", {
      type: "button", onclick: act, onmouseover: () => say(frame), onfocus: () => say(frame), tabindex: width < kReached ? "-1" : null, title: frame.name,
      style: `left:${(100 * left).toFixed(3)}%;width:${(100 * width).toFixed(3)}%;top:${depth * 21}px;--heat:var(--${groupOf(frame.cost, source.reasons).colour})${width < kNamed ? ";padding:0" : ""}`,
    }, width < kNamed ? "" : frame.name);
  const draw = (chain) => {
    const focus = chain[chain.length - 1], out = chain.slice(0, -1).map((frame, depth) => button(frame, 0, 1, depth, () => draw(chain.slice(0, depth + 1))));
    let deepest = chain.length;
    const below = (frame, left, depth, path) => {
      deepest = Math.max(deepest, depth + 1);
      const width = frame.cost.cycles / focus.cost.cycles;
      out.push(button(frame, left, width, depth, () => (frame.children.size ? draw(path) : frame.place && open(frame.place.path, frame.place.line))));
      for (const child of [...frame.children.values()].sort((a, b) => b.cost.cycles - a.cost.cycles)) {
        const share = child.cost.cycles / focus.cost.cycles;
        if (share >= kLeast) below(child, left, depth + 1, [...path, child]);
        left += share;
      }
    };
    below(focus, 0, chain.length - 1, chain);
    rows.replaceChildren(...out);
    rows.style.height = `${deepest * 21}px`;
    say(focus);
  };
  draw([tree]);
  const legend = kGroups.filter(({ name }) => name !== "no warp").map(({ name, colour }) => h("span", {}, h("i", { style: `background:var(--${colour})` }), name));
  return h("div", { class: "flame" }, h("h3", {}, "Calls"),
    h("p", { class: "note" }, "Rows show stages, the calls that were inlined, and lines. Each is as wide as its cycles and has the colour of what most of them went into. Click a call to enlarge it, a line to find it above. The numbers are in profile.folded."),
    h("p", { class: "legend" }, legend), said, rows);
}
