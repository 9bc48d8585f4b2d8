// Counts what launches do, chooses some of them and estimates the rest.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/launch_sample.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <memory>
#include <utility>

#include "exec/launch.h"
#include "pipeline/run_stats.h"
#include "report/files/csv_field.h"

namespace glint::app {
namespace {

// Names what the functional machine counts of a launch, which is the launch's signature. The first one is
// that along which strata are cut.
constexpr const char* kCounts[] = {"warp_instructions",
                                   "instructions_per_warp",
                                   "warps",
                                   "alu",
                                   "sfu",
                                   "mem",
                                   "tex",
                                   "ctrl",
                                   "rt",
                                   "lanes",
                                   "idle_lanes",
                                   "mem_lanes",
                                   "nodes",
                                   "tests"};
constexpr size_t kInstructions = 0, kNodes = 12;

std::vector<double> counts_of(const exec::World& world, const pipeline::RenderResult& result) {
  const auto instructions = double(result.warp_instructions), lanes = double(result.lane_instructions);
  const double warps = double(exec::num_blocks(world)) * exec::warps_per_block(world);
  std::vector<double> out = {instructions, instructions / std::max(1.0, warps), warps};
  for (const pipeline::ClassCounts& counts : result.by_class) out.push_back(double(counts.instructions));
  out.insert(out.end(),
             {lanes, instructions * kLanes - lanes, double(result.by_class[size_t(isa::Class::Mem)].lanes),
              double(result.rays.nodes), double(result.rays.box_tests + result.rays.triangle_tests)});
  return out;
}

}  // namespace

LaunchSample::LaunchSample(const LaunchOptions& options, const pipeline::GpuParams& gpu, bool no_skip,
                           uint32_t threads, Traces traces)
    : choice_(options.sample),
      gpu_(gpu),
      mode_{true, no_skip, threads, {}, {}},
      keeps_(traces),
      device_(gpu),
      warm_(gpu_, device_) {
}

pipeline::RenderResult LaunchSample::survey(const std::string& kernel, const exec::World& world,
                                            pipeline::Caches caches, const pipeline::LaunchWatch& watch) {
  pipeline::LaunchMode functional = mode_;
  functional.timing = false;
  pipeline::RenderResult result = keeps_ == Traces::Kept
                                      ? pipeline::functional_result(traces_.record(world, gpu_, watch), world)
                                      : device_.run(world, functional, watch);
  faults_.add(result.faults);
  const bool finds_nothing =
      caches == pipeline::Caches::Cold ||
      std::ranges::none_of(surveyed_, [&](const Surveyed& one) { return one.kernel == kernel; });
  surveyed_.push_back({kernel, finds_nothing, counts_of(world, result)});
  return result;
}

void LaunchSample::choose() {
  Eigen::MatrixXd features(Eigen::Index(surveyed_.size()), Eigen::Index(std::size(kCounts)));
  std::vector<int> kinds;
  std::map<std::pair<std::string, bool>, int> numbers;
  for (size_t i = 0; i < surveyed_.size(); ++i) {
    for (size_t count = 0; count < std::size(kCounts); ++count)
      features(Eigen::Index(i), Eigen::Index(count)) = surveyed_[i].counts[count];
    const std::pair kind(surveyed_[i].kernel, surveyed_[i].finds_nothing);
    kinds.push_back(numbers.try_emplace(kind, int(numbers.size())).first->second);
  }
  const uint32_t count =
      choice_.launches_of(uint32_t(surveyed_.size()), uint32_t(report::least_drawn(kinds)));
  strata_ = report::draw_rows(features, kinds, int(count), choice_.seed);
  for (size_t i = 0; i < strata_.drawn.size(); ++i) drawn_of_[size_t(strata_.drawn[i].row)] = i;
  for (const auto& [launch, place] : drawn_of_) traces_.drop(launch);
}

void LaunchSample::keep_timed(std::vector<std::string>& names) const {
  std::vector<std::string> kept;
  for (const auto& [launch, place] : drawn_of_)
    if (launch < names.size()) kept.push_back(std::move(names[launch]));
  names = std::move(kept);
}

pipeline::RenderResult LaunchSample::time(size_t launch, const exec::World& world, pipeline::Caches caches,
                                          const pipeline::LaunchWatch& watch) {
  pipeline::LaunchMode mode = mode_;
  mode.caches = caches;
  warm_.give_back();
  pipeline::RenderResult result = device_.run(world, mode, watch);
  const report::DrawnRow& drawn = strata_.drawn[drawn_of_.at(launch)];
  const std::vector<double>& functional = surveyed_[launch].counts;
  if (result.end == pipeline::LaunchEnd::Whole)
    timed_.push_back({uint32_t(launch), uint32_t(drawn.stratum), drawn.weight,
                      pipeline::counts_of(*result.stats->timing(), result.cycles), functional[kInstructions],
                      functional[kNodes]});
  return result;
}

pipeline::RenderResult LaunchSample::warm(size_t launch, const exec::World& world, pipeline::Caches caches,
                                          const pipeline::LaunchWatch& watch) {
  if (!traces_.has(launch)) return warm_.run(world, caches, watch);
  warm_.replay(traces_, launch, world, caches);
  traces_.drop(launch);
  return {};
}

void LaunchSample::finish(pipeline::RenderResult& sum) {
  pipeline::LaunchTotals totals;
  for (const Surveyed& one : surveyed_)
    totals.instructions += one.counts[kInstructions], totals.nodes += one.counts[kNodes];
  estimates_ = pipeline::estimate_launches(timed_, totals);
  sum.stats->keep(std::make_unique<pipeline::SampleStats>(&sum.stats->root(), estimates_));
  sum.faults = faults_;
}

void LaunchSample::keep(const report::RunDirectory& directory, report::RunInfo& info) const {
  if (!is_complete() || timed_.empty()) return;
  info.sample = report::SampleInfo{.share = double(timed_.size()) / double(surveyed_.size()),
                                   .seed = choice_.seed,
                                   .of = report::SampleInfo::Of::Launches,
                                   .all = surveyed_.size(),
                                   .timed = timed_.size(),
                                   .clusters = uint64_t(strata_.count)};
  directory.write("sample.csv", pipeline::launches_csv(timed_));
  directory.write("signatures.csv", signatures_csv());
}

std::string LaunchSample::signatures_csv() const {
  std::string out = "launch,kernel,cluster,weight";
  for (const char* name : kCounts) out += fmt::format(",{}", name);
  out += "\n";
  for (size_t i = 0; i < surveyed_.size(); ++i) {
    const auto drawn = drawn_of_.find(i);
    const double weight = drawn == drawn_of_.end() ? 0 : strata_.drawn[drawn->second].weight;
    out += fmt::format("{},{},{},{},{}\n", i, report::csv_field(surveyed_[i].kernel), strata_.of_row[i],
                       weight, fmt::join(surveyed_[i].counts, ","));
  }
  return out;
}

pipeline::RenderResult ended_early(pipeline::RenderResult&& surveyed, const pipeline::RenderResult& in) {
  surveyed.end = in.end;
  surveyed.progress = in.progress;
  return std::move(surveyed);
}

void add_result(pipeline::RenderResult&& result, std::optional<pipeline::RenderResult>& sum) {
  if (sum)
    sum->add(result);
  else
    sum.emplace(std::move(result));
}

}  // namespace glint::app
