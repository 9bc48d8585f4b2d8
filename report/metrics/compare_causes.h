// Says what differs between two runs beside their metrics: configuration keys, and what time was spent on.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "report/files/run_record.h"

namespace glint::report {

// Returns a line for each key whose value differs in the files config.toml `before` and `after`, or "". A
// key that only one of them has is "-" in the other.
std::string changed_keys_text(const std::string& before, const std::string& after);

// Returns tables of what issue slots and the cycles of RT units were spent on, as shares in both runs, the
// largest change first. Reasons that did not change, to a hundredth of a percent, are left out without `all`.
// Returns "" when nothing changed, or a run has no cycles.
std::string changed_stalls_text(const RunRecord& before, const RunRecord& after, bool all);

}  // namespace glint::report
