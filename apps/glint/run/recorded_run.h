// Records and prints every kind of run: run.json, which a failed run has, too, and the summary.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "apps/glint/session.h"
#include "pipeline/render.h"
#include "pipeline/sampling/estimates.h"
#include "report/files/run_directory.h"

namespace glint::app {

// Returns command, plugins, version, configuration and time of a run that begins now. The caller adds what it
// runs.
report::RunInfo new_run_info(const Session& session, const pipeline::GpuParams& gpu,
                             const std::string& config, const std::string& mode);

// Calls `run` with a watch that shows progress on the terminal and ends the launch at `max_cycles` or at a
// signal to stop, then `keep` to write the run's files. Writes run.json last, which says how far a launch
// came that was ended early. When one of the two throws, run.json has no results, and the error is passed on.
// What the shaders have printed goes to stderr and printf.txt.
using RunLaunch = std::function<pipeline::RenderResult(const pipeline::LaunchWatch&)>;
pipeline::RenderResult run_recorded(const Session& session, uint64_t max_cycles,
                                    const report::RunDirectory& directory, report::RunInfo& info,
                                    const RunLaunch& run,
                                    const std::function<void(const pipeline::RenderResult&)>& keep,
                                    exec::PrintLog* prints = nullptr);

// Does the same for one launch of a list inside of `run`: calls `launch`, adds to `info` how it ended, then
// calls `keep` and writes run.json.
pipeline::RenderResult record_launch(const report::RunDirectory& directory, report::RunInfo& info,
                                     const std::function<pipeline::RenderResult()>& launch,
                                     const std::function<void(const pipeline::RenderResult&)>& keep,
                                     exec::PrintLog* prints = nullptr);

// Exit code of a run that --max-cycles has ended. Signals have the codes that shells give them.
inline constexpr Exit kReachedMaxCycles = Exit(6);

// Notes a picture's pixels that are not finite in `info`, and warns of them on stderr. `file` is the
// picture's name in the run directory, and `view` says where its texels lay. `result` knows which line stored
// the first such pixel.
void note_not_finite(const std::string& file, const pictures::ImageView& image, const exec::ImageView& view,
                     const pipeline::RenderResult& result, report::RunInfo& info);

// Prints the faults that were let pass to stderr. Prints the statistics as JSON, or the summary of a run with
// lines about the files that it left; of a sampled run, these are estimates of the whole launch. Returns the
// exit code that `info` has, and says why it is not 0.
Exit print_result(const Session& session, bool json, const pipeline::RenderJob& job,
                  const pipeline::RenderResult& result, const report::RunInfo& info, const std::string& title,
                  std::vector<std::string> files, std::span<const pipeline::Estimate> estimates = {});

}  // namespace glint::app
