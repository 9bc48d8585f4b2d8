// Declares `glint microbench`, which measures a configuration's latencies, throughputs and bandwidths.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <memory>
#include <optional>

#include "apps/glint/microbench/kernel.h"
#include "apps/glint/options/command_line.h"
#include "apps/glint/options/config.h"
#include "apps/glint/session.h"
#include "report/terminal/table.h"

namespace glint::app {
namespace {

struct MicrobenchOptions {
  std::string config = "h200";
  std::vector<std::string> settings, compare, only;
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
// and throughput of steps), and "group,name,param,value".
void read_reference(Reference& out, const std::string& path) {
  std::ifstream in(path);
  if (!in) throw UserError({}, fmt::format("cannot read '{}'", path));
  std::string line;
  std::getline(in, line);
  const bool ops = line.starts_with("op(step)"), groups = line.starts_with("group,");
  if (!ops && !groups)
    throw UserError({path, 1, 1},
                    "expected a first line that begins with 'op(step)' or 'group,name,param,value'");
  while (std::getline(in, line)) {
    std::vector<std::string> cell = split(line);
    if (ops && cell.size() >= 6) {
      set_number(out, "latency|" + cell[0] + "|", cell[2]);
      set_number(out, "throughput|" + cell[0] + "|", cell[5]);
    } else if (groups && cell.size() >= 4) {
      // Names may have commas of their own, so the value is the last but one.
      std::string name = cell[1];
      for (size_t i = 2; i + 3 < cell.size(); ++i) name += "," + cell[i];
      set_number(out, cell[0] + "|" + name + "|" + cell[cell.size() - 3], cell[cell.size() - 2]);
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

std::vector<std::string> row_of(const MicroBench& bench, double value, const Reference& reference,
                                std::map<std::string, ErrorSums>& sums) {
  std::vector<std::string> cells{bench.group, bench.name, bench.param, fmt::format("{:.2f}", value),
                                 bench.unit};
  const auto at = reference.find(bench.group + "|" + bench.name + "|" + bench.param);
  if (at == reference.end()) return cells;
  const double error = value / at->second - 1;
  ErrorSums& sum = sums[bench.group];
  ++sum.compared;
  sum.within5 += std::abs(error) <= 0.05;
  sum.within10 += std::abs(error) <= 0.10;
  sum.error += std::abs(error);
  cells.push_back(fmt::format("{:.2f}", at->second));
  cells.push_back(fmt::format("{:+.1f} %", error * 100));
  return cells;
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

Exit microbench(const Session& session, const MicrobenchOptions& options) {
  const pipeline::GpuParams gpu = read_config(session.resources, options.config, options.settings);
  Reference reference;
  for (const std::string& path : options.compare) read_reference(reference, path);
  std::vector<std::vector<std::string>> rows{{"group", "name", "parameter", options.config, "unit"}};
  if (!options.compare.empty()) rows[0].insert(rows[0].end(), {"measured", "error"});
  std::map<std::string, ErrorSums> sums;
  Skipped skipped;
  for (const auto& list : {op_benchmarks(), memory_benchmarks(), flow_benchmarks()})
    for (const MicroBench& bench : list) {
      if (!wanted(bench, options.only)) continue;
      if (session.on_terminal) fmt::print(stderr, "\r\033[K{} {} {}", bench.group, bench.name, bench.param);
      const std::optional<double> value = measure(bench, gpu, skipped);
      rows.push_back(value ? row_of(bench, *value, reference, sums)
                           : std::vector<std::string>{bench.group, bench.name, bench.param, "-", bench.unit});
    }
  if (session.on_terminal) fmt::print(stderr, "\r\033[K");
  if (rows.size() == 1) throw UserError({}, "no benchmark has this text in its group, name or parameter");
  print_output("{}", report::table(rows, "<<<><>>"));
  print_sums(sums);
  for (const auto& [reason, names] : skipped)
    fmt::print(stderr, "\n{} benchmarks (-) were not run, the first of them '{}':\n{}\n", names.size(),
               names.front(), reason);
  const bool measured =
      std::any_of(rows.begin() + 1, rows.end(), [](const auto& row) { return row[3] != "-"; });
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
      .add_option("--only", options->only, "Run only benchmarks with this text in group, name or parameter")
      .type_name("TEXT");
  command.callback([&session, options] {
    session.action = [&session, options] { return microbench(session, *options); };
  });
}

}  // namespace glint::app
