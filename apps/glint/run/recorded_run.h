// Records and prints every kind of run: run.json, which a failed run has, too, and the summary.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/glint/session.h"
#include "pipeline/render.h"
#include "report/files/run_directory.h"

namespace glint::app {

// Returns command, version, configuration and time of a run that begins now. The caller adds what it runs.
report::RunInfo new_run_info(const Session& session, const pipeline::GpuParams& gpu,
                             const std::string& config, const std::string& mode);

// Locks and marks the directory (RunDirectory::begin()), removes what an earlier run left and writes
// config.toml with the title, so that no older file can be taken for one of this run.
void begin_directory(report::RunDirectory& directory, const report::RunInfo& info,
                     const pipeline::GpuParams& gpu, const std::string& title);

// Calls `run` with the function that shows progress on the terminal under the name `what`, then `keep` to
// write the run's files. Writes run.json last. When one of the two throws, run.json has no results, and the
// error is passed on. What the shaders have printed goes to stderr and printf.txt.
using ShowProgress = std::function<void(uint64_t done, uint64_t total)>;
pipeline::RenderResult run_recorded(const Session& session, const std::string& what,
                                    const report::RunDirectory& directory, report::RunInfo& info,
                                    const std::function<pipeline::RenderResult(const ShowProgress&)>& run,
                                    const std::function<void(const pipeline::RenderResult&)>& keep,
                                    exec::PrintLog* prints = nullptr);

// Prints the faults that were let pass to stderr. Prints the statistics as JSON, or the summary of a run with
// lines about the files that it left.
void print_result(const Session& session, bool json, const pipeline::RenderJob& job,
                  const pipeline::RenderResult& result, const std::string& title,
                  std::vector<std::string> files);

}  // namespace glint::app
