// Draws the instructions of each shader stage and their latency, by class (LumiBench, Figure 8, stage by stage).
// SPDX-License-Identifier: Apache-2.0
import { panels } from "../kinds/panels.js";
import { kClasses, rowsOf } from "./shared.js";

const kStages = [["raygen", "ray generation"], ["intersection", "intersection"], ["any_hit", "any hit"], ["closest_hit", "closest hit"], ["miss", "miss"], ["callable", "callable"], ["compute", "compute"]];
const kMeasures = [
  { name: "by count", unit: "instructions", part: "instructions" },
  { name: "by latency", unit: "cycles", part: "latency" },
];
const path = (stage, measure) => `gpu.core[*].${stage}.${measure.part}`;

export const info = {
  id: "stages",
  wide: true,
  title: "Instruction mix by shader stage",
  note: "Bars are shares of a run’s warp instructions, and of the sum of their cycles from issue to completion, in which those of one warp overlap. An instruction is of the stage whose code it stands in; a trace’s time is of the stage that traces.",
};

export function make(runs) {
  const used = kStages.map(([key, name]) => ({ key, name })).filter(({ key }) => runs.some((run) => count(run, key) > 0));
  const rows = rowsOf(runs, used).filter(({ run, kind }) => count(run, kind.key) > 0);
  if (!rows.length) return null;
  const known = kMeasures.filter((measure) => rows.every(({ run, kind }) => run.has(`${path(kind.key, measure)}::alu`)));
  return panels({
    rows: rows.map((row) => row.label),
    parts: kClasses,
    panels: known.map((measure) => ({
      ...measure,
      values: kClasses.map(({ key }) => rows.map(({ run, kind }) => run.sum(`${path(kind.key, measure)}::${key}`))),
      wholes: rows.map(({ run }) => kStages.reduce((sum, [key]) => sum + run.part(path(key, measure), () => true), 0)),
    })),
  });
}

const count = (run, stage) => run.part(path(stage, kMeasures[0]), () => true);
