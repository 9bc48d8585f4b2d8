// Gathers everything that `glint report` shows of some runs as one JSON document, which the page's script
// draws.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "report/files/trace_files.h"

namespace glint::report {

// Names a run to show, and the preset that its configuration is compared with, as config_file() writes it.
struct PageRun {
  std::string directory;
  std::string preset_name, preset;
  // This is the timeline that was asked for. Without one, it is the middle of the trace's core 0, if there is
  // a trace.
  std::optional<TimelineRequest> timeline{};
};

// Returns {"schema", "version", "runs", "stat_docs", "metric_docs", "key_docs"}; docs/report.md has the
// fields. Optional files of a run (picture, series, profile, maps of cost, trace) are left out when they do
// not exist. Throws UserError that names the run when it was not finished, is not of the timing machine, or
// was written by another version of Glint.
nlohmann::ordered_json page_data(const std::vector<PageRun>& runs, const std::string& version);

}  // namespace glint::report
