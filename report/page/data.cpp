// Gathers run directories into the report's document.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/data.h"

#include <charconv>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "base/diagnostics.h"
#include "report/files/base64.h"
#include "report/files/config_rows.h"
#include "report/files/file_list.h"
#include "report/files/heat_files.h"
#include "report/files/profile_files.h"
#include "report/files/run_directory.h"
#include "report/files/run_facts.h"
#include "report/metrics/metrics.h"
#include "report/page/heat.h"
#include "report/page/profile.h"
#include "report/page/samples.h"
#include "report/page/source.h"
#include "report/page/stats.h"
#include "report/page/timeline.h"
#include "report/picture/image_compare.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

// Returns run.json of a run whose statistics can be shown.
Json facts_of(const std::string& directory) {
  if (!std::filesystem::is_directory(directory))
    throw UserError({}, fmt::format("'{}' is not a run directory", directory),
                    "`glint run SCENE --out DIRECTORY` makes one");
  const std::string path = directory + "/run.json";
  if (!std::filesystem::exists(path))
    throw UserError({path}, "there is no such file",
                    "the directory is not of a run, or the run was ended before it finished");
  Json facts = read_run_facts(path);
  if (const int schema = facts.value("schema", 0); schema != kRunSchema)
    throw UserError({path}, fmt::format("it has schema {}, expected {}", schema, kRunSchema),
                    "another version of Glint wrote it: run it again with this one");
  if (facts.value("exit", 0) != 0 && !facts.contains("partial"))
    throw UserError({path}, fmt::format("the run failed: {}", facts.value("message", "no message")),
                    "a report needs a run that finished");
  if (const std::string mode = facts.value("mode", ""); mode != "timing")
    throw UserError({path}, fmt::format("a run of mode '{}' has no cycles", mode),
                    "a report shows runs of the timing machine: --mode timing");
  for (const char* key : {"scene", "config"})
    if (!facts.contains(key))
      throw UserError({path}, fmt::format("there is no '{}'", key), "the file is damaged; run it again");
  return facts;
}

Json number_or_text(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && !text.empty()) return value;
  return text;
}

// Reads a CSV of numbers by column.
Json columns_of(const std::string& csv, const std::string& name) {
  std::istringstream in(csv);
  std::string line;
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  for (int row = 1; std::getline(in, line); ++row) {
    std::istringstream cells(line);
    std::string cell;
    size_t i = 0;
    for (; std::getline(cells, cell, ','); ++i) {
      if (row == 1) {
        names.push_back(cell);
        continue;
      }
      const Json value = number_or_text(cell);
      if (i >= names.size() || !value.is_number())
        throw UserError({name, row}, fmt::format("'{}' is not a number of a time series", cell));
      columns[i].push_back(value.get<double>());
    }
    if (row == 1)
      columns.resize(names.size());
    else if (i != names.size())
      throw UserError({name, row}, fmt::format("this row has {} cells, expected {}", i, names.size()));
  }
  Json out = Json::object();
  for (size_t i = 0; i < names.size(); ++i) out[names[i]] = columns[i];
  return out;
}

Json metrics_json(const RunRecord& record) {
  Json out = Json::object();
  for (const MetricValue& metric : metrics_of(record))
    out[std::string(metric.metric->name)] = metric.value ? Json(*metric.value) : Json(nullptr);
  return out;
}

void add_config(const PageRun& run, const std::string& toml, Json& out, Json& docs) {
  const std::vector<ConfigRow> rows = config_rows(toml);
  for (const ConfigRow& row : rows) {
    out["config"][row.key] = number_or_text(row.value);
    docs[row.key] = {{"unit", row.unit}, {"doc", row.doc}};
  }
  out["preset"] = {{"name", run.preset_name}, {"changes", Json::object()}};
  for (const ConfigChange& change : config_changes(rows, config_rows(run.preset)))
    out["preset"]["changes"][change.row.key] =
        change.preset.empty() ? Json(nullptr) : number_or_text(change.preset);
}

void add_timeline(const PageRun& run, const ListedFiles& files, Json& out) {
  const std::string path = run.directory + "/trace.json.gz";
  if (files.read("trace.json.gz"))
    out["timeline"] = page_timeline(read_timeline(path, run.timeline.value_or(TimelineRequest{})));
  else if (run.timeline)
    throw UserError({run.directory}, "the run has no trace, and so no timeline", "run it again with --trace");
}

// Adds the images that a pipeline saved as pictures, each once. PFM and EXR files are shown with 8 bits.
void add_images(const PageRun& run, const ListedFiles& files, Json& out) {
  const Json outputs = out["run"].value("outputs", Json::object());
  std::set<std::string> seen;
  Json images = Json::array();
  for (const auto& [file, output] : outputs.items()) {
    const bool is_png = file.ends_with(".png");
    if (!output.is_object() || !output.contains("name") || !output["name"].is_string() ||
        !output.contains("kind") || output["kind"] != "image" ||
        !(is_png || file.ends_with(".pfm") || file.ends_with(".exr")))
      continue;
    const std::string name = output["name"];
    const auto bytes = seen.contains(name) ? std::nullopt : files.read(file);
    if (!bytes) continue;
    const Picture picture = read_picture(run.directory + "/" + file);
    seen.insert(name);
    images.push_back({{"name", name},
                      {"file", file},
                      {"width", picture.width},
                      {"height", picture.height},
                      {"picture", "data:image/png;base64," + base64(is_png ? *bytes : png_of(picture))}});
  }
  if (!images.empty()) out["images"] = std::move(images);
}

Json run_json(const PageRun& run, Json& stat_docs, Json& key_docs) {
  const std::string& directory = run.directory;
  Json out = {{"directory", directory}, {"run", facts_of(directory)}};
  check_full_statistics(directory, "a report");
  const ListedFiles files = ListedFiles::of_run(directory);
  out["run"].erase("files");  // The page has their contents.
  out["stats"] = page_stats(json_object(files.need("stats.json"), directory + "/stats.json"), stat_docs);
  if (!out["stats"].contains("gpu.cycles"))
    throw UserError({directory + "/stats.json"}, "the statistics have no gpu.cycles",
                    "another version of Glint wrote it: run it again with this one");
  out["metrics"] = metrics_json(RunRecord::read(directory));
  add_config(run, files.need("config.toml"), out, key_docs);
  if (const auto csv = files.read("series.csv")) out["series"] = columns_of(*csv, directory + "/series.csv");
  if (const auto csv = files.read("profile.csv")) {
    const ProfileTable profile = parse_profile(*csv, directory + "/profile.csv");
    out["profile"] = page_profile(profile);
    if (const auto source = files.read("source.json"))
      out["source"] = page_source(profile, parse_source(*source, directory + "/source.json"));
  }
  if (const std::vector<CostMap> maps = read_heat(files); !maps.empty()) out["heat"] = page_heat(maps);
  add_timeline(run, files, out);
  add_images(run, files, out);
  if (const auto png = files.read("image.png")) out["picture"] = "data:image/png;base64," + base64(*png);
  return out;
}

}  // namespace

nlohmann::ordered_json page_data(const std::vector<PageRun>& runs, const std::string& version) {
  Json stat_docs = Json::object(), key_docs = Json::object(), list = Json::array(),
       metric_docs = Json::array();
  for (const PageRun& run : runs) list.push_back(run_json(run, stat_docs, key_docs));
  for (const MetricGroup& group : metric_groups())
    for (const Metric& metric : group.metrics)
      metric_docs.push_back({{"name", metric.name},
                             {"unit", metric.unit},
                             {"doc", metric.doc},
                             {"group", group.title},
                             {"paper", metric.paper},
                             {"known", !metric.formula.empty()}});
  Json sample_changes = page_sample_changes(list);
  return {{"schema", 2},
          {"version", version},
          {"sample_changes", std::move(sample_changes)},
          {"runs", std::move(list)},
          {"stat_docs", std::move(stat_docs)},
          {"metric_docs", std::move(metric_docs)},
          {"key_docs", std::move(key_docs)},
          {"heat_scale", page_heat_scale()}};
}

}  // namespace glint::report
