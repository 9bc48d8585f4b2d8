// Draws the nodes per ray against the depth of its structure (LumiBench, Figure 10).
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { measures } from "./shared.js";

export const info = {
  id: "traversal",
  title: "Traversal ratio",
  note: "The traversal ratio is the mean number of nodes that a ray visits for each level of the structure. It would be 1 on one straight way down.",
};

export function make(runs) {
  const list = [
    { name: "traversal ratio", colour: "blue", value: (run) => run.metric("traversal_ratio") },
    { name: "nodes per ray", colour: "orange", value: (run) => run.metric("avg_nodes_per_ray") },
    { name: "depth", colour: "grey", value: (run) => run.metric("bvh_depth") },
  ];
  return runs.some((run) => run.metric("traversal_ratio") !== null) ? measures(runs, list, { format: number }) : null;
}
