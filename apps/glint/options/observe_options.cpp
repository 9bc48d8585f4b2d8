// Adds options for profile, time series, maps of cost and trace, and writes their files.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/observe_options.h"

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "base/diagnostics.h"
#include "setup/observation_files.h"

namespace glint::app {

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
  setup::ObservationFiles files = setup::write_observation(observe, result, directory);
  for (const std::string& warning : files.warnings) fmt::print(stderr, "warning: {}\n", warning);
  return std::move(files.lines);
}

}  // namespace glint::app
