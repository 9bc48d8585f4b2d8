// Writes what a launch was watched for: profile, time series, maps of cost, trace.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "pipeline/render.h"
#include "report/files/run_directory.h"

namespace glint::setup {

// Says what was written, a line for each file, and what a user may miss in it.
struct ObservationFiles {
  std::vector<std::string> lines, warnings;
};

// Writes the files that `observe` asks for into the directory of a run.
ObservationFiles write_observation(const pipeline::Observation& observe, const pipeline::RenderResult& result,
                                   const report::RunDirectory& directory);

}  // namespace glint::setup
