// Holds a run as the figures see it: sums over the instances of a unit, parts of breakdowns, metrics, keys.
// SPDX-License-Identifier: Apache-2.0

const kKeysInLabel = 2; // More keys are shown only where fewer would not tell runs apart.

export class Run {
  constructor(data, index, docs) {
    this.data = data;
    this.index = index;
    this.docs = docs;
    this.facts = data.run;
    this.label = ""; // labelRuns() sets it.
    this.breakdowns = new Map(); // their keys by path, in order
    for (const key of Object.keys(data.stats)) {
      const end = key.indexOf("::");
      if (end < 0) continue;
      const path = key.slice(0, end), keys = this.breakdowns.get(path);
      if (keys) keys.push(key);
      else this.breakdowns.set(path, [key]);
    }
  }

  // Returns the values of a statistic, one for each instance, or [] where the run has none.
  values(path) {
    const found = this.data.stats[path];
    return found === undefined ? [] : Array.isArray(found) ? found : [found];
  }
  has(path) {
    return path in this.data.stats;
  }
  // Returns the sum over all instances, or null where the run has no such statistic.
  sum(path) {
    const values = this.values(path);
    return values.length ? values.reduce((a, b) => a + b, 0) : null;
  }
  // Returns the parts of a breakdown by name, in order: {issued: 12, ...}.
  parts(path) {
    const out = {};
    for (const key of this.breakdowns.get(path) ?? []) out[key.slice(path.length + 2)] = this.sum(key);
    return out;
  }
  // Returns the sum of the parts that `wanted` takes.
  part(path, wanted) {
    return Object.entries(this.parts(path)).reduce((sum, [name, value]) => (wanted(name) ? sum + value : sum), 0);
  }
  // Returns the counts of a histogram over all instances.
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

  // Returns {value, low, high} of what a sampled run estimates of the whole one, or null.
  estimate(name) {
    const path = `gpu.sample.${name}`;
    return this.has(path) ? { value: this.sum(path), low: this.sum(`${path}_low`), high: this.sum(`${path}_high`) } : null;
  }
  get isSampled() {
    return Boolean(this.facts.sample);
  }
  // Cycles, seconds and IPC are those of the whole run, which a sampled one estimates.
  get cycles() {
    return this.estimate("cycles")?.value ?? this.sum("gpu.cycles");
  }
  get seconds() {
    return this.secondsOf(this.cycles);
  }
  secondsOf(cycles) {
    return cycles / (this.config("clock_mhz") * 1e6);
  }
  // Returns warp instructions per cycle of the whole GPU, as the terminal shows them.
  get ipc() {
    return this.estimate("ipc")?.value ?? ratio(this.sum("gpu.core[*].instructions"), this.cycles);
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

// Sets short names that tell the runs apart. They name what differs between the runs, and no more than needed.
// - `label` is the name of the run.
// - `taskLabel` says what ran: workload, size and samples.
// - `configLabel` says what it ran on: preset and changed keys. No two runs of one task have the same.
export function labelRuns(runs) {
  const differ = (of) => new Set(runs.map(of)).size > 1;
  const keys = [...new Set(runs.flatMap((run) => Object.keys(run.changes)))].filter((key) => differ((run) => run.config(key)));
  const count = fewestKeys(runs, keys);
  const presets = differ((run) => run.facts.config.name);
  for (const run of runs) {
    const task = [];
    if (run.size && differ((r) => r.size)) task.push(run.size);
    if (run.facts.samples && differ((r) => r.facts.samples)) task.push(`${run.facts.samples} spp`);
    const changed = keys.slice(0, count).filter((key) => key in run.changes).map((key) => `${key}=${run.config(key)}`);
    run.taskLabel = [run.workload, ...task].join(" · ");
    run.configLabel = [run.facts.config.name, ...changed].join(" ");
    const workload = runs.length === 1 || differ((r) => r.workload) ? [run.workload] : [];
    run.label = [...workload, ...(presets ? [run.facts.config.name] : []), ...task, ...changed].join(" · ") || run.facts.config.name;
  }
  numberRepeats(runs, "configLabel", (run) => `${run.taskLabel} on ${run.configLabel}`);
  const seen = (label) => runs.filter((run) => run.label === label).length;
  for (const run of [...runs].reverse()) if (seen(run.label) > 1) run.label += ` · ${run.data.directory.replace(/\/+$/, "").split("/").pop()}`;
  numberRepeats(runs, "label", (run) => run.label);
  return runs;
}

// Returns how many of the keys tell the same configurations apart as all of them do.
function fewestKeys(runs, keys) {
  const configs = (count) => new Set(runs.map((run) => [run.facts.config.name, ...keys.slice(0, count).map((key) => run.config(key))].join("\n"))).size;
  let count = Math.min(kKeysInLabel, keys.length);
  while (configs(count) < configs(keys.length)) ++count;
  return count;
}

// Adds a number behind the name of the second and later runs that are alike by `of`.
function numberRepeats(runs, name, of) {
  const met = {};
  const repeats = runs.map((run) => (met[of(run)] = (met[of(run)] ?? 0) + 1));
  runs.forEach((run, i) => {
    if (repeats[i] > 1) run[name] += ` (${repeats[i]})`;
  });
}

export function geometricMean(values) {
  const known = values.filter((value) => value > 0 && Number.isFinite(value));
  return known.length ? Math.exp(known.reduce((sum, value) => sum + Math.log(value), 0) / known.length) : null;
}
