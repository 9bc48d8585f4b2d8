// Lists the statistics of both machines without a run: name, unit and meaning.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "report/files/stat_rows.h"

namespace glint::app {

// Returns rows without values, in which [*] stands for the number of an instance.
std::vector<report::StatName> all_stats();
// Returns the list in aligned columns.
std::string stat_list();
// Returns the table of docs/stats.md.
std::string stat_list_markdown();

}  // namespace glint::app
