// Profile and time series of a run.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/observe_options.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <iterator>
#include <optional>

#include "base/diagnostics.h"
#include "report/profile_files.h"
#include "report/source_files.h"

namespace glint::app {
namespace {

std::optional<std::string> text_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

void add_observe_options(CLI::App& command, pipeline::Observation& observe) {
  command.add_flag("--profile", observe.profile, "Count by instruction and source line: profile.csv, profile.folded, source.json; 'glint annotate' shows it");
  command.add_option("--sample", observe.sample, "Write series.csv: IPC, RT warps, miss rates and DRAM use of every so many cycles")
      ->type_name("CYCLES")
      ->check(CLI::PositiveNumber);
}

void check_observation(const pipeline::Observation& observe, bool timing) {
  if (timing || (!observe.profile && observe.sample == 0)) return;
  throw UserError({}, "--profile and --sample need cycles, and the functional machine has none", "leave --mode functional out");
}

std::vector<std::string> write_observation(const pipeline::Observation& observe, const pipeline::RenderResult& result,
                                           const report::RunDirectory& directory) {
  std::vector<std::string> lines;
  if (observe.profile) {
    directory.write("profile.csv", report::profile_csv(result.profile));
    directory.write("profile.folded", report::profile_folded(result.profile, text_of));
    directory.write("source.json", report::source_json(report::source_map(result.profile.programs, text_of)));
    lines.push_back("profile    " + directory.path_of("profile.csv") + " (glint annotate " + directory.path() + ")");
  }
  if (observe.sample) {
    directory.write("series.csv", report::series_csv(result.series));
    lines.push_back("series     " + directory.path_of("series.csv"));
  }
  return lines;
}

}  // namespace glint::app
