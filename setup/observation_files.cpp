// Writes what a launch was watched for: profile, time series, maps of cost, trace.
// SPDX-License-Identifier: Apache-2.0
#include "setup/observation_files.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>

#include "report/files/heat_files.h"
#include "report/files/profile_files.h"
#include "report/files/source_files.h"
#include "report/files/trace_files.h"
#include "setup/resources.h"

namespace glint::setup {
namespace {

// Returns a number with its digits in groups: "1 234 567".
std::string grouped(uint64_t number) {
  std::string out = std::to_string(number);
  for (size_t at = out.size(); at > 3;) out.insert(at -= 3, " ");
  return out;
}

// Returns the cycles that a trace shows, as text. The machine goes on after the run's last cycle until its
// writes are in memory, and a trace may show that, too.
std::string shown_cycles(const TraceTable& trace, Cycle run_end) {
  if (trace.end <= run_end || trace.begin >= run_end)
    return fmt::format("of cycles {} to {}", trace.begin, trace.end);
  return fmt::format("of cycles {} to {}, and of writes on their way to memory until {}", trace.begin,
                     run_end, trace.end);
}

std::string warning_of_cut(const TraceTable& trace, Cycle window_end, Cycle run_end) {
  const Cycle wanted = trace.end < run_end ? std::min(trace.asked_end, run_end) : trace.asked_end;
  const std::string rest =
      fmt::format("{}:{}", trace.end, window_end > trace.asked_end ? "" : std::to_string(window_end));
  return fmt::format(
      "the trace ends at cycle {} instead of {}, because more would exceed the limit of {} events\nnote: "
      "--trace-limit raises the limit, and --trace-window {} goes on from there",
      trace.end, wanted, grouped(trace.limit), rest);
}

void write_trace(const TraceTable& trace, Cycle window_end, Cycle run_end,
                 const report::RunDirectory& directory, ObservationFiles& out) {
  directory.write("trace.json.gz", report::trace_json_gz(trace));
  if (trace.begin == trace.end && !trace.is_cut()) {
    out.warnings.push_back(
        fmt::format("the trace is empty: the run ended at cycle {}, and the window begins at {}\nnote: a "
                    "--trace-window that begins earlier has something to show",
                    run_end, trace.begin));
    out.lines.push_back(
        fmt::format("trace      {} (EMPTY: the run ended at cycle {}, before its window begins)",
                    directory.path_of("trace.json.gz"), run_end));
    return;
  }
  if (trace.is_cut()) out.warnings.push_back(warning_of_cut(trace, window_end, run_end));
  if (trace.counters_left_out)
    out.warnings.push_back(
        fmt::format("the trace is without {} counters of single units, because they would take more than "
                    "a quarter of {} events\nnote: --trace-limit raises the limit, and --sample makes their "
                    "intervals longer",
                    trace.counters_left_out, grouped(trace.limit)));
  out.lines.push_back(fmt::format("trace      {} ({} events {}{}; open it at ui.perfetto.dev)",
                                  directory.path_of("trace.json.gz"), grouped(report::num_events(trace)),
                                  shown_cycles(trace, run_end), trace.is_cut() ? ", CUT at the limit" : ""));
}

}  // namespace

ObservationFiles write_observation(const pipeline::Observation& observe, const pipeline::RenderResult& result,
                                   const report::RunDirectory& directory) {
  ObservationFiles out;
  if (observe.profile) {
    directory.write("profile.csv", report::profile_csv(result.profile));
    directory.write("profile.folded", report::profile_folded(result.profile, text_of_file));
    directory.write("source.json",
                    report::source_json(report::source_map(result.profile.programs, text_of_file)));
    out.lines.push_back("profile    " + directory.path_of("profile.csv") + " (glint annotate " +
                        directory.path() + ")");
  }
  if (observe.sample) {
    directory.write("series.csv", report::series_csv(result.series));
    out.lines.push_back("series     " + directory.path_of("series.csv"));
  }
  if (observe.heat) {
    for (const auto& [name, bytes] : report::heat_files(result.costs)) directory.write(name, bytes);
    out.lines.push_back(fmt::format("heat       {} ({} maps, .png and .npy)", directory.path_of("heat"),
                                    result.costs.size()));
  }
  if (observe.trace.wanted) write_trace(result.trace, observe.trace.end, result.cycles, directory, out);
  return out;
}

}  // namespace glint::setup
