// Adds options for profile, time series, maps of cost and trace, and writes their files.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/observe_options.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <optional>

#include "base/diagnostics.h"
#include "report/files/heat_files.h"
#include "report/files/profile_files.h"
#include "report/files/source_files.h"
#include "report/files/trace_files.h"
#include "setup/resources.h"

namespace glint::app {
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

void warn_of_cut(const TraceTable& trace, Cycle window_end, Cycle run_end) {
  const Cycle wanted = trace.end < run_end ? std::min(trace.asked_end, run_end) : trace.asked_end;
  const std::string rest =
      fmt::format("{}:{}", trace.end, window_end > trace.asked_end ? "" : std::to_string(window_end));
  fmt::print(stderr,
             "warning: the trace ends at cycle {} instead of {}, because more would exceed the limit of {} "
             "events\nnote: --trace-limit raises the limit, and --trace-window {} goes on from there\n",
             trace.end, wanted, grouped(trace.limit), rest);
}

std::string write_trace(const TraceTable& trace, Cycle window_end, Cycle run_end,
                        const report::RunDirectory& directory) {
  directory.write("trace.json.gz", report::trace_json_gz(trace));
  if (trace.begin == trace.end && !trace.is_cut()) {
    fmt::print(stderr,
               "warning: the trace is empty: the run ended at cycle {}, and the window begins at {}\nnote: a "
               "--trace-window that begins earlier has something to show\n",
               run_end, trace.begin);
    return fmt::format("trace      {} (EMPTY: the run ended at cycle {}, before its window begins)",
                       directory.path_of("trace.json.gz"), run_end);
  }
  const std::string events = grouped(report::num_events(trace));
  if (trace.is_cut()) warn_of_cut(trace, window_end, run_end);
  if (trace.counters_left_out)
    fmt::print(stderr,
               "warning: the trace is without {} counters of single units, because they would take more than "
               "a quarter of {} events\nnote: --trace-limit raises the limit, and --sample makes their "
               "intervals longer\n",
               trace.counters_left_out, grouped(trace.limit));
  return fmt::format("trace      {} ({} events {}{}; open it at ui.perfetto.dev)",
                     directory.path_of("trace.json.gz"), events, shown_cycles(trace, run_end),
                     trace.is_cut() ? ", CUT at the limit" : "");
}

}  // namespace

Option add_cycle_window(Command command, const std::string& name, const std::string& doc, Cycle& begin,
                        Cycle& end) {
  const auto read = [&begin, &end](const std::string& text) -> std::string {
    const auto refusal = [&](const char* what) {
      return fmt::format("'{}' {}: expected FROM:TO in cycles, such as 10000:20000; FROM: goes up to the end",
                         text, what);
    };
    const auto number = [](const std::string& part, Cycle otherwise) -> std::optional<Cycle> {
      Cycle value = otherwise;
      const auto [last, error] = std::from_chars(part.data(), part.data() + part.size(), value);
      if (!part.empty() && (error != std::errc{} || last != part.data() + part.size())) return std::nullopt;
      return value;
    };
    const size_t colon = text.find(':');
    if (colon == std::string::npos) return refusal("has no ':'");
    const auto from = number(text.substr(0, colon), 0), to = number(text.substr(colon + 1), kNever);
    if (!from || !to) return refusal("is not a pair of numbers");
    begin = *from, end = *to;
    return begin >= end ? refusal("ends before it begins") : "";
  };
  return command.add_parsed_option(name, read, doc).type_name("FROM:TO");
}

void add_observe_options(Command command, pipeline::Observation& observe) {
  command.add_flag("--profile", observe.profile,
                   "Count by instruction and source line, and write profile.csv, profile.folded and "
                   "source.json; 'glint annotate' shows them");
  command
      .add_option(
          "--sample", observe.sample,
          "Write series.csv with IPC, RT warps, miss rates and DRAM use of each interval of this many cycles")
      .type_name("CYCLES")
      .positive();
  command.add_flag("--heat", observe.heat,
                   "Write maps of what each pixel cost to heat/*.png and *.npy (cycles, rays, nodes, "
                   "divergence, misses ...); functional runs have only the maps without cycles");
  Option trace = command.add_flag("--trace", observe.trace.wanted,
                                  "Write trace.json.gz for Perfetto with warps, shader stages, waits and RT "
                                  "units by cycle, and with counters");
  add_cycle_window(command, "--trace-window", "Cycles that the trace shows", observe.trace.begin,
                   observe.trace.end)
      .needs(trace);
  command
      .add_option("--trace-limit", observe.trace.limit,
                  "Largest number of events in a trace; a trace with more is cut off there, with a warning")
      .type_name("EVENTS")
      .in_range(uint64_t{1}, uint64_t{100'000'000})
      .capture_default_str()
      .needs(trace);
}

std::vector<std::string> observe_arguments(const pipeline::Observation& observe) {
  std::vector<std::string> out;
  if (observe.profile) out.push_back("--profile");
  if (observe.sample) out.push_back(fmt::format("--sample={}", observe.sample));
  if (observe.heat) out.push_back("--heat");
  if (!observe.trace.wanted) return out;
  out.push_back("--trace");
  out.push_back(fmt::format("--trace-limit={}", observe.trace.limit));
  const std::string end = observe.trace.end == kNever ? "" : std::to_string(observe.trace.end);
  if (observe.trace.begin > 0 || !end.empty())
    out.push_back(fmt::format("--trace-window={}:{}", observe.trace.begin, end));
  return out;
}

bool observes(const pipeline::Observation& observe) {
  return observe.profile || observe.sample || observe.heat || observe.trace.wanted;
}

void check_observation(const pipeline::Observation& observe, bool timing) {
  if (timing || (!observe.profile && observe.sample == 0 && !observe.trace.wanted)) return;
  throw UserError({}, "--profile, --sample and --trace need cycles, and the functional machine has none",
                  "leave out --mode functional");
}

std::vector<std::string> write_observation(const pipeline::Observation& observe,
                                           const pipeline::RenderResult& result,
                                           const report::RunDirectory& directory) {
  std::vector<std::string> lines;
  if (observe.profile) {
    directory.write("profile.csv", report::profile_csv(result.profile));
    directory.write("profile.folded", report::profile_folded(result.profile, setup::text_of_file));
    directory.write("source.json",
                    report::source_json(report::source_map(result.profile.programs, setup::text_of_file)));
    lines.push_back("profile    " + directory.path_of("profile.csv") + " (glint annotate " +
                    directory.path() + ")");
  }
  if (observe.sample) {
    directory.write("series.csv", report::series_csv(result.series));
    lines.push_back("series     " + directory.path_of("series.csv"));
  }
  if (observe.heat) {
    for (const auto& [name, bytes] : report::heat_files(result.costs)) directory.write(name, bytes);
    lines.push_back(fmt::format("heat       {} ({} maps, .png and .npy)", directory.path_of("heat"),
                                result.costs.size()));
  }
  if (observe.trace.wanted)
    lines.push_back(write_trace(result.trace, observe.trace.end, result.cycles, directory));
  return lines;
}

}  // namespace glint::app
