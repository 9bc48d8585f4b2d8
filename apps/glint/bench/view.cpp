// Draws a suite in progress and its summary.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/view.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fmt/format.h>

#include "apps/glint/options/output.h"
#include "pipeline/sampling/estimate.h"
#include "report/metrics/compare_samples.h"
#include "report/metrics/formula.h"
#include "report/metrics/metrics.h"

namespace glint::app {
namespace {

constexpr int kNameWidth = 13;  // "streamcluster"
constexpr int kBarWidth = 24;

// Returns one metric of docs/metrics.md as text, or "" when the run does not have it.
std::string shown(const std::vector<report::MetricValue>& metrics, std::string_view name, int digits,
                  double scale = 1) {
  for (const report::MetricValue& metric : metrics)
    if (metric.metric->name == name)
      return metric.value ? fmt::format("{:.{}f}", *metric.value * scale, digits) : "";
  return "";
}

std::string whole(const std::vector<report::MetricValue>& metrics, std::string_view name) {
  for (const report::MetricValue& metric : metrics)
    if (metric.metric->name == name)
      return metric.value ? report::with_thousands(uint64_t(*metric.value)) : "";
  return "";
}

// Returns half the 95 % interval of a sampled run's cycles, as a share of them: "+- 4.2 %". A whole run has
// none.
std::string interval_of(const report::RunRecord& run) {
  if (!report::is_sampled(run)) return "";
  const auto value = [&](const char* name) {
    const std::vector<double> values = run.values(name);
    return values.empty() ? 0 : values[0];
  };
  const double half = (value("gpu.sample.cycles_high") - value("gpu.sample.cycles_low")) / 2;
  return fmt::format("+- {:.1f} %", 100 * half / std::max(1.0, value("gpu.sample.cycles")));
}

}  // namespace

std::string gigabytes(uint64_t bytes) {
  return fmt::format("{:.2f} GB", double(bytes) / 1e9);
}

std::string figures_of(const report::RunRecord& run) {
  const std::vector<report::MetricValue> metrics = report::metrics_of(run);
  if (report::is_sampled(run))
    return fmt::format("{:>11} cycles  {}, of a sample", whole(metrics, "cycles"), interval_of(run));
  const bool has_rays = report::evaluate("sum(gpu.rays)", run).value_or(0) > 0;
  if (!has_rays)
    return run.text("mode") == "functional"
               ? whole(metrics, "w_icount") + " warp instructions"
               : fmt::format("{:>11} cycles  thread IPC {:>6}", whole(metrics, "cycles"),
                             shown(metrics, "thread_ipc", 1));
  if (run.text("mode") == "functional") {
    const std::optional<double> nodes = report::evaluate("sum(gpu.nodes) / sum(gpu.rays)", run);
    return fmt::format("{} rays{}",
                       report::with_thousands(uint64_t(report::evaluate("sum(gpu.rays)", run).value_or(0))),
                       nodes ? fmt::format("  {:.1f} nodes/ray", *nodes) : "");
  }
  return fmt::format("{:>11} cycles  thread IPC {:>6}  {:>5} nodes/ray", whole(metrics, "cycles"),
                     shown(metrics, "thread_ipc", 1), shown(metrics, "avg_nodes_per_ray", 1));
}

void BenchView::ended(const BenchTask& task, const Process& process, const std::string& figures) {
  clear();
  ++ended_;
  const bool is_partial = process.state == Process::State::Partial,
             is_well = process.state == Process::State::Done || is_partial;
  if (!is_well) ++failed_;
  const std::string head = fmt::format("{:>2}/{} {:<{}}", ended_, total_, task.workload.name(), kNameWidth);
  if (is_well)
    print_output("{} {}  {:>11}  {}{}\n", head, figures, report::seconds(process.seconds),
                 gigabytes(process.peak_bytes), is_partial ? "  partial" : "");
  else
    print_output("{} {}\n", head, figures);
}

void BenchView::draw(const ProcessPool& pool, const std::vector<std::string>& names) {
  if (!is_live_) return;
  clear();
  std::string lines;
  for (const size_t index : pool.running()) {
    const Process& process = pool.processes()[index];
    lines += fmt::format(" {:<{}} {:<9} [{}] {:3.0f} %  {}\n", names[index], kNameWidth, process.phase,
                         report::bar(process.progress, kBarWidth, terminal_), 100 * process.progress,
                         report::seconds(process.seconds));
    ++drawn_;
  }
  const double left = pool.time_left();
  print_output("{} {} of {} ended{}  {}{}\n", lines, ended_, total_,
               failed_ ? fmt::format(", {} failed", failed_) : "", report::seconds(pool.elapsed()),
               left < 0 ? "" : "  ETA " + report::seconds(left));
  ++drawn_;
}

// Moves the cursor up by the lines drawn and erases to the end of the screen (ECMA-48: CUU, ED).
void BenchView::clear() {
  if (drawn_ == 0) return;
  print_output("\x1b[{}A\x1b[J", drawn_);
  drawn_ = 0;
}

std::string summary_table(const std::vector<BenchRow>& rows) {
  const bool any_sampled =
      std::ranges::any_of(rows, [](const BenchRow& row) { return report::is_sampled(row.run); });
  std::vector<std::vector<std::string>> cells = {
      {"", "cycles", "95 %", "thread IPC", "SIMT", "RT warps", "RT rays", "RT misses", "DRAM", "rays",
       "nodes", "", ""},
      {"workload", "", "interval", "", "%", "%", "%", "%", "%", "", "a ray", "time", "memory"}};
  for (const BenchRow& row : rows) {
    const std::vector<report::MetricValue> m = report::metrics_of(row.run);
    const bool is_partial = row.process->state == Process::State::Partial;
    cells.push_back({row.task->workload.name() + (is_partial ? " (partial)" : ""), whole(m, "cycles"),
                     interval_of(row.run), shown(m, "thread_ipc", 1), shown(m, "simt_efficiency", 1, 100),
                     shown(m, "rt_occupancy", 1, 100), shown(m, "rt_efficiency", 1, 100),
                     shown(m, "rt_miss_rate", 1, 100), shown(m, "dram_util", 1, 100), whole(m, "rays_total"),
                     shown(m, "avg_nodes_per_ray", 1), report::seconds(row.process->seconds),
                     gigabytes(row.process->peak_bytes)});
  }
  if (!any_sampled)
    for (std::vector<std::string>& row : cells) row.erase(row.begin() + 2);
  return report::table(cells, any_sampled ? "<>>>>>>>>>>>>" : "<>>>>>>>>>>>");
}

std::string estimates_table(const std::vector<BenchRow>& rows) {
  std::string out;
  for (const BenchRow& row : rows) {
    if (!report::is_sampled(row.run)) continue;
    if (out.empty()) out = "workload,estimate,value,low,high\n";
    for (size_t q = 0; q < size_t(pipeline::Quantity::Count); ++q) {
      const std::string name(pipeline::name_of(pipeline::Quantity(q)));
      const std::vector<double> value = row.run.values("gpu.sample." + name),
                                low = row.run.values("gpu.sample." + name + "_low"),
                                high = row.run.values("gpu.sample." + name + "_high");
      if (value.size() == 1 && low.size() == 1 && high.size() == 1)
        out += fmt::format("{},{},{},{},{}\n", row.task->workload.name(), name, value[0], low[0], high[0]);
    }
  }
  return out;
}

}  // namespace glint::app
