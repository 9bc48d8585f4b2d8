// Finds runs, characterisations and models in folders.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/report_inputs.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

#include "apps/glint/bench/tables.h"
#include "apps/glint/session.h"
#include "base/diagnostics.h"
#include "report/analytical/model_table.h"
#include "report/files/application_index.h"
#include "report/files/run_directory.h"
#include "report/files/run_record.h"
#include "report/page/lab.h"
#include "report/page/suite.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

namespace fs = std::filesystem;

// A characterisation needs at least this many runs (report/characterize/feature_table.h).
constexpr size_t kLeastRuns = 3;
// Cycles that differ relatively by less than this are the same, because tables have them to the last bit, or
// nearly.
constexpr double kCyclesTold = 1e-9;

void add_models(const std::string& path, const std::string& source, const std::string& folder,
                ReportInputs& out) {
  nlohmann::ordered_json document = report::models_json(report::parse_models(setup::read_file(path), path));
  document["source"] = source;
  out.models.push_back({folder, std::move(document)});
}

void add_characterization(const fs::path& file, const std::string& folder, ReportInputs& out) {
  out.characterizations.push_back(
      {folder, report::read_characterization(setup::read_file(file.string()), file.string())});
}

// Returns why a run cannot be shown, or "" when it is complete.
std::string why_incomplete(const fs::path& directory) {
  if (!fs::exists(directory / "run.json")) return "it has not been run";
  try {
    report::check_finished(directory.string());
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

nlohmann::ordered_json failure(const fs::path& directory, const std::string& reason) {
  return {{"name", directory.filename().string()}, {"reason", reason}};
}

nlohmann::ordered_json collection(const char* kind, const std::string& source) {
  const auto none = nlohmann::ordered_json::array();
  return {{"kind", kind}, {"source", source}, {"keys", none}, {"points", none}, {"failed", none}};
}

// Adds the points of a sweep that are complete, and names the others.
void add_sweep(const std::string& folder, ReportInputs& out) {
  const std::string path = folder + "/sweep.json";
  const auto plan = nlohmann::ordered_json::parse(setup::read_file(path), nullptr, false);
  const auto is_text = [](const auto& value) { return value.is_string(); };
  if (!plan.is_object() || !plan.contains("axes") || !plan["axes"].is_object() || !plan.contains("runs") ||
      !plan["runs"].is_array() || !std::all_of(plan["runs"].begin(), plan["runs"].end(), is_text))
    throw UserError({path, 0, 0}, "this is no plan of a sweep with its axes and runs",
                    "glint.sweep() in Python writes it: call it again");
  nlohmann::ordered_json one = collection("sweep", folder);
  for (const auto& [key, values] : plan["axes"].items()) one["keys"].push_back(key);
  for (const std::string name : plan["runs"]) {
    const fs::path point = fs::path(folder) / name;
    if (const std::string reason = why_incomplete(point); !reason.empty()) {
      one["failed"].push_back(failure(point, reason));
      continue;
    }
    out.runs.push_back(point.string());
    one["points"].push_back({{"name", name}, {"directory", point.string()}});
  }
  if (one["points"].empty())
    throw UserError({folder, 0, 0},
                    fmt::format("none of the {} points of the sweep is complete", one["failed"].size()),
                    "call glint.sweep() again: it goes on where it stopped");
  out.collections.push_back(std::move(one));
}

// Adds the launches or frames of a run that has a list of them, after the run itself, which has their sum.
void add_parts(const char* kind, const std::string& folder, const std::vector<std::string>& names,
               ReportInputs& out) {
  nlohmann::ordered_json one = collection(kind, folder);
  for (const std::string& name : names) {
    const fs::path launch = fs::path(folder) / name;
    if (const std::string reason = why_incomplete(launch); !reason.empty()) {
      one["failed"].push_back(failure(launch, reason));
      continue;
    }
    out.runs.push_back(launch.string());
    one["points"].push_back({{"name", name}, {"directory", launch.string()}});
  }
  if (!one["points"].empty()) out.collections.push_back(std::move(one));
}

void add_bench(const std::string& name, ReportInputs& out) {
  const fs::path folder(name);
  const std::vector<std::string> runs = bench_runs(name);
  const auto missing = [&](const char* command) {
    return SuiteInput{name, {{"source", name}, {"missing", fmt::format("{} {}", command, name)}}};
  };
  const bool has_models = fs::exists(folder / "models.csv"),
             has_characterization = fs::exists(folder / "characterization/characterization.json");
  if (runs.empty() && !has_models && !has_characterization)
    throw UserError({name, 0, 0}, "it has metrics.csv and no run directory", "'glint bench' writes both");
  out.runs.insert(out.runs.end(), runs.begin(), runs.end());
  nlohmann::ordered_json one = collection("bench", name);
  for (const std::string& directory : bench_contents(name).others) {
    const std::string reason = why_incomplete(directory);
    one["failed"].push_back(failure(
        directory, reason.empty() ? "this run is complete, but no bench of this folder made it" : reason));
  }
  out.collections.push_back(std::move(one));
  if (has_characterization)
    add_characterization(folder / "characterization/characterization.json", name, out);
  else if (runs.size() >= kLeastRuns)
    out.characterizations.push_back(missing("glint characterize"));
  if (has_models)
    add_models((folder / "models.csv").string(), name, name, out);
  else if (runs.size() >= kLeastRuns)
    out.models.push_back(missing("glint model"));
}

void add_named(const std::string& name, ReportInputs& out) {
  const fs::path path(name);
  const bool is_run = fs::exists(path / "run.json");
  const bool has_models = fs::exists(path / "models.csv");
  if (fs::is_regular_file(path)) return add_models(name, name, "", out);
  if (!is_run && report::is_application_folder(name)) {
    out.applications.push_back({{"source", name}, {"index", report::read_application(name)}});
    return;
  }
  if (!is_run && fs::exists(path / "lab.json")) {
    const std::string file = (path / "lab.json").string();
    out.labs.push_back(report::read_lab(setup::read_file(file), file));
    out.labs.back()["source"] = name;
    return;
  }
  if (!is_run && fs::exists(path / "characterization.json"))
    return add_characterization(path / "characterization.json", "", out);
  if (!is_run && fs::exists(path / "metrics.csv")) return add_bench(name, out);
  if (!is_run && fs::exists(path / "sweep.json")) return add_sweep(name, out);
  if (is_run || !has_models) out.runs.push_back(name);
  if (is_run) add_parts("launches", name, report::launches_of(name), out);
  if (is_run) add_parts("frames", name, report::frames_of(name), out);
  if (has_models) add_models((path / "models.csv").string(), name, name, out);
}

std::string full_path(const fs::path& path) {
  const std::string text = fs::weakly_canonical(path).string();
  return text.size() > 1 && text.ends_with('/') ? text.substr(0, text.size() - 1) : text;
}

// Counts the runs of the page whose cycles differ from those that a suite has for them.
int differing(const SuiteInput& suite, const nlohmann::ordered_json& runs) {
  const std::string folder = full_path(suite.folder);
  int out = 0;
  for (const nlohmann::ordered_json& one :
       suite.document.value("workloads", nlohmann::ordered_json::array())) {
    const nlohmann::ordered_json cycles = one.value("cycles", nlohmann::ordered_json());
    const std::string name = one.value("name", "");
    for (const nlohmann::ordered_json& run : runs) {
      const std::string directory = full_path(run["directory"].get<std::string>());
      const bool is_meant = directory == full_path(fs::path(folder) / name) ||
                            (directory == folder && fs::path(folder).filename() == name);
      if (!is_meant || !cycles.is_number() || !run["metrics"]["cycles"].is_number()) continue;
      const double is = run["metrics"]["cycles"], was = cycles;
      if (std::abs(is - was) > kCyclesTold * is) ++out;
    }
  }
  return out;
}

}  // namespace

ReportInputs report_inputs(const std::vector<std::string>& named) {
  ReportInputs out;
  for (const std::string& name : named) add_named(name, out);
  return out;
}

void add_suites(const ReportInputs& inputs, nlohmann::ordered_json& data) {
  const auto list = [&](const std::vector<SuiteInput>& suites) {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const SuiteInput& suite : suites) {
      out.push_back(suite.document);
      if (!suite.folder.empty()) out.back()["differing"] = differing(suite, data["runs"]);
    }
    return out;
  };
  data["collections"] = inputs.collections;
  data["characterizations"] = list(inputs.characterizations);
  data["models"] = list(inputs.models);
  data["labs"] = inputs.labs;
  data["applications"] = inputs.applications;
}

}  // namespace glint::app
