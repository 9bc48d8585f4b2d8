// Tables of a run's document - slices of its timeline, counts of its source view - as a page stores them: by
// columns.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

namespace glint::report {

// page_timeline() with "slices" as columns, null where a slice has no such number: by kind and thread, one
// after the other, each begin counted from the end of the one before it in its kind and thread (the first
// from the window's begin). They pack to a third of the rows.
nlohmann::ordered_json timeline_columns(const nlohmann::ordered_json& timeline);

// The "counts" of page_source() as columns; the last is the list of pairs of each row.
nlohmann::ordered_json count_columns(const nlohmann::ordered_json& counts);

}  // namespace glint::report
