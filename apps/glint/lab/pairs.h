// Combines the arms of an experiment in pairs, and shows their speed-ups as a matrix.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/lab/experiment.h"
#include "apps/glint/lab/results.h"
#include "setup/resources.h"

namespace glint::app {

// Names two arms that do not go together, and says why.
struct RefusedPair {
  std::string first, second, reason;
};

// Adds the arm "a+b" for each two arms with the same baseline, with the settings of both. Returns the pairs
// that no machine can have: the configuration refuses them, or both arms change the same key. Throws
// UserError when a single arm is refused.
std::vector<RefusedPair> add_pairs(const setup::Resources& resources, Experiment& experiment);

// Returns the geometric means of the speed-ups by two arms, those of single arms on the diagonal, and below
// them why pairs are refused. An empty text: the experiment has no pairs.
std::string pair_table(const std::vector<LabResult>& results, const std::vector<RefusedPair>& refused);

}  // namespace glint::app
