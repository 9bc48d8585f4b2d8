// Draws the cycles that schedulers spent in each shader stage, by reason. It needs a profile.
// SPDX-License-Identifier: Apache-2.0
import { percent } from "../format.js";
import { stacked } from "../kinds/stacked.js";
import { kGroups } from "./cpi_stack.js";

const kNames = { ray_generation: "ray generation", intersection: "intersection", any_hit: "any hit", closest_hit: "closest hit", miss: "miss", callable: "callable", compute: "compute" };

export const info = {
  id: "stage-cycles",
  wide: true,
  title: "Time by shader stage",
  note: "Bars are shares of all scheduler cycles. A cycle counts for the stage whose instruction issued in it, or whose warp was nearest to issue.",
};

export function make(runs) {
  const profiled = runs.filter((run) => run.data.profile?.stages.length);
  const rows = profiled.flatMap((run) => run.data.profile.stages.map((stage) => ({ run, stage, label: runs.length > 1 ? `${run.label}, ${kNames[stage.name] ?? stage.name}` : kNames[stage.name] ?? stage.name })));
  if (!rows.length) return null;
  const cycles = ({ run, stage }, reasons) => stage.slots.reduce((sum, value, i) => (reasons.includes(run.data.profile.reasons[i]) ? sum + value : sum), 0);
  return stacked({
    rows: rows.map((row) => row.label),
    parts: kGroups.map(({ name, colour, of }) => ({ name, colour, values: rows.map((row) => cycles(row, of)) })),
    unit: "scheduler cycles",
    whole: rows.map(({ stage }) => stage.cycles),
    scale: rows.map(({ run, stage }) => stage.cycles / run.part("gpu.core[*].issue_slots", () => true)),
    scaleFormat: (value) => percent(value, 0),
  });
}
