// Holds what several figures of the characterisation need: a colour for each cluster, and a mark for each shader set.
// SPDX-License-Identifier: Apache-2.0
import { kMaxColours, runColour } from "../theme.js";

// When there are more clusters than colours, the further ones are grey. A colour used twice would say that two clusters are one.
export const clusterColour = (cluster) => (cluster < kMaxColours ? runColour(cluster) : "grey");

const kMarks = ["circle", "triangle", "rect", "diamond", "pin", "arrow"];

// Returns name and mark of every shader set, in order of appearance.
export function marks(data) {
  const names = [...new Set(data.workloads.map((one) => one.shader))];
  return names.map((name, i) => ({ name, mark: kMarks[i % kMarks.length] }));
}
