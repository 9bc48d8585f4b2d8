// Holds what the source view draws of a run: its programs, what each line cost, and which lines belong together.
// SPDX-License-Identifier: Apache-2.0

const kCounts = ["issues", "lanes", "sectors", "accesses", "ended", "latency"]; // behind program and index, then pairs of reasons

export class Cost {
  constructor(reasons) {
    for (const name of kCounts) this[name] = 0;
    this.slots = new Float64Array(reasons);
  }
  static of(row, reasons) {
    const cost = new Cost(reasons);
    kCounts.forEach((name, i) => (cost[name] = row[2 + i]));
    for (let i = 2 + kCounts.length; i < row.length; i += 2) cost.slots[row[i]] = row[i + 1];
    return cost;
  }
  add(other) {
    for (const name of kCounts) this[name] += other[name];
    other.slots.forEach((cycles, i) => (this.slots[i] += cycles));
    return this;
  }
  get cycles() {
    return this.slots.reduce((sum, cycles) => sum + cycles, 0);
  }
}

// Holds a program. The key of a line is "file:line" in GLSL, its number in SPIR-V, and its index in ISA.
export class Program {
  constructor(source, number) {
    Object.assign(this, source.programs[number], { number, files: source.files });
    this.reasons = source.reasons.length;
    this.costs = { glsl: new Map(), spirv: new Map(), isa: new Map() };
    for (const row of source.counts) if (row[0] === number) this.charge(row[1], Cost.of(row, this.reasons));
    this.total = this.sum("isa");
    this.parts = { glsl: new Map(), spirv: new Map() }; // indices of ISA, by key
    this.isa.text.forEach((_, index) => {
      for (const kind of ["glsl", "spirv"]) {
        const key = this.keyOf(kind, index);
        if (key !== null) this.parts[kind].set(key, [...(this.parts[kind].get(key) ?? []), index]);
      }
    });
  }

  // Returns where instruction `index` comes from, or null where that is unknown.
  keyOf(kind, index) {
    if (kind === "isa") return index;
    const { file, line, spirv } = this.isa;
    if (kind === "glsl") return line[index] ? `${file[index]}:${line[index]}` : null;
    return spirv[index] || null;
  }
  charge(index, cost) {
    for (const kind of ["glsl", "spirv", "isa"]) {
      const key = this.keyOf(kind, index);
      this.costs[kind].set(key, (this.costs[kind].get(key) ?? new Cost(this.reasons)).add(cost));
    }
  }
  // Returns the sum over all lines of a pane, and what has no line there (key null).
  sum(kind, wanted = () => true) {
    const out = new Cost(this.reasons);
    for (const [key, cost] of this.costs[kind]) if (wanted(key)) out.add(cost);
    return out;
  }

  // Returns the keys in all three panes that belong to `key` in the pane `kind`.
  partners(kind, key) {
    const isa = kind === "isa" ? [key] : (this.parts[kind].get(key) ?? []);
    const glsl = new Set(kind === "glsl" ? [key] : isa.map((index) => this.keyOf("glsl", index)));
    const spirv = new Set(kind === "spirv" ? [key] : isa.map((index) => this.keyOf("spirv", index)));
    this.spirv.text.forEach((_, i) => {
      const place = this.spirv.line[i] ? `${this.spirv.file[i]}:${this.spirv.line[i]}` : null;
      const number = this.spirv.first + i;
      if (kind === "glsl" && place === key) spirv.add(number);
      if (kind === "spirv" && number === key) glsl.add(place);
    });
    glsl.delete(null);
    spirv.delete(null);
    return { glsl, spirv, isa: new Set(isa) };
  }

  // Returns the files with lines of this program as [number, cycles], the costliest first.
  filesByCycles() {
    const cycles = new Map();
    for (const key of this.parts.glsl.keys()) cycles.set(Number(key.split(":")[0]), 0);
    for (const [key, cost] of this.costs.glsl) {
      const file = key === null ? null : Number(key.split(":")[0]);
      if (file !== null) cycles.set(file, cycles.get(file) + cost.cycles);
    }
    return [...cycles].sort((a, b) => b[1] - a[1]);
  }
}
