// Stores tables of a run's document by columns: slices of its timeline, and counts of its source view.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

namespace glint::report {

// Returns page_timeline() with "slices" as columns, with null where a slice has no such number. Slices are
// ordered by kind and thread. Each begin is counted from the end of the slice before it in its kind and
// thread, and the first from the window's begin. They pack to a third of the rows.
nlohmann::ordered_json timeline_columns(const nlohmann::ordered_json& timeline);

// Returns the "counts" of page_source() as columns. The last is the list of pairs of each row.
nlohmann::ordered_json count_columns(const nlohmann::ordered_json& counts);

}  // namespace glint::report
