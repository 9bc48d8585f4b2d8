// Plans `glint bench`: the workloads, the commands that run them, and which of them are already complete.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/bench/process_pool.h"
#include "apps/glint/bench/workloads.h"
#include "apps/glint/options/frame_options.h"
#include "apps/glint/options/sample_options.h"
#include "apps/glint/session.h"
#include "pipeline/run_profile.h"

namespace glint::app {

struct BenchOptions {
  std::vector<std::string> names;  // names for select_workloads(); none: lumibench
  std::string config = "mobile", mode = "timing", assets, out;
  std::vector<std::string> settings, oracles;  // KEY=VALUE, and as --oracle names them
  FrameOptions frame;
  bool small = false;                   // Compute programs run on their small input.
  uint32_t processes = 0, threads = 1;  // processes 0: one for each of the host's processors
  double memory = 0;                    // GB that all processes may take together; 0: what is available
  bool resume = false;
  uint64_t max_cycles = 0;        // limit of each launch; 0: none
  std::string stats = "full";     // "full" or "compact"
  pipeline::Observation observe;  // what each run notes
  SampleChoice sample;            // of pixels for scenes, of launches for programs and frames
};

struct BenchTask {
  NamedWorkload workload;
  std::string directory;
  Process process;
  bool is_complete = false;  // An earlier bench with the same key has run it.
};

struct BenchPlan {
  std::string directory, key;
  std::vector<BenchTask> tasks;
  std::vector<std::string> left_out;  // workloads whose scenes have no data in the assets folder
};

// Hashes the names and contents of the built-in shaders, so that edited shaders give new results.
uint64_t hash_of_shaders(const setup::Resources& resources);

// Plans a suite without making any file. Throws UserError for options that are impossible.
BenchPlan plan_bench(const Session& session, const BenchOptions& options);

// Marks a workload's run as complete with the file `workload.json`, which is written last.
void mark_complete(const BenchTask& task, const std::string& key, const Process& process);
// Removes the mark before the workload runs again.
void unmark(const BenchTask& task);

// Reads from a complete workload the seconds and the peak memory that mark_complete() noted.
void read_mark(const BenchTask& task, Process& process);

}  // namespace glint::app
