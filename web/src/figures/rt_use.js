// Draws how full the RT unit and the warps were (LumiBench, Figure 9).
// SPDX-License-Identifier: Apache-2.0
import { percent } from "../format.js";
import { measures } from "./shared.js";

export const info = {
  id: "rt-use",
  title: "RT-unit occupancy and efficiency, SIMT efficiency",
  note: "Occupancy is the share of the unit’s warp slots that are in use while it has any warp. Efficiency is the share of its warps’ lanes with a ray in flight, and SIMT efficiency that of the lanes that execute an instruction.",
};

export function make(runs) {
  if (!runs.some((run) => run.metric("rt_occupancy") !== null)) return null;
  const list = [
    { name: "RT-unit occupancy", colour: "blue", value: (run) => run.metric("rt_occupancy") },
    { name: "RT-unit efficiency", colour: "orange", value: (run) => run.metric("rt_efficiency") },
    { name: "SIMT efficiency", colour: "green", value: (run) => run.metric("simt_efficiency") },
  ];
  return measures(runs, list, { format: (value) => percent(value), axis: (value) => percent(value, 0), max: 1 });
}
