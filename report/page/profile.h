// Adds up the instructions of a profile for the report: by op, by stage and by source line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "base/profile_table.h"

namespace glint::report {

// Returns {"reasons", "ops", "stages", "lines"}. The lines are those that took most cycles, with their text
// where the file can still be read.
nlohmann::ordered_json page_profile(const ProfileTable& profile);

}  // namespace glint::report
