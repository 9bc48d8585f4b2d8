// Reads the TOML file of an experiment.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/lab/experiment.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <functional>

#include "apps/glint/bench/workloads.h"
#include "apps/glint/options/image_size.h"
#include "base/diagnostics.h"
#include "pipeline/description/value.h"
#include "report/metrics/formula.h"

namespace glint::app {
namespace {

using pipeline::TableReader;
using pipeline::Value;

class ExperimentReader {
 public:
  explicit ExperimentReader(const std::string& path) : path_(path), file_(pipeline::read_toml(path)) {}

  Experiment read() {
    TableReader table(file_, "an experiment", errors_);
    Experiment out;
    out.name = std::filesystem::path(path_).stem().string();
    out.title = table.required_text("title");
    out.source = table.required_text("source");
    out.config = table.required_text("config");
    if (const Value* config = table.take("config")) out.config_where = config->where;
    out.settings = table.texts("set");
    out.workloads = table.texts("workloads");
    check(table, "workloads", [&] { select_workloads(out.workloads); });
    out.size = table.text("size", out.size);
    check(table, "size", [&] { parse_size(out.size, frame_); });
    out.samples = uint32_t(table.integer("spp", out.samples, 1, 65536));
    out.bounces = uint32_t(table.integer("bounces", out.bounces, 1, 1000));
    out.ao_reach = uint32_t(table.integer("ao_reach", out.ao_reach, 0, 100));
    out.pairs = table.flag("pairs", false);
    for (const Value* arm : table.tables("arm")) out.arms.push_back(read_arm(*arm, out.arms));
    table.finish();
    if (out.arms.empty() && !errors_.has_errors())
      errors_.error({path_}, "an experiment needs at least one [[arm]]");
    errors_.throw_if_errors();
    return out;
  }

 private:
  LabArm read_arm(const Value& value, const std::vector<LabArm>& before) {
    TableReader table(value, "an arm", errors_);
    LabArm out;
    out.name = table.required_text("name");
    out.against = table.text("against");
    out.settings = table.texts("set");
    out.workloads = table.texts("workloads");
    check(table, "workloads", [&] { select_workloads(out.workloads); });
    out.oracles = table.texts("oracle");
    if (const auto reach = table.optional_integer("ao_reach", 0, 100)) out.ao_reach = uint32_t(*reach);
    out.published = read_number(table, "published");
    out.expected = read_band(table, "expected");
    out.least = read_number(table, "least");
    for (const Value* figure : table.tables("figure")) out.figures.push_back(read_figure(*figure));
    table.finish();
    check_name(out, value, before);
    return out;
  }

  // The name of an arm is that of its folder, too.
  void check_name(const LabArm& arm, const Value& value, const std::vector<LabArm>& before) {
    const auto has = [&](const std::string& name) {
      return std::any_of(before.begin(), before.end(), [&](const LabArm& one) { return one.name == name; });
    };
    const bool is_plain = !arm.name.empty() && std::all_of(arm.name.begin(), arm.name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    });
    if (!is_plain)
      errors_.error(value.where, fmt::format("the arm '{}' needs a name of small letters, digits, '_', '-' "
                                             "and '.', because its folder has it",
                                             arm.name));
    if (has(arm.name)) errors_.error(value.where, fmt::format("there are two arms '{}'", arm.name));
    if (!arm.against.empty() && !has(arm.against))
      errors_.error(value.where, fmt::format("the arm '{}' is against '{}', which is no arm before it",
                                             arm.name, arm.against));
    const bool is_judged = arm.published || arm.expected || arm.least;
    if (arm.against.empty() && is_judged)
      errors_.error(value.where, fmt::format("the arm '{}' has a speed-up and no 'against'", arm.name));
  }

  LabFigure read_figure(const Value& value) {
    TableReader table(value, "a figure", errors_);
    LabFigure out;
    out.name = table.required_text("name");
    out.formula = table.required_text("formula");
    out.is_ratio = table.flag("ratio", false);
    out.published = read_number(table, "published");
    out.expected = read_band(table, "expected");
    table.finish();
    check_formula(out.formula, value);
    return out;
  }

  void check_formula(const std::string& formula, const Value& value) {
    check(value, [&] { report::paths_in(formula); });
  }

  // Reports at the value's place what its use would refuse.
  void check(const Value& value, const std::function<void()>& use) {
    try {
      use();
    } catch (const UserError& error) {
      const std::string what = error.what();  // It has no place of its own, and begins with "error: ".
      errors_.error(value.where, what.substr(what.find(' ') + 1));
    }
  }
  void check(TableReader& table, const std::string& key, const std::function<void()>& use) {
    if (const Value* value = table.take(key)) check(*value, use);
  }

  std::optional<double> read_number(TableReader& table, const std::string& key) {
    const Value* value = table.take(key);
    if (!value) return std::nullopt;
    if (value->is_number()) return value->real;
    errors_.error(value->where, fmt::format("'{}' must be a number", key));
    return std::nullopt;
  }

  std::optional<Band> read_band(TableReader& table, const std::string& key) {
    const Value* value = table.take(key);
    if (!value) return std::nullopt;
    const auto& list = value->list;
    if (list.size() == 2 && list[0].is_number() && list[1].is_number() && list[0].real <= list[1].real)
      return Band{list[0].real, list[1].real};
    errors_.error(value->where, fmt::format("'{}' must be two numbers, the smaller first", key));
    return std::nullopt;
  }

  const std::string path_;
  const Value file_;
  scenes::RenderParams frame_;
  Diagnostics errors_;
};

}  // namespace

Experiment read_experiment(const std::string& path) {
  return ExperimentReader(path).read();
}

}  // namespace glint::app
