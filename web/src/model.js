// A run as the figures see it: sums over the instances of a unit, parts of breakdowns, metrics, keys.
// SPDX-License-Identifier: Apache-2.0

const kKeysInLabel = 2; // more would not be read

export class Run {
  constructor(data, index, docs) {
    this.data = data;
    this.index = index;
    this.docs = docs;
    this.facts = data.run;
    this.label = ""; // set by labelRuns()
  }

  // The values of a statistic, one an instance; [] where the run has none.
  values(path) {
    const found = this.data.stats[path];
    return found === undefined ? [] : Array.isArray(found) ? found : [found];
  }
  has(path) {
    return path in this.data.stats;
  }
  // Over all instances; null where the run has no such statistic.
  sum(path) {
    const values = this.values(path);
    return values.length ? values.reduce((a, b) => a + b, 0) : null;
  }
  // The parts of a breakdown by name, in order: {issued: 12, ...}.
  parts(path) {
    const out = {};
    for (const key of Object.keys(this.data.stats)) if (key.startsWith(path + "::")) out[key.slice(path.length + 2)] = this.sum(key);
    return out;
  }
  // The sum of the parts that `wanted` takes.
  part(path, wanted) {
    return Object.entries(this.parts(path)).reduce((sum, [name, value]) => (wanted(name) ? sum + value : sum), 0);
  }
  // Counts of a histogram over all instances.
  histogram(path) {
    const out = [];
    for (const bins of this.values(path)) if (Array.isArray(bins)) bins.forEach((count, i) => (out[i] = (out[i] ?? 0) + count));
    return Array.from(out, (count) => count ?? 0);
  }
  bins(path) {
    return this.docs[path]?.bins ?? null;
  }
  metric(name) {
    return this.data.metrics[name] ?? null;
  }
  config(key) {
    return this.data.config[key];
  }

  get cycles() {
    return this.sum("gpu.cycles");
  }
  get seconds() {
    return this.cycles / (this.config("clock_mhz") * 1e6);
  }
  // Warp instructions a cycle of the whole GPU, as the terminal shows it.
  get ipc() {
    return ratio(this.sum("gpu.core[*].instructions"), this.cycles);
  }
  get workload() {
    const { scene, shader } = this.facts;
    return shader && shader !== scene.name ? `${scene.name} ${shader}` : scene.name;
  }
  get size() {
    return this.facts.width ? `${this.facts.width}×${this.facts.height}` : "";
  }
  get changes() {
    return this.data.preset.changes;
  }
}

export function ratio(a, b) {
  return a === null || b === null || !b ? null : a / b;
}

// Short names that tell the runs apart: of what differs between them, and no more than needed.
export function labelRuns(runs) {
  const differ = (of) => new Set(runs.map(of)).size > 1;
  const keys = [...new Set(runs.flatMap((run) => Object.keys(run.changes)))].filter((key) => differ((run) => run.config(key)));
  for (const run of runs) {
    const words = [];
    if (runs.length === 1 || differ((r) => r.workload)) words.push(run.workload);
    if (differ((r) => r.facts.config.name)) words.push(run.facts.config.name);
    if (differ((r) => r.size)) words.push(run.size);
    if (differ((r) => r.facts.samples)) words.push(`${run.facts.samples} spp`);
    for (const key of keys.slice(0, kKeysInLabel)) words.push(`${key}=${run.config(key)}`);
    run.label = words.join(" · ") || run.facts.config.name;
    run.configLabel = [run.facts.config.name, ...keys.slice(0, kKeysInLabel).map((key) => `${key}=${run.config(key)}`)].join(" ");
  }
  const seen = (label) => runs.filter((run) => run.label === label).length;
  for (const run of [...runs].reverse()) if (seen(run.label) > 1) run.label += ` · ${run.data.directory.replace(/\/+$/, "").split("/").pop()}`;
  return runs;
}

export function geometricMean(values) {
  const known = values.filter((value) => value > 0 && Number.isFinite(value));
  return known.length ? Math.exp(known.reduce((sum, value) => sum + Math.log(value), 0) / known.length) : null;
}
