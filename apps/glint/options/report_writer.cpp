// Makes report pages of finished runs.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/report_writer.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "apps/glint/options/observe_options.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/report_inputs.h"
#include "apps/glint/options/run_files.h"
#include "apps/glint/session.h"
#include "report/files/config_file.h"
#include "report/files/run_facts.h"
#include "report/files/run_record.h"
#include "report/page/application.h"
#include "report/page/data.h"
#include "report/page/page.h"
#include "setup/config.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

constexpr size_t kMostLaunches = 50;              // of an application that have a report each
constexpr const char* kDefaultPreset = "mobile";  // the default of --config

// Returns the preset of Glint to compare a run's configuration with. It is the preset that the run names,
// else one with the same values, else the default. A user's file is never read again, because it may have
// changed since the run.
std::string preset_of(const setup::Resources& resources, const report::RunRecord& facts) {
  const std::vector<std::string> presets = resources.config_names();
  if (const std::string name = facts.text("config.name");
      std::find(presets.begin(), presets.end(), name) != presets.end())
    return name;
  for (const std::string& preset : presets)
    if (fmt::format("{:016x}", setup::config_hash(setup::read_preset(resources, preset))) ==
        facts.text("config.hash"))
      return preset;
  return kDefaultPreset;
}

report::PageRun page_run(const setup::Resources& resources, const std::string& directory) {
  report::PageRun run{.directory = directory, .preset_name = {}, .preset = {}};
  const std::string path = directory + "/run.json";
  if (!std::filesystem::exists(path)) return run;  // page_data() says what is wrong.
  report::RunRecord facts;
  facts.add_facts(report::read_run_facts(path).dump(), path);
  run.preset_name = preset_of(resources, facts);
  run.preset =
      report::config_file(describe_params(setup::read_preset(resources, run.preset_name)), run.preset_name);
  return run;
}

std::string page_of(const Session& session, const nlohmann::ordered_json& data) {
  const auto web = [&](const char* name) { return setup::read_file(session.resources.web_file(name)); };
  return report::page(data, {.frame = web("report.html"),
                             .style = web("report.css"),
                             .script = web("report.js"),
                             .unpack = web("unpack.js")});
}

// Returns a relative path as a link has it: bytes other than letters, digits and a few marks become %XX.
std::string link_of(const std::string& path) {
  std::string out;
  for (const char c : path) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                          std::string_view("/-._~=,+@").find(c) != std::string_view::npos;
    out += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

// Writes a report into the directory of each point of a sweep, and lets the points lead there from `path`.
void write_points(const Session& session, const std::vector<report::PageRun>& runs, const std::string& path,
                  ReportInputs& inputs) {
  const std::filesystem::path from = path == "-" ? "." : std::filesystem::absolute(path).parent_path();
  for (nlohmann::ordered_json& one : inputs.collections)
    for (nlohmann::ordered_json& point : one["points"]) {
      const std::string directory = point["directory"], file = directory + "/report.html";
      point["link"] = link_of(std::filesystem::proximate(file, from).generic_string());
      const auto run = std::find_if(runs.begin(), runs.end(),
                                    [&](const report::PageRun& each) { return each.directory == directory; });
      write_output(file, page_of(session, report::page_data({*run}, GLINT_VERSION)));
    }
}

// Writes a report of each launch of an application that was timed, as far as there are not too many, and says
// where it lies.
void write_launches(const Session& session, const std::string& path, nlohmann::ordered_json& one) {
  const std::filesystem::path from = path == "-" ? "." : std::filesystem::absolute(path).parent_path();
  const std::vector<std::string> folders = report::timed_folders(one["index"]);
  for (size_t i = 0; i < std::min(folders.size(), kMostLaunches); ++i) {
    const std::string directory = one["source"].get<std::string>() + "/" + folders[i],
                      file = directory + "/report.html";
    if (!std::filesystem::exists(directory + "/stats.json")) continue;  // totals alone, or not there any more
    write_output(
        file, page_of(session, report::page_data({page_run(session.resources, directory)}, GLINT_VERSION)));
    one["links"][folders[i]] = link_of(std::filesystem::proximate(file, from).generic_string());
  }
  if (folders.size() > kMostLaunches)
    fmt::print(
        stderr,
        "note: only the {} launches with the most cycles of {} have a report; `glint report` writes one of "
        "any launch's folder\n",
        kMostLaunches, folders.size());
}

}  // namespace

std::string make_report(const Session& session, const std::vector<std::string>& named, const std::string& out,
                        const std::optional<report::TimelineRequest>& timeline) {
  ReportInputs inputs = report_inputs(named);
  std::vector<report::PageRun> runs;
  for (const std::string& directory : inputs.runs) {
    runs.push_back(page_run(session.resources, directory));
    runs.back().timeline = timeline;
  }
  const std::string path = !out.empty() ? out
                           : named.size() == 1 && std::filesystem::is_directory(named[0])
                               ? named[0] + "/report.html"
                               : "report.html";
  nlohmann::ordered_json data = report::page_data(runs, GLINT_VERSION);
  write_points(session, runs, path, inputs);
  for (nlohmann::ordered_json& one : inputs.applications) write_launches(session, path, one);
  add_suites(inputs, data);
  tell_of_files(inputs.runs);
  write_output(path, page_of(session, data));
  return path;
}

Exit write_report(const Session& session, const std::vector<std::string>& named, const std::string& out,
                  const std::optional<report::TimelineRequest>& timeline) {
  const std::string path = make_report(session, named, out, timeline);
  if (path != "-") print_output("{}\n", path);
  return Exit::Ok;
}

}  // namespace glint::app
