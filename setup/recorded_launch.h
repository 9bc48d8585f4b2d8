// Records launches: the run directory of each, with run.json, which a failed launch has, too.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "pipeline/render.h"
#include "report/files/run_directory.h"

namespace glint::setup {

// Returns version, configuration, peaks of the memory and time of a run that begins now. `config` is the name
// of the configuration. The caller adds the command and what it runs.
report::RunInfo new_run_info(const pipeline::GpuParams& gpu, const std::string& config,
                             const std::string& mode);

// Locks and marks the directory (RunDirectory::begin()), removes what an earlier run left and writes
// config.toml with the title, so that no older file can be taken for one of this run.
void begin_directory(report::RunDirectory& directory, const report::RunInfo& info,
                     const pipeline::GpuParams& gpu, const std::string& title);

// Says what to do around a launch.
struct Recorded {
  std::function<pipeline::RenderResult()> launch;
  // Writes the launch's files. It may add to `info` what run.json shall hold besides.
  std::function<void(const pipeline::RenderResult&)> keep;
  // Takes what the shaders have printed, which goes to printf.txt. Nothing: they cannot print.
  std::function<std::string()> take_prints = {};
};

// Launches, adds to `info` how the launch ended, keeps its files, and writes run.json last. When one of these
// throws, run.json has the error and no results, and the error is passed on.
pipeline::RenderResult record_launch(const report::RunDirectory& directory, report::RunInfo& info,
                                     const Recorded& recorded);

}  // namespace glint::setup
