// Draws the speed-ups of an experiment: of each arm beside the published one, and on each workload.
// SPDX-License-Identifier: Apache-2.0
import { bars } from "../kinds/bars.js";
import { kMaxColours, runColour } from "../theme.js";

const factor = (value) => (value === null || value === undefined ? "" : value.toFixed(2));
const compared = (data) => data.arms.filter((arm) => arm.against && !arm.is_pair);

export const means = {
  info: { id: "lab-means", wide: true, title: "Speed-up of each arm", note: "Each value is a geometric mean over the workloads. Above 1 the arm is faster than its baseline." },
  make: (data) => {
    const arms = compared(data), hasPublished = arms.some((arm) => arm.published !== null);
    if (arms.length === 0) return null;
    const here = { name: "here", colour: "blue", values: arms.map((arm) => arm.here) };
    const paper = { name: "published", colour: "grey", values: arms.map((arm) => arm.published) };
    return bars({ rows: arms.map((arm) => arm.name), series: hasPublished ? [here, paper] : [here], format: factor });
  },
};

export const workloads = {
  info: { id: "lab-by-workload", wide: true, title: "Speed-up by workload", note: (data) => (compared(data).length > kMaxColours ? `The figure shows the first ${kMaxColours} arms.` : "") },
  make: (data) => {
    const arms = compared(data).slice(0, kMaxColours);
    const rows = [...new Set(arms.flatMap((arm) => arm.workloads.map((one) => one.workload)))];
    if (rows.length === 0) return null;
    const value = (arm, name) => arm.workloads.find((one) => one.workload === name)?.speedup ?? null;
    return bars({ rows, series: arms.map((arm, i) => ({ name: arm.name, colour: runColour(i), values: rows.map((name) => value(arm, name)) })), format: factor });
  },
};
