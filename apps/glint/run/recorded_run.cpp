// Records and prints runs.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/recorded_run.h"

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "apps/glint/bench/progress_pipe.h"
#include "apps/glint/options/output.h"
#include "apps/glint/run/stop_signals.h"
#include "apps/glint/run/summary.h"
#include "report/files/stat_writer.h"
#include "report/terminal/progress.h"
#include "setup/recorded_launch.h"

namespace glint::app {

report::RunInfo new_run_info(const Session& session, const pipeline::GpuParams& gpu,
                             const std::string& config, const std::string& mode) {
  report::RunInfo info = setup::new_run_info(gpu, config, mode);
  info.command = session.arguments;
  for (const Plugin& plugin : session.plugins)
    info.plugins.emplace_back(plugin.path, fmt::format("{:016x}", plugin.hash));
  return info;
}

namespace {

// Adds why and when a launch was ended early.
void add_part(const pipeline::RenderResult& result, int signal, report::RunInfo& info) {
  const pipeline::LaunchProgress& at = result.progress;
  const bool is_stopped = result.end == pipeline::LaunchEnd::Stopped;
  info.part = {!is_stopped        ? "max_cycles"
               : signal == SIGINT ? "SIGINT"
                                  : "SIGTERM",
               at.cycles, at.ended_warps, at.num_warps, at.where};
  info.exit = is_stopped ? exit_code_of(signal) : int(kReachedMaxCycles);
  info.message = fmt::format("the launch was ended early{}, by {}: {} of {} warps have ended{}{}",
                             at.cycles ? fmt::format(" at cycle {}", at.cycles) : "",
                             is_stopped ? name_of_signal(signal) : "--max-cycles", at.ended_warps,
                             at.num_warps, at.where.empty() ? "" : ", and ", at.where);
}

}  // namespace

pipeline::RenderResult record_launch(const report::RunDirectory& directory, report::RunInfo& info,
                                     const std::function<pipeline::RenderResult()>& launch,
                                     const std::function<void(const pipeline::RenderResult&)>& keep,
                                     exec::PrintLog* prints) {
  return setup::record_launch(directory, info,
                              {.launch = launch,
                               .keep =
                                   [&](const pipeline::RenderResult& result) {
                                     if (result.end != pipeline::LaunchEnd::Whole)
                                       add_part(result, StopSignals::taken(), info);
                                     keep(result);
                                   },
                               .take_prints =
                                   [prints] {
                                     std::string printed = prints ? prints->take() : "";
                                     fmt::print(stderr, "{}", printed);
                                     return printed;
                                   }});
}

pipeline::RenderResult run_recorded(const Session& session, uint64_t max_cycles,
                                    const report::RunDirectory& directory, report::RunInfo& info,
                                    const RunLaunch& run,
                                    const std::function<void(const pipeline::RenderResult&)>& keep,
                                    exec::PrintLog* prints) {
  report::Progress progress(session.on_terminal ? stdout : nullptr, info.scene, session.terminal);
  ProgressPipe pipe(session.progress_descriptor, "rendering");
  // Before the launch begins, and when it has ended, signals end the process at once.
  std::optional<StopSignals> signals;
  pipeline::LaunchWatch watch;
  watch.progress = [&](const pipeline::LaunchProgress& at, const std::function<std::string()>& line) {
    progress.update(at.ended_warps, at.num_warps, {at.cycles, at.instructions},
                    [&] { return std::filesystem::path(line()).filename().string(); });
    pipe.update(at.ended_warps, at.num_warps);
  };
  watch.stop = [&] {
    if (!signals) signals.emplace();
    return StopSignals::taken() != 0;
  };
  watch.max_cycles = max_cycles;
  const auto launch = [&] {
    pipeline::RenderResult result = run(watch);
    signals.reset();
    return result;
  };
  return record_launch(directory, info, launch, keep, prints);
}

void note_not_finite(const std::string& file, const pictures::ImageView& image, const exec::ImageView& view,
                     const pipeline::RenderResult& result, report::RunInfo& info) {
  std::optional<report::NotFinite> found = report::not_finite(image);
  if (!found) return;
  // A picture has the slices and layers of an image below each other, which is how they lie in memory.
  const Address texel = view.address_of({.x = found->x}) + (view.address_of({.y = 1}) - view.base) * found->y;
  const auto& stores = result.not_finite.by_texel();
  if (const auto store = stores.find(texel); store != stores.end())
    found->stored_at = std::filesystem::path(result.store_lines.at(store->second.pc)).filename().string();
  info.not_finite.emplace_back(file, *found);
  fmt::print(stderr, "warning: {}: {}\n", file, report::text_of(*found, image));
}

Exit print_result(const Session& session, bool json, const pipeline::RenderJob& job,
                  const pipeline::RenderResult& result, const report::RunInfo& info, const std::string& title,
                  std::vector<std::string> files, std::span<const pipeline::Estimate> estimates) {
  if (!result.faults.empty()) fmt::print(stderr, "{}\n", result.faults.to_string());
  if (info.part) fmt::print(stderr, "warning: {}\n  note: all results are those up to there\n", info.message);
  if (json) {
    write_output("", Registry<report::StatWriter>::instance().entry("json").make_default({})->write(
                         result.statistics()));
    return Exit(info.exit);
  }
  report::Summary summary = summarise(job, result);
  if (info.sample) add_sample(*info.sample, estimates, summary);
  summary.title = title;
  summary.files = std::move(files);
  write_output("", report::format_summary(summary, session.terminal));
  return Exit(info.exit);
}

}  // namespace glint::app
