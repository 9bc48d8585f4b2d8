// The statistics of both machines without a run: what there is, in which unit, and what it means.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "report/files/stat_rows.h"

namespace glint::app {

std::vector<report::StatRow> all_stats();  // an instance's number reads [*]; no values
std::string stat_list();                   // aligned columns
std::string stat_list_markdown();          // the table of docs/stats.md

}  // namespace glint::app
