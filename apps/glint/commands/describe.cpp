// Declares `glint describe NAME`, which explains a configuration key, a statistic or a metric.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fstream>
#include <memory>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/stat_list.h"
#include "apps/glint/session.h"
#include "apps/glint/sweep/points.h"
#include "base/params.h"
#include "memsys/peak.h"
#include "report/metrics/metrics.h"

namespace glint::app {
namespace {

struct DescribeOptions {
  std::string key, config = "mobile";
  std::vector<std::string> settings;
  std::string points;  // file with points of a sweep
  bool markdown = false;
};

void print(const ParamInfo& info) {
  print_output("{} = {}\n", info.key, info.value);
  print_output("  {}\n", info.doc);
  if (!info.unit.empty()) print_output("  unit   {}\n", info.unit);
  if (!info.range.empty()) print_output("  range  {}\n", info.range);
  if (!info.needs.empty()) print_output("  needs  {}\n", info.needs);
}

void print_markdown(const std::vector<ParamInfo>& infos) {
  print_output("| key | value | unit | range | meaning |\n|---|---|---|---|---|\n");
  for (const ParamInfo& info : infos)
    print_output("| `{}` | {} | {} | {} | {}{} |\n", info.key, info.value, info.unit, info.range, info.doc,
                 info.needs.empty() ? "" : fmt::format(" Needs `{}`.", info.needs));
}

// Returns a path as lists have it: "gpu.core[3].issue_slots::raw_fixed" -> "gpu.core[*].issue_slots".
std::string as_listed(const std::string& path) {
  std::string out;
  for (const char c : path.substr(0, path.find("::"))) {
    if (!out.empty() && out.back() == '*' && c != ']') continue;  // skips the further digits of a number
    out += !out.empty() && out.back() == '[' ? '*' : c;
  }
  return out;
}

// Prints the statistics of that path or below it. Returns false when there are none. `names` gets all paths.
bool print_stats(const std::string& wanted, std::vector<std::string>& names) {
  const std::string path = as_listed(wanted);
  bool any = false;
  for (const report::StatName& row : all_stats()) {
    names.push_back(row.path);
    if (row.path != path && row.path.rfind(path + ".", 0) != 0) continue;
    print_output("{}\n  {}\n  unit   {}\n", row.path, row.doc, row.unit);
    any = true;
  }
  return any;
}

// Prints the metric of metrics.csv with that name. Returns false when there is none. `names` gets all names.
bool print_metric(const std::string& wanted, std::vector<std::string>& names) {
  for (const report::MetricGroup& group : report::metric_groups())
    for (const report::Metric& metric : group.metrics) {
      names.emplace_back(metric.name);
      if (metric.name != wanted) continue;
      print_output(
          "{} (a metric: `glint stats RUN --format metrics`, metrics.csv)\n  {}\n  unit     {}\n  formula  "
          "{}\n",
          metric.name, metric.doc, metric.unit,
          metric.formula.empty() ? "none, because Glint cannot give this metric" : metric.formula);
      if (!metric.paper.empty()) print_output("  paper    {}\n", metric.paper);
      return true;
    }
  return false;
}

Exit describe(const Session& session, const DescribeOptions& options) {
  if (!options.points.empty()) {
    std::ifstream file(options.points == "-" ? "/dev/stdin" : options.points);
    if (!file) throw UserError({options.points}, "cannot read the file");
    describe_points(session, file);
    return Exit::Ok;
  }
  const pipeline::GpuParams params = read_config(session.resources, options.config, options.settings);
  std::vector<ParamInfo> found;
  std::vector<std::string> names;
  for (const ParamInfo& info : describe_params(params)) {
    names.push_back(info.key);
    const bool inside = info.key.rfind(options.key + ".", 0) == 0;
    if (options.key.empty() || info.key == options.key || inside) found.push_back(info);
  }
  if (found.empty()) {
    if (print_stats(options.key, names) || print_metric(options.key, names)) return Exit::Ok;
    const std::string guess = nearest(options.key, names);
    throw UserError({}, fmt::format("there is no configuration key, statistic or metric '{}'", options.key),
                    guess.empty() ? "'glint describe' lists all keys, 'glint list stats' lists all "
                                    "statistics, and 'glint list metrics' lists all metrics"
                                  : fmt::format("did you mean '{}'?", guess));
  }
  if (options.markdown)
    print_markdown(found);
  else
    for (const ParamInfo& info : found) print(info);
  const bool has_memory = options.key.empty() || options.key == "memory";
  if (has_memory && !options.markdown)
    print_output("at best: {}\n", mem::peak(params.memory, params.cores, params.clock_mhz).to_string());
  return Exit::Ok;
}

}  // namespace

void add_describe(Command app, Session& session) {
  auto options = std::make_shared<DescribeOptions>();
  Command command = app.add_subcommand("describe", "Explain configuration keys, statistics and metrics");
  command.add_option("NAME", options->key,
                     "What to explain: a key (core.warps), the beginning of keys (core, rt), a statistic "
                     "(gpu.core[0].ipc) or a metric (simt_efficiency); default: all keys");
  command.add_option("--config", options->config, "Preset or TOML file whose values are shown")
      .capture_default_str();
  command.add_option("--set", options->settings, "Override one key, such as core.warps=16; repeatable")
      .type_name("KEY=VALUE");
  command
      .add_option("--points", options->points,
                  "Check the points of a sweep, a line of JSON each (docs/sweeps.md), and print what each "
                  "depends on; -: standard input")
      .type_name("FILE");
  command.add_flag("--markdown", options->markdown, "Print the table of docs/config.md");
  command.callback(
      [&session, options] { session.action = [&session, options] { return describe(session, *options); }; });
}

}  // namespace glint::app
