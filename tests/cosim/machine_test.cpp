// The whole timing machine: nothing is lost, every cycle has a reason, and skipping idle time changes nothing.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <sstream>
#include <string>

#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;

namespace {

// All numbers of a tree, one a line: two runs are equal when these are.
class Listing final : public stats::Visitor {
 public:
  void enter(const stats::Group& group) override { text += group.name() + "{"; }
  void leave(const stats::Group&) override { text += "}\n"; }
  void visit(const stats::Counter& stat) override { text += fmt::format("{}={}\n", stat.name(), stat.value()); }
  void visit(const stats::Ratio& stat) override { text += fmt::format("{}={}\n", stat.name(), stat.value()); }
  void visit(const stats::Value& stat) override { text += fmt::format("{}={}\n", stat.name(), stat.value()); }
  void visit(const stats::Histogram& stat) override { text += fmt::format("{}={}\n", stat.name(), fmt::join(stat.counts(), ",")); }
  void visit(const stats::BreakdownBase& stat) override {
    for (const auto& [name, count] : stat.parts()) text += fmt::format("{}::{}={}\n", stat.name(), name, count);
  }
  std::string text;
};

// The first line in which two listings differ, or "".
std::string first_difference(const std::string& a, const std::string& b) {
  std::istringstream lines_a(a), lines_b(b);
  for (std::string line_a, line_b, group; std::getline(lines_a, line_a) && std::getline(lines_b, line_b);) {
    if (line_a.find('{') != std::string::npos) group = line_a.substr(0, line_a.find_last_of('{'));
    if (line_a != line_b) return fmt::format("in {}: {} against {}", group, line_a, line_b);
  }
  return a == b ? "" : "one is longer";
}

std::string listing(const pipeline::TimingMachine& machine) {
  Listing listing;
  machine.root().accept(listing);
  return listing.text;
}

}  // namespace

TEST_CASE("every cycle of every core, RT unit and partition is given to exactly one reason") {
  const pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::PathTracing, 16, 1);
  pipeline::SceneWorld scene(job);
  pipeline::TimingMachine machine(job.gpu, scene.world, false);

  machine.run({});
  const Cycle cycles = machine.attributed_cycles();

  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    CHECK(machine.core(i).stats().stalls.total() == cycles * job.gpu.core.schedulers);
    CHECK(machine.rt_unit(i).stats().cycles.total() == cycles);
  }
  for (uint32_t i = 0; i < machine.memory().num_partitions(); ++i)
    CHECK(machine.memory().partition(i).stats().cycles.total() == cycles);
}

TEST_CASE("rays that enter the RT units leave them") {
  const pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::Shadow, 16, 1);
  pipeline::SceneWorld scene(job);
  pipeline::TimingMachine machine(job.gpu, scene.world, false);

  machine.run({});

  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    const rt::RtStats& stats = machine.rt_unit(i).stats();
    CHECK(stats.rays.value() + stats.resumed.value() == stats.finished.value() + stats.suspended.value());
  }
}

TEST_CASE("skipping idle time changes no number of the whole machine") {
  const auto workload = GENERATE(pipeline::Workload::PathTracing, pipeline::Workload::AmbientOcclusion);
  const pipeline::RenderJob job = test::small_job("WKND", workload, 8, 1);
  pipeline::SceneWorld first(job), second(job);
  pipeline::TimingMachine skipping(job.gpu, first.world, false), stepping(job.gpu, second.world, true);

  CHECK(skipping.run({}) == stepping.run({}));

  CHECK(first_difference(listing(skipping), listing(stepping)) == "");
}
