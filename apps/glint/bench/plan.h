// What `glint bench` is to do: the workloads, the commands that run them, and which of them are complete
// already.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/bench/process_pool.h"
#include "apps/glint/bench/workloads.h"
#include "apps/glint/session.h"
#include "scenes/camera.h"

namespace glint::app {

struct BenchOptions {
  std::vector<std::string> names;  // of select_workloads(); none: lumibench
  std::string config = "mobile", size = "128x128", mode = "timing", assets, out;
  std::vector<std::string> settings;
  scenes::RenderParams frame;
  uint32_t processes = 0, threads = 1;  // 0 processes: one for each of the host's processors
  double memory = 0;                    // GB of all together; 0: what is available
  bool resume = false;
};

struct BenchTask {
  NamedWorkload workload;
  std::string directory;
  Process process;
  bool is_complete = false;  // from an earlier bench, with the same key
};

struct BenchPlan {
  std::string directory, key;
  std::vector<BenchTask> tasks;
};

// UserError for options that cannot be. Makes no file.
BenchPlan plan_bench(const Session& session, const BenchOptions& options);

// Notes beside a workload's run that it is complete: `workload.json`, the last file that is written.
void mark_complete(const BenchTask& task, const std::string& key, const Process& process);
// Removes the mark before the workload runs again.
void unmark(const BenchTask& task);

// Of a complete workload: seconds and peak memory that mark_complete() noted.
void read_mark(const BenchTask& task, Process& process);

}  // namespace glint::app
