// Reads the page's document. It undoes what report/page/columns.h did, run by run, and hands each run its pictures.
// SPDX-License-Identifier: Apache-2.0
import { unpacked } from "./packed.js";

// Returns the value of run `index` in a column. A column of one value stands for all runs.
const at = (column, index) => (column.length === 1 ? column[0] : column[index]) ?? null;

// Returns what each run has, as one object for each run.
function rows(columns, count) {
  const out = Array.from({ length: count }, () => ({}));
  for (const [name, column] of Object.entries(columns))
    for (let i = 0; i < count; ++i) {
      const value = at(column, i);
      if (value !== null) out[i][name] = value;
    }
  return out;
}

// Divides instance by instance. The number 0 stands for 0 in all instances, here and in the result.
function quotient(over, under) {
  if (over === 0 || under === 0) return 0;
  const size = Math.max(over.length, under.length);
  const out = Array.from({ length: size }, (_, i) => {
    const [a, b] = [at(over, i), at(under, i)];
    return b === 0 ? 0 : a / b;
  });
  return out.some((value) => value !== 0) ? out : 0;
}

function addQuotients(stats, quotients) {
  for (const [name, [over, under]] of Object.entries(quotients)) if (over in stats && under in stats) stats[name] = quotient(stats[over], stats[under]);
}

const turned = (columns) => (columns[0] ?? []).map((_, i) => columns.map((column) => column[i]));

// Returns slices ordered by their begin. A slice that others lie in comes before these.
function slicesOf({ slices, kinds }) {
  const ends = {}, depths = kinds.map((name) => ({ warp: 0, stage: 1 })[name] ?? 2);
  const rows = turned(slices).map(([thread, kind, gap, length, ...rest]) => {
    const key = `${kind} ${thread}`, begin = (ends[key] ?? 0) + gap;
    ends[key] = begin + length;
    return [thread, kind, begin, length, ...rest.filter((value) => value !== null)];
  });
  return rows.sort((a, b) => a[2] - b[2] || depths[a[1]] - depths[b[1]]);
}

function sourceOf({ counts, ...rest }, listings) {
  return { ...rest, ...listings[rest.listing], counts: turned(counts).map((row) => row.flat()) };
}

// Gives each run its pictures. The page has each picture once, where it is seen without script.
function givePictures(runs) {
  for (const [, run, map, source] of document.getElementById("pictures").textContent.matchAll(/<img alt="" data-run="(\d+)" data-map="([^"]*)" src="([^"]*)">/g)) {
    const { [run]: owner } = runs;
    if (map.startsWith("image:")) owner.images[Number(map.slice(6))].picture = source;
    else if (map) owner.heat.find(({ name }) => name === map).picture = source;
    else owner.picture = source;
  }
}

export async function readDocument() {
  const data = JSON.parse(await unpacked("data"));
  const [stats, metrics, config] = [data.stats, data.metrics, data.config].map((columns) => rows(columns, data.runs.length));
  data.runs.forEach((run, i) => {
    addQuotients(stats[i], data.quotients);
    Object.assign(run, { stats: stats[i], metrics: metrics[i], config: config[i] });
    if (run.source) run.source = sourceOf(run.source, data.listings);
    if (run.timeline) run.timeline.slices = slicesOf(run.timeline);
  });
  givePictures(data.runs);
  return data;
}
