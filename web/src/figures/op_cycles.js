// Draws the ops that schedulers waited at, run by run. It needs profiles. For a single run, ops.js draws them beside the counts.
// SPDX-License-Identifier: Apache-2.0
import { opShares } from "./ops.js";

export const info = {
  id: "op-cycles", coloured: true,
  title: "Scheduler cycles by op",
  note: "A cycle of a scheduler is charged to the op that issued in it, or to the one whose warp was nearest to issue.",
};

export const make = (runs) => (runs.filter((run) => run.data.profile).length > 1 ? opShares(runs, ["cycles"]) : null);
