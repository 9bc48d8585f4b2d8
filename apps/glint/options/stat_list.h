// Lists the statistics of both machines without a run: name, unit and meaning.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "report/files/stat_rows.h"

namespace glint::app {

std::vector<report::StatRow> all_stats();  // without values; [*] stands for an instance's number
std::string stat_list();                   // aligned columns
std::string stat_list_markdown();          // the table of docs/stats.md

}  // namespace glint::app
