// A run's statistics under the names that Vulkan-Sim prints, for tools that read its logs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "report/files/run_record.h"

namespace glint::report {

// A line `name = value` of a log. `formula` "" = Glint has no such number, `note` says why; else what
// differs, if anything.
struct PeerStat {
  std::string_view name, formula, note;
};
std::span<const PeerStat> vulkan_sim_stats();

// Lines as in a log; those without a value stand at the end as comments with the reason.
std::string vulkan_sim_text(const RunRecord& run);

std::string vulkan_sim_markdown();  // rows of docs/metrics.md

}  // namespace glint::report
