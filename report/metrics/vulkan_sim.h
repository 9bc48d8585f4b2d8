// Prints a run's statistics under Vulkan-Sim's names, for tools that read its logs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "report/files/run_record.h"

namespace glint::report {

// Describes a line `name = value` of a log. When `formula` is "", Glint has no such number and `note` says
// why; otherwise `note` says what differs, if anything.
struct PeerStat {
  std::string_view name, formula, note;
};
std::span<const PeerStat> vulkan_sim_stats();

// Returns the lines of a log. Those without a value are at the end, as comments with the reason.
std::string vulkan_sim_text(const RunRecord& run);

std::string vulkan_sim_markdown();  // rows of docs/metrics.md

}  // namespace glint::report
