// Declares `glint microbench`, which measures a configuration's latencies, throughputs and bandwidths.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/glint/microbench/kernel.h"
#include "apps/glint/microbench/rays.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/options/output.h"
#include "apps/glint/session.h"
#include "report/files/csv_field.h"
#include "report/terminal/table.h"

namespace glint::app {
namespace {

struct MicrobenchOptions {
  std::string config = "h200";
  std::vector<std::string> settings, compare, only;
  std::string format = "table";
  std::string frames;  // folder to write the frames of the group "rt" to; empty: measure
};

// Holds what was measured on hardware: "group|name|param" -> value.
using Reference = std::map<std::string, double>;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> out(1);
  bool quoted = false;
  for (char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      out.emplace_back();
    else if (c != '\r')
      out.back() += c;
  }
  return out;
}

void set_number(Reference& out, const std::string& key, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end != text.c_str() && *end == 0) out[key] = value;
}

// Reads a file of reference values. It knows two forms by their first column: ops ("op(step)", with latency
// and throughput of steps), and "group,name,param,value", which may have further columns.
void read_reference(Reference& out, const std::string& path) {
  std::ifstream in(path);
  if (!in) throw UserError({}, fmt::format("cannot read '{}'", path));
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = split(line);
  const bool ops = line.starts_with("op(step)"), groups = line.starts_with("group,name,param,value");
  if (!ops && !groups)
    throw UserError({path, 1, 1},
                    "expected a first line that begins with 'op(step)' or 'group,name,param,value'");
  for (int row = 2; std::getline(in, line); ++row) {
    std::vector<std::string> cell = split(line);
    if (ops && cell.size() >= 6) {
      set_number(out, "latency|" + cell[0] + "|", cell[2]);
      set_number(out, "throughput|" + cell[0] + "|", cell[5]);
    } else if (groups && cell.size() >= header.size()) {
      // Names may have commas of their own, so the columns behind them are counted from the end.
      const size_t value = cell.size() - (header.size() - 3);
      std::string name = cell[1];
      for (size_t i = 2; i + 1 < value; ++i) name += "," + cell[i];
      set_number(out, cell[0] + "|" + name + "|" + cell[value - 1], cell[value]);
    } else if (groups && line.find_first_not_of(" \r") != std::string::npos) {
      throw UserError({path, row}, fmt::format("this row has {} of {} columns", cell.size(), header.size()));
    }
  }
}

bool wanted(const MicroBench& bench, const std::vector<std::string>& only) {
  if (only.empty()) return true;
  for (const std::string& text : only)
    if ((bench.group + " " + bench.name + " " + bench.param).find(text) != std::string::npos) return true;
  return false;
}

struct ErrorSums {
  uint32_t compared = 0, within5 = 0, within10 = 0;
  double error = 0;
};

using Skipped = std::map<std::string, std::vector<std::string>>;  // reason -> benchmarks

// Measures one benchmark. A benchmark for which the configuration has no room is noted in `skipped`.
std::optional<double> measure(const MicroBench& bench, const pipeline::GpuParams& gpu, Skipped& skipped) {
  try {
    return bench.measure(gpu);
  } catch (const UserError& error) {
    skipped[error.what()].push_back(fmt::format("{} {}", bench.name, bench.param));
    return std::nullopt;
  }
}

// Holds one row of the result. Numbers are absent where nothing was measured or nothing is known.
struct Row {
  const MicroBench* bench = nullptr;
  std::optional<double> value, reference;
  std::optional<double> error() const {
    return value && reference ? std::optional(*value / *reference - 1) : std::nullopt;
  }
};

std::map<std::string, ErrorSums> sums_of(const std::vector<Row>& rows) {
  std::map<std::string, ErrorSums> sums;
  for (const Row& row : rows)
    if (const std::optional<double> error = row.error()) {
      ErrorSums& sum = sums[row.bench->group];
      ++sum.compared;
      sum.within5 += std::abs(*error) <= 0.05;
      sum.within10 += std::abs(*error) <= 0.10;
      sum.error += std::abs(*error);
    }
  return sums;
}

void print_table(const std::vector<Row>& rows, const MicrobenchOptions& options) {
  std::vector<std::vector<std::string>> cells{{"group", "name", "parameter", options.config, "unit"}};
  if (!options.compare.empty()) cells[0].insert(cells[0].end(), {"measured", "error"});
  for (const Row& row : rows) {
    cells.push_back({row.bench->group, row.bench->name, row.bench->param,
                     row.value ? fmt::format("{:.2f}", *row.value) : "-", row.bench->unit});
    if (row.error())
      cells.back().insert(cells.back().end(), {fmt::format("{:.2f}", *row.reference),
                                               fmt::format("{:+.1f} %", *row.error() * 100)});
  }
  print_output("{}", report::table(cells, "<<<><>>"));
}

// The columns are those that `--compare` reads, and more behind them.
void print_csv(const std::vector<Row>& rows) {
  const auto number = [](std::optional<double> value) { return value ? fmt::format("{}", *value) : ""; };
  std::string text = "group,name,param,value,unit,measured,error\n";
  for (const Row& row : rows)
    text += fmt::format("{},{},{},{},{},{},{}\n", report::csv_field(row.bench->group),
                        report::csv_field(row.bench->name), report::csv_field(row.bench->param),
                        number(row.value), report::csv_field(row.bench->unit), number(row.reference),
                        number(row.error()));
  print_output("{}", text);
}

void print_json(const std::vector<Row>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    nlohmann::ordered_json one = {{"group", row.bench->group},
                                  {"name", row.bench->name},
                                  {"param", row.bench->param},
                                  {"value", nullptr},
                                  {"unit", row.bench->unit}};
    if (row.value) one["value"] = *row.value;
    if (row.error()) one["measured"] = *row.reference, one["error"] = *row.error();
    list.push_back(std::move(one));
  }
  print_output("{}\n", list.dump(1));
}

void print_sums(const std::map<std::string, ErrorSums>& sums) {
  std::vector<std::vector<std::string>> rows{
      {"group", "compared", "within 5 %", "within 10 %", "mean error"}};
  for (const auto& [group, sum] : sums)
    rows.push_back({group, std::to_string(sum.compared), std::to_string(sum.within5),
                    std::to_string(sum.within10), fmt::format("{:.1f} %", 100 * sum.error / sum.compared)});
  if (sums.empty()) return;
  print_output("\n{}", report::table(rows, "<>>>>"));
}

std::vector<MicroBench> all_benchmarks(const std::string& probe_dir) {
  std::vector<MicroBench> all;
  for (auto& list : {op_benchmarks(), memory_benchmarks(), flow_benchmarks(), ray_benchmarks(probe_dir)})
    all.insert(all.end(), list.begin(), list.end());
  return all;
}

std::string group_names() {
  std::vector<std::string> names;
  for (const MicroBench& bench : all_benchmarks(""))
    if (std::find(names.begin(), names.end(), bench.group) == names.end()) names.push_back(bench.group);
  return fmt::format("{}", fmt::join(names, ", "));
}

Exit microbench(const Session& session, const MicrobenchOptions& options) {
  const pipeline::GpuParams gpu = read_config(session.resources, options.config, options.settings);
  const std::string probe_dir = session.resources.shader_dir("ray_probes");
  if (!options.frames.empty()) {
    write_ray_frames(probe_dir, options.frames, gpu.cores);
    print_output("{}/probes.json\n", options.frames);
    return Exit::Ok;
  }
  Reference reference;
  for (const std::string& path : options.compare) read_reference(reference, path);
  const std::vector<MicroBench> benches = all_benchmarks(probe_dir);
  std::vector<Row> rows;
  Skipped skipped;
  for (const MicroBench& bench : benches) {
    if (!wanted(bench, options.only)) continue;
    if (session.on_terminal) fmt::print(stderr, "\r\033[K{} {} {}", bench.group, bench.name, bench.param);
    const auto at = reference.find(bench.group + "|" + bench.name + "|" + bench.param);
    rows.push_back({&bench, measure(bench, gpu, skipped),
                    at == reference.end() ? std::nullopt : std::optional(at->second)});
  }
  if (session.on_terminal) fmt::print(stderr, "\r\033[K");
  if (rows.empty())
    throw UserError({}, "no benchmark has this text in its group, name or parameter",
                    "the groups are " + group_names());
  const std::map<std::string, ErrorSums> sums = sums_of(rows);
  if (!options.compare.empty() && sums.empty())
    fmt::print(stderr,
               "warning: no row of --compare has the group, name and parameter of a benchmark here\n");
  if (options.format == "csv") print_csv(rows);
  if (options.format == "json") print_json(rows);
  if (options.format == "table") print_table(rows, options), print_sums(sums);
  for (const auto& [reason, names] : skipped)
    fmt::print(stderr, "\n{} benchmarks (-) were not run, the first of them '{}':\n{}\n", names.size(),
               names.front(), reason);
  const bool measured =
      std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.value.has_value(); });
  return measured ? Exit::Ok : Exit::UserInput;
}

}  // namespace

void add_microbench(Command app, Session& session) {
  auto options = std::make_shared<MicrobenchOptions>();
  Command command = app.add_subcommand(
      "microbench", "Measure a configuration's latencies and bandwidths by running code on it");
  command.add_option("--config", options->config, "Preset or TOML file to read").capture_default_str();
  command.add_option("--set", options->settings, "Override one key, such as core.warps=16");
  command
      .add_option("--compare", options->compare,
                  "CSV file with a real part's values, which are shown beside the measured ones")
      .type_name("FILE");
  command
      .add_option(
          "--only", options->only,
          "Run only benchmarks with this text in group, name or parameter; the groups are " + group_names())
      .type_name("TEXT");
  command
      .add_option("--frames", options->frames,
                  "Write the launches of the group rays as frames for other GPUs, and measure nothing "
                  "(docs/frames.md)")
      .type_name("DIR");
  command.add_option("--format", options->format, "Selects the form of the result")
      .one_of({"table", "csv", "json"})
      .capture_default_str();
  command.callback([&session, options] {
    session.action = [&session, options] { return microbench(session, *options); };
  });
}

}  // namespace glint::app
