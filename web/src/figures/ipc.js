// Draws instructions per cycle across configurations (LumiBench, Figure 14).
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { bars } from "../kinds/bars.js";
import { runColour } from "../theme.js";

export const info = { id: "ipc", wide: true, title: "IPC across configurations", note: "IPC counts the warp instructions of the whole GPU in a cycle." };

export function make(runs) {
  if (runs.length < 2) return null;
  const tasks = [...new Set(runs.map((run) => run.taskLabel))], configs = [...new Set(runs.map((run) => run.configLabel))];
  const of = (task, config) => runs.find((run) => run.taskLabel === task && run.configLabel === config)?.ipc ?? null;
  return bars({ rows: tasks, series: configs.map((config, i) => ({ name: config, colour: runColour(i), values: tasks.map((task) => of(task, config)) })), format: (value) => value?.toFixed(2) ?? "–", axis: number });
}
