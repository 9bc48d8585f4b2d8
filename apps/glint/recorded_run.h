// What every kind of run leaves behind and prints: run.json, also of a run that failed, and the summary.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/glint/session.h"
#include "pipeline/render.h"
#include "report/run_directory.h"

namespace glint::app {

// Command, version, configuration and time of a run that begins now; what it runs is the caller's to add.
report::RunInfo new_run_info(const Session& session, const pipeline::GpuParams& gpu, const std::string& config, const std::string& mode);

// Calls `run` with the function that shows progress on the terminal, under the name `what`. Writes run.json when it has
// ended; an error leaves one too, and is passed on. What the shaders have printed goes to stderr and printf.txt.
using ShowProgress = std::function<void(uint64_t done, uint64_t total)>;
pipeline::RenderResult run_recorded(const Session& session, const std::string& what, const report::RunDirectory& directory,
                                    report::RunInfo& info, const std::function<pipeline::RenderResult(const ShowProgress&)>& run,
                                    core::PrintLog* prints = nullptr);

// The faults that were let pass on stderr; statistics as JSON, or the summary of a run with lines about the files that it left.
void print_result(const Session& session, bool json, const pipeline::RenderJob& job, const pipeline::RenderResult& result,
                  const std::string& title, std::vector<std::string> files);

}  // namespace glint::app
