// Writes the report page of runs, suites and experiments.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/glint/session.h"
#include "report/files/trace_files.h"

namespace glint::app {

// Writes the page about what is named (report_inputs.h) to `out`, "-" for stdout. An empty `out` means
// report.html in the only named folder, or here. Returns the page's path. Throws UserError for what cannot be
// shown.
std::string make_report(const Session& session, const std::vector<std::string>& named, const std::string& out,
                        const std::optional<report::TimelineRequest>& timeline);
// Does the same, and prints the path.
Exit write_report(const Session& session, const std::vector<std::string>& named, const std::string& out,
                  const std::optional<report::TimelineRequest>& timeline);

}  // namespace glint::app
