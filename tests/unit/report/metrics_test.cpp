// Tests formulas over a run, and the tables of metrics and of Vulkan-Sim's names that are made of them.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/metrics.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "base/diagnostics.h"
#include "report/metrics/formula.h"
#include "report/metrics/vulkan_sim.h"
#include "tests/support/catch.h"

namespace glint::report {
namespace {

RunRecord small_run() {
  RunRecord run;
  run.add_stats(
      "path,value,unit,doc\n"
      "gpu.cycles,200,cycle,\"From, to.\"\n"
      "gpu.core[0].lane_instructions,300,instruction,a\n"
      "gpu.core[11].lane_instructions,100,instruction,a\n"
      "gpu.core[0].instructions,10,instruction,a\n"
      "gpu.core[0].stage.lane_instructions,5000,instruction,deeper\n"
      "gpu.memory.core[0].l1.misses::rt_node,3,request,a\n"
      "gpu.memory.core[0].l1.misses::rt_triangle,1,request,a\n"
      "gpu.memory.core[0].l1.misses::shader_global,50,request,a\n"
      "gpu.memory.core[0].l1.reads::rt_node,16,request,a\n"
      "gpu.rt_unit[0].rt.max_ray_nodes,7,node,a\n"
      "gpu.rt_unit[1].rt.max_ray_nodes,9,node,a\n",
      "stats.csv");
  run.add_facts(
      R"({"scene": {"name": "SHIP", "triangles": 6255}, "structures": {"top_depth": 1, "bottom_depth": 11}, "width": 16})",
      "run.json");
  run.add_config(
      "cores = 8  # [core] of = 3\nname = \"8\"\n[core]\nwarps = 32 # a\n[rt.box]\nlatency = 13\n");
  return run;
}

TEST_CASE("a formula sums over instances and parts, and a star matches no dot") {
  const RunRecord run = small_run();
  CHECK(evaluate("sum(gpu.core[*].lane_instructions)", run) == 400.0);
  CHECK(evaluate("sum(core.lane_instructions) / sum(gpu.cycles)", run) == 2.0);
  CHECK(evaluate("sum(l1.misses::rt_*)", run) == 4.0);
  CHECK(evaluate("max(rt.max_ray_nodes)", run) == 9.0);
  CHECK(evaluate("mean(rt.max_ray_nodes)", run) == 8.0);
}

TEST_CASE("a formula multiplies before it adds, from left to right, and keeps parentheses") {
  const RunRecord run = small_run();
  CHECK(evaluate("1 + 2 * 3 - 8 / 4 / 2", run) == 6.0);
  CHECK(evaluate("(1 + 2) * 3", run) == 9.0);
  CHECK(evaluate("run(scene.triangles) - config(cores) * config(core.warps) + config(rt.box.latency)", run) ==
        6255.0 - 256 + 13);
}

TEST_CASE("a formula has no value where a statistic, a fact or a divisor is missing") {
  const RunRecord run = small_run();
  CHECK_FALSE(evaluate("sum(gpu.absent) + 1", run));
  CHECK_FALSE(evaluate("run(absent)", run));
  CHECK_FALSE(evaluate("config(name)", run));  // the key is not a number
  CHECK_FALSE(evaluate("1 / (sum(gpu.cycles) - 200)", run));
}

TEST_CASE("text that is not a formula is refused") {
  const RunRecord run = small_run();
  for (const char* text : {"", "1 +", "sum(gpu.cycles", "(1", "1 2", "median(gpu.cycles)", "gpu.cycles"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(evaluate(text, run), UserError);
  }
}

// Returns whether a meaning can be read without the row before it, as in tooltips, in tables of chosen
// metrics and in Python.
bool stands_alone(std::string_view text) {
  for (const char* reference : {"The same:", "The same of", "The same,", "As above", "Of them"})
    if (text.find(reference) != std::string_view::npos) return false;
  return true;
}

TEST_CASE(
    "there are 35 metrics of the GPU, 29 of the RT unit and 23 of the scene, each name once, each with a "
    "formula or a reason") {
  std::set<std::string_view> names;
  std::vector<size_t> sizes;
  for (const MetricGroup& group : metric_groups()) {
    sizes.push_back(group.metrics.size());
    for (const Metric& metric : group.metrics) {
      CAPTURE(metric.name);
      CHECK(names.insert(metric.name).second);
      CHECK((!metric.unit.empty() && !metric.doc.empty()));
      CHECK(stands_alone(metric.doc));
      CHECK((!metric.formula.empty() || !metric.paper.empty()));
      if (!metric.formula.empty()) CHECK_NOTHROW(paths_in(std::string(metric.formula)));
    }
  }
  CHECK(sizes == std::vector<size_t>{35, 29, 23});
}

TEST_CASE("a row of metrics.csv has as many cells as its header, and its figures stand under their names") {
  const std::string header = metrics_header(), row = metrics_row("SHIP_SH", small_run());
  CHECK(std::count(header.begin(), header.end(), ',') == std::count(row.begin(), row.end(), ','));
  std::istringstream names(header), cells(row);
  std::string name, cell;
  std::map<std::string, std::string> found;
  while (std::getline(names, name, ',') && std::getline(cells, cell, ',')) found[name] = cell;
  CHECK(found["workload"] == "SHIP_SH");
  CHECK(found["scene"] == "SHIP");
  CHECK(found["cycles"] == "200");
  CHECK(found["thread_ipc"] == "2");
  CHECK(found["bvh_depth"] == "12");
  CHECK(found["rt_miss_rate"] == "0.25");
  CHECK(found["max_nodes_per_ray"] == "9");
  CHECK(found["rt_store_q_max"].empty());
  CHECK(found["l2_miss_rate"].empty());
}

TEST_CASE("Vulkan-Sim's names are each once, and what has no value is a comment with its reason") {
  std::set<std::string_view> names;
  for (const PeerStat& stat : vulkan_sim_stats()) {
    CAPTURE(stat.name);
    CHECK(names.insert(stat.name).second);
    CHECK(stands_alone(stat.note));
    if (stat.formula.empty())
      CHECK(!stat.note.empty());
    else
      CHECK_NOTHROW(paths_in(std::string(stat.formula)));
  }
  const std::string text = vulkan_sim_text(small_run());
  CHECK(text.find("gpu_tot_ipc = 2\n") != std::string::npos);
  CHECK(text.find("rt_max_tree_depth = 12\n") != std::string::npos);
  CHECK(text.find("# rt_max_mem_store_q: ") != std::string::npos);
}

TEST_CASE("files that no run has written are refused with the file's name") {
  RunRecord run;
  CHECK_THROWS_WITH(run.add_stats("a,b\n", "some.csv"), Catch::Contains("some.csv"));
  CHECK_THROWS_WITH(run.add_stats("path,value,unit,doc\nx,none,u,d\n", "some.csv"),
                    Catch::Contains("some.csv:2"));
  CHECK_THROWS_WITH(run.add_facts("[1]", "some.json"), Catch::Contains("some.json"));
  CHECK_THROWS_AS(RunRecord::read("/nowhere"), UserError);
}

}  // namespace
}  // namespace glint::report
