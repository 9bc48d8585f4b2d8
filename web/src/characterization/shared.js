// What several figures of the characterisation need: a colour a cluster, a mark a shader set.
// SPDX-License-Identifier: Apache-2.0
import { kMaxColours, runColour } from "../theme.js";

// More clusters than colours are grey from there on: a colour that comes back would say what is not true.
export const clusterColour = (cluster) => (cluster < kMaxColours ? runColour(cluster) : "grey");

const kMarks = ["circle", "triangle", "rect", "diamond", "pin", "arrow"];

// Name and mark of every shader set, in order of appearance.
export function marks(data) {
  const names = [...new Set(data.workloads.map((one) => one.shader))];
  return names.map((name, i) => ({ name, mark: kMarks[i % kMarks.length] }));
}
