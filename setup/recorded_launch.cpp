// Records launches: the run directory of each, with run.json, which a failed launch has, too.
// SPDX-License-Identifier: Apache-2.0
#include "setup/recorded_launch.h"

#include <chrono>
#include <fmt/chrono.h>
#include <new>

#include "base/diagnostics.h"
#include "memsys/peak.h"
#include "setup/build_commit.h"
#include "setup/config.h"

namespace glint::setup {

report::RunInfo new_run_info(const pipeline::GpuParams& gpu, const std::string& config,
                             const std::string& mode) {
  report::RunInfo info;
  info.version = GLINT_VERSION;
  info.git = build_commit();
  info.compiler = __VERSION__;
  info.config = config;
  info.config_hash = config_hash(gpu);
  info.mode = mode;
  const mem::Peak peak = mem::peak(gpu.memory, gpu.cores, gpu.clock_mhz);
  info.memory_peaks = {
      {"l1_bytes", double(peak.l1_bytes)},          {"l1_bytes_per_second", peak.l1_bandwidth},
      {"network_bytes_per_second", peak.network()}, {"l2_bytes", double(peak.l2_bytes)},
      {"l2_bytes_per_second", peak.l2_bandwidth},   {"dram_bytes_per_second", peak.dram_bandwidth}};
  info.started =
      fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                  fmt::gmtime(std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  return info;
}

void begin_directory(report::RunDirectory& directory, const report::RunInfo& info,
                     const pipeline::GpuParams& gpu, const std::string& title) {
  directory.begin(info);
  directory.write_config(describe_params(gpu), "Resolved configuration of: " + title, info.compact);
}

namespace {

// Adds what run.json holds of the result.
void add_result(const pipeline::RenderResult& result, report::RunInfo& info) {
  for (const exec::FaultLog::Entry& fault : result.faults.in_order())
    info.faults.push_back({std::string(exec::name_of(fault.kind)), fault.first.place, fault.first.what,
                           fault.first.launch_id, fault.count});
  if (result.residency.warps > 0)
    info.residency = {result.residency.warps, result.residency.blocks,
                      std::string(name_of(result.residency.limit))};
}

void keep_prints(const Recorded& recorded, const report::RunDirectory& directory) {
  if (!recorded.take_prints) return;
  if (const std::string printed = recorded.take_prints(); !printed.empty())
    directory.write("printf.txt", printed);
}

}  // namespace

pipeline::RenderResult record_launch(const report::RunDirectory& directory, report::RunInfo& info,
                                     const Recorded& recorded) {
  const auto start = std::chrono::steady_clock::now();
  const auto stop_watch = [&] {
    info.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const auto fail = [&](Exit exit, const std::string& message) {
    if (info.wall_seconds == 0) stop_watch();
    info.exit = int(exit);
    info.message = message;
    // When two errors occur, the first one is told. A full disk has room again once the results are gone.
    try {
      directory.remove_results();
      keep_prints(recorded, directory);
      directory.write_run(info);
    } catch (const Error&) {
    }
  };
  try {
    pipeline::RenderResult result = recorded.launch();
    stop_watch();
    add_result(result, info);
    keep_prints(recorded, directory);
    recorded.keep(result);
    directory.write_run(info);
    return result;
  } catch (const Error& error) {
    fail(error.exit(), error.what());
    throw;
  } catch (const std::bad_alloc&) {
    fail(Exit::Failure, "out of memory");
    throw;
  }
}

}  // namespace glint::setup
