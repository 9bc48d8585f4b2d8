// Figure: the instructions of each shader stage.
// SPDX-License-Identifier: Apache-2.0
import { percent } from "../format.js";
import { stacked } from "../kinds/stacked.js";
import { kClasses, rowsOf } from "./shared.js";

const kStages = [["raygen", "ray generation"], ["intersection", "intersection"], ["any_hit", "any hit"], ["closest_hit", "closest hit"], ["miss", "miss"], ["callable", "callable"], ["compute", "compute"]];
const path = (stage) => `gpu.core[*].${stage}.instructions`;

export const info = {
  id: "stages",
  wide: true,
  title: "Instructions by shader stage",
  note: "Share of a run’s warp instructions.",
};

export function make(runs) {
  const count = (run, stage) => run.part(path(stage), () => true);
  const used = kStages.map(([key, name]) => ({ key, name })).filter(({ key }) => runs.some((run) => count(run, key) > 0));
  const rows = rowsOf(runs, used).filter(({ run, kind }) => count(run, kind.key) > 0);
  if (!rows.length) return null;
  return stacked({
    rows: rows.map((row) => row.label),
    parts: kClasses.map(({ key, name, colour }) => ({ name, colour, values: rows.map(({ run, kind }) => run.sum(`${path(kind.key)}::${key}`) ?? 0) })),
    unit: "instructions",
    scale: rows.map(({ run, kind }) => count(run, kind.key) / run.sum("gpu.core[*].instructions")),
    scaleFormat: (value) => percent(value, 0),
  });
}
