// Shows GLSL, SPIR-V and ISA of a program side by side. A line chosen in one marks its partners in the others.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { number, percent } from "../format.js";
import { flameGraph } from "./flame.js";
import { kMeasures, legend, mostly } from "./heat.js";
import { Pane } from "./pane.js";
import { Program } from "./program.js";

const kKinds = ["glsl", "spirv", "isa"];
const base = (path) => path.split("/").pop();
const stageName = (stage) => stage.replaceAll("_", " ");

class View {
  constructor(source) {
    this.source = source;
    this.programs = source.programs.map((_, i) => new Program(source, i)).sort((a, b) => b.total.cycles - a.total.cycles);
    this.context = { reasons: source.reasons, whole: this.programs.reduce((sum, program) => sum + program.total.cycles, source.no_warp) };
    const act = { choose: (kind, key) => this.choose(kind, key), point: (kind, key) => this.point(kind, key), leave: (kind, step) => this.leave(kind, step) };
    this.panes = { glsl: new Pane("glsl", "GLSL", act), spirv: new Pane("spirv", "SPIR-V after optimisation", act), isa: new Pane("isa", "ISA", act) };
    this.pick = {
      program: this.select("Shader", this.programs.map((program, i) => [i, `${stageName(program.stage)} · ${base(program.shader)} · ${percent(program.total.cycles / this.context.whole)}`]), () => this.showProgram()),
      file: this.select("File", [], () => this.showFile()),
      measure: this.select("Measure", kMeasures.map(({ name }, i) => [i, name]), () => this.showHeat()),
    };
    this.said = h("p", { class: "said", "aria-live": "polite" });
    this.legend = h("p", { class: "legend" }, legend());
    this.element = h("div", { class: "view" },
      h("div", { class: "picks" }, Object.values(this.pick).map(({ label }) => label)), this.legend, this.said,
      h("div", { class: "panes" }, kKinds.map((kind) => this.panes[kind].element)));
  }

  select(name, options, act) {
    const box = h("select", { onchange: act });
    const fill = (list) => box.replaceChildren(...list.map(([value, text]) => h("option", { value }, text)));
    fill(options);
    return { box, fill, label: h("label", {}, name, box) };
  }
  get measure() {
    return kMeasures[Number(this.pick.measure.box.value)];
  }
  get file() {
    return Number(this.pick.file.box.value);
  }

  showProgram() {
    const program = (this.program = this.programs[Number(this.pick.program.box.value)]);
    this.chosen = null;
    const files = program.filesByCycles();
    this.pick.file.fill(files.map(([file, cycles]) => [file, `${base(this.source.files[file].path)} · ${percent(program.total.cycles ? cycles / program.total.cycles : 0)} of the shader`]));
    this.pick.file.box.disabled = !files.length;
    const isSpirv = program.spirv.text.length > 0;
    this.panes.spirv.element.hidden = !isSpirv;
    this.panes.glsl.heading.textContent = isSpirv ? "GLSL" : "Source";
    const place = ({ file, line }, i) => (line[i] ? `${base(this.source.files[file[i]].path)}:${line[i]}` : "no source line");
    this.panes.spirv.show(program.spirv.text.map((text, i) => ({ key: program.spirv.first + i, number: program.spirv.first + i, text, title: place(program.spirv, i) })));
    this.panes.isa.show(program.isa.text.map((text, i) => ({ key: i, number: i, text, title: place(program.isa, i) })));
    this.showFile();
  }

  showFile() {
    const file = this.pick.file.box.disabled ? null : this.source.files[this.file];
    const text = file?.text ?? [];
    const last = Math.max(text.length, ...[...this.program.parts.glsl.keys()].map((key) => key.split(":").map(Number)).filter(([f]) => f === this.file).map(([, line]) => line));
    const lines = file ? Array.from({ length: last }, (_, i) => ({ key: `${this.file}:${i + 1}`, number: i + 1, text: file.text ? (text[i] ?? "") : "(text not known)" })) : [];
    this.panes.glsl.show(file?.text ? lines : lines.filter(({ key }) => this.program.parts.glsl.has(key)));
    this.showHeat();
    this.showHottest();
  }

  showHeat() {
    this.legend.hidden = this.measure.id !== "stalls";
    for (const kind of kKinds) {
      const costs = this.program.costs[kind];
      this.panes[kind].heat(costs, this.measure, this.context);
      const sum = this.program.sum(kind), rest = costs.get(null);
      this.panes[kind].note.textContent = rest ? `${percent(rest.cycles / sum.cycles)} of no line` : "";
      Object.assign(this.panes[kind].element.dataset, { cycles: sum.cycles, issues: sum.issues, lanes: sum.lanes, sectors: sum.sectors });
    }
    this.say(this.chosen);
  }

  // Chooses the costliest line of the file, when no line is chosen.
  showHottest() {
    if (this.chosen) return this.mark(this.chosen);
    let hottest = null;
    for (const [key, cost] of this.program.costs.glsl) if (key?.startsWith(`${this.file}:`) && cost.cycles > (hottest?.cycles ?? 0)) hottest = { key, cycles: cost.cycles };
    if (hottest) this.choose("glsl", hottest.key);
  }

  choose(kind, key) {
    this.chosen = { kind, key };
    const partners = this.program.partners(kind, key);
    const files = [...partners.glsl].map((place) => Number(place.split(":")[0]));
    if (files.length && !files.includes(this.file)) {
      this.pick.file.box.value = String(files[0]);
      return this.showFile(), this.reveal(partners);
    }
    this.mark(this.chosen);
    this.reveal(partners);
  }
  reveal(partners) {
    for (const kind of kKinds) this.panes[kind].reveal(partners[kind]);
  }
  point(kind, key) {
    this.mark(key === null ? this.chosen : { kind, key });
  }
  leave(kind, step) {
    const next = kKinds[kKinds.indexOf(kind) + step];
    if (!next || !this.chosen) return;
    const first = [...this.program.partners(this.chosen.kind, this.chosen.key)[next]][0];
    this.panes[next].list.focus({ preventScroll: true });
    if (first !== undefined) this.choose(next, first);
  }
  mark(at) {
    const partners = at ? this.program.partners(at.kind, at.key) : { glsl: new Set(), spirv: new Set(), isa: new Set() };
    for (const kind of kKinds) this.panes[kind].mark(partners[kind], at?.kind === kind ? at.key : undefined);
    this.say(at, partners);
  }

  say(at, partners = at ? this.program.partners(at.kind, at.key) : null) {
    if (!at) return this.said.replaceChildren(`${this.measure.name}: ${this.measure.note}.`);
    const cost = this.program.costs[at.kind].get(at.key);
    const where = [...partners.glsl].map((key) => `${base(this.source.files[Number(key.split(":")[0])].path)}:${key.split(":")[1]}`).join(", ") || "no source line";
    const what = !cost ? "no cost" : `${number(cost.cycles)} cycles (${percent(cost.cycles / this.context.whole, 2)} of all): ${mostly(cost, this.context.reasons)}; issued ${number(cost.issues)} times${cost.issues ? ` with ${(cost.lanes / cost.issues).toFixed(1)} lanes` : ""}${cost.sectors ? `, ${number(cost.sectors)} sectors` : ""}`;
    this.said.replaceChildren(h("b", {}, where), ` · ${partners.spirv.size} SPIR-V, ${partners.isa.size} ISA · ${what}`);
  }

  // Opens a place from outside, in the program that spent most there.
  open(path, line) {
    const file = this.source.files.findIndex((one) => one.path === path);
    const cycles = (program) => program.costs.glsl.get(`${file}:${line}`)?.cycles ?? 0;
    const index = this.programs.reduce((best, program, i) => (cycles(program) > cycles(this.programs[best]) ? i : best), 0);
    this.pick.program.box.value = String(index);
    this.showProgram();
    this.choose("glsl", `${file}:${line}`);
    this.element.scrollIntoView({ block: "nearest" });
  }
}

// Returns a place in the page where the view appears once the page has it. `open(file, line)` then leads there.
export function sourceView(source) {
  const place = h("div", { class: "view-place" });
  let view = null;
  setTimeout(() => {
    view = new View(source);
    place.append(view.element, flameGraph(source, (file, line) => view.open(file, line)));
    view.showProgram(); // The view is in the page now, so panes have a height to scroll in.
    document.documentElement.dataset.source = "yes"; // Tests read this: all of the above has run.
  });
  return { element: place, open: (file, line) => view?.open(file, line) };
}
