// Figure: instructions a cycle across configurations (LumiBench, Figure 14).
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { bars } from "../kinds/bars.js";
import { runColour } from "../theme.js";

export const info = { id: "ipc", wide: true, title: "IPC across configurations", note: "Warp instructions a cycle of the whole GPU." };

export function make(runs) {
  if (runs.length < 2) return null;
  const workloads = [...new Set(runs.map((run) => run.workload))], configs = [...new Set(runs.map((run) => run.configLabel))];
  const of = (workload, config) => runs.find((run) => run.workload === workload && run.configLabel === config)?.ipc ?? null;
  return bars({ rows: workloads, series: configs.map((config, i) => ({ name: config, colour: runColour(i), values: workloads.map((workload) => of(workload, config)) })), format: (value) => value?.toFixed(2) ?? "–", axis: number });
}
