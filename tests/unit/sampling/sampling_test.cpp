// Tests the choice of a sample, its statistics, and that a sampled run is the same on any number of threads.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "base/diagnostics.h"
#include "base/student.h"
#include "pipeline/run_stats.h"
#include "pipeline/sampling/sampled_run.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;
using namespace glint::pipeline;

namespace {

// Returns counts of a sample of 1/4 of a launch, of one block per stratum and `batches` with the same work.
SampleCounts counts_of(const SamplePlan& plan, const std::vector<double>& cycles_of_batches) {
  SampleCounts counts;
  counts.plan = &plan;
  for (const double cycles : cycles_of_batches) {
    SampleBatch batch;
    batch.counts[size_t(BatchCount::Cycles)] = cycles;
    batch.counts[size_t(BatchCount::Nodes)] = 100;
    batch.counts[size_t(BatchCount::L1Reads)] = 5000;
    batch.counts[size_t(BatchCount::L1Hits)] = 2500;
    for (size_t i = 0; i < batch.counts.size(); ++i) counts.total[i] += batch.counts[i];
    counts.batches.push_back(batch);
  }
  return counts;
}

const Estimate& find(const std::vector<Estimate>& all, std::string_view name) {
  return *std::ranges::find(all, name, &Estimate::name);
}

}  // namespace

TEST_CASE("A sample has the share that was asked for, and every block has one place", "[sampling]") {
  const SamplePlan plan = plan_sample({.share = 0.05, .seed = 3}, 8192, 42, 4);
  CHECK(plan.timed.size() >= 400);
  CHECK(plan.timed.size() <= 410);
  CHECK(plan.starts.size() == 11);  // what fills the machine, and ten segments
  CHECK(plan.starts[1] == 63);      // a wave and a half
  CHECK(std::ranges::is_sorted(plan.timed));
  CHECK(std::ranges::is_sorted(plan.warm, {}, &WarmBlock::block));
  std::set<uint32_t> blocks(plan.timed.begin(), plan.timed.end());
  for (const WarmBlock& warm : plan.warm) blocks.insert(warm.block);
  CHECK(blocks.size() == plan.timed.size() + plan.warm.size());
  CHECK(*blocks.rbegin() < 8192);
  CHECK(plan.timed.size() + plan.sizes[0] + plan.sizes[1] + plan.sizes[2] == 8192);
  CHECK(plan.num_functional() == plan.warm.size());
  // Of the others in a segment all run, in front of it a third, and elsewhere a twelfth.
  std::array<size_t, 3> run{};
  for (const WarmBlock& warm : plan.warm) ++run[size_t(warm.stratum)];
  CHECK(run[0] == plan.sizes[0]);
  CHECK(std::abs(double(run[1]) / plan.sizes[1] - 1.0 / 3) < 0.05);
  CHECK(std::abs(double(run[2]) / plan.sizes[2] - 1.0 / 12) < 0.02);
}

TEST_CASE("The first segment lies behind blocks that fill the machine, and the last one before others",
          "[sampling]") {
  const SamplePlan plan = plan_sample({.share = 0.05, .seed = 3}, 8192, 42, 4);
  const size_t length = plan.starts[2] - plan.starts[1];
  CHECK(plan.timed.size() - plan.starts.back() == length + 21);             // half a wave more
  CHECK(plan.timed[plan.starts[1]] - plan.timed[plan.starts[1] - 1] <= 7);  // They are neighbours.
}

TEST_CASE("Surveyed blocks are neither timed nor run a second time", "[sampling]") {
  for (const uint32_t scale : {1u, 4u}) {
    const SampleOptions options{.share = 0.05, .seed = 3, .by = "cost"};
    Survey survey = survey_for(options);
    REQUIRE(survey.step > 0);
    for (uint32_t i = 0; survey.block(i) < 8192; ++i) survey.costs.push_back(survey.block(i));
    const SamplePlan plan = plan_sample(options, 8192, 42, scale, survey);
    for (const uint32_t block : plan.timed) REQUIRE_FALSE(survey.has(block));
    for (const WarmBlock& warm : plan.warm) REQUIRE_FALSE(survey.has(warm.block));
    CHECK(plan.sizes[size_t(Stratum::Surveyed)] == survey.costs.size());
    CHECK(plan.timed.size() + plan.sizes[0] + plan.sizes[1] + plan.sizes[2] + plan.sizes[3] == 8192);
  }
  CHECK(survey_for({.by = "position"}).step == 0);
}

TEST_CASE("Where lines were asked for, segments are whole and the blocks of the row above run",
          "[sampling]") {
  const SampleOptions options{.share = 0.05, .seed = 3};
  Survey survey = survey_for(options, 8192);
  REQUIRE(survey.asks == Question::Lines);
  REQUIRE(survey.step == 16);
  survey.costs.assign(512, 1.0);
  const SamplePlan plan = plan_sample(options, 8192, 42, 4, survey, 128);
  CHECK(plan.group == 1);
  CHECK(plan.scale == 4);
  std::set<uint32_t> there(plan.timed.begin(), plan.timed.end());
  for (const WarmBlock& warm : plan.warm) there.insert(warm.block);
  CHECK(there.size() == plan.timed.size() + plan.warm.size());
  for (const uint32_t block : plan.timed) {
    REQUIRE((block == 0 || there.contains(block - 1)));
    REQUIRE((block < 128 || there.contains(block - 128)));
  }
  // Nothing else runs, and surveyed blocks stand for it.
  for (const WarmBlock& warm : plan.warm) {
    REQUIRE(warm.stratum == Stratum::Inside);
    REQUIRE((there.contains(warm.block + 1) || there.contains(warm.block + 128)));
  }
  CHECK(plan.sizes == std::array{uint32_t(plan.warm.size()), 0u, 0u, uint32_t(8192 - there.size())});
  CHECK(plan.num_functional() == plan.warm.size());
  const std::vector<uint32_t> stand_for_others = survey.left_out_by(plan);
  CHECK(stand_for_others.size() > 400);
  CHECK(stand_for_others.size() < 512);
  for (const uint32_t index : stand_for_others) REQUIRE_FALSE(there.contains(survey.block(index)));
}

TEST_CASE("Where blocks that lie far apart share lines, some of the others run, too", "[sampling]") {
  const SampleOptions options{.share = 0.05, .seed = 3};
  Survey survey = survey_for(options, 8192);
  survey.costs.assign(512, 1.0);
  survey.lines = 100, survey.shared.resize(10);
  CHECK_FALSE(survey.is_shared());
  CHECK(survey.fetched_before(0).empty());
  survey.shared.resize(11);
  CHECK(survey.is_shared());
  const SamplePlan plan = plan_sample(options, 8192, 42, 4, survey);
  CHECK(plan.sizes[size_t(Stratum::Surveyed)] == 0);
  // The L2 holds all of the shared lines but for the sample's share of them.
  survey.shared.clear();
  for (Address line = 0; line < 1'000'000; line += 128) survey.shared.push_back(line);
  const auto held = double(survey.fetched_before(0.25).size());
  CHECK(held / double(survey.shared.size()) == Approx(0.75).epsilon(0.03));
  CHECK(survey.fetched_before(0).size() == survey.shared.size());
  CHECK(survey.fetched_before(1).empty());
  CHECK(std::ranges::count(plan.warm, Stratum::Rest, &WarmBlock::stratum) > 400);
}

TEST_CASE("Blocks whose lines are asked for lie in different columns", "[sampling]") {
  const Survey survey = survey_for({.share = 0.05, .seed = 3}, 8192);
  std::set<uint32_t> places;
  for (uint32_t i = 0; i < 512; ++i) {
    const uint32_t block = survey.block(i);
    REQUIRE(block / survey.step == i);
    places.insert(block % survey.step);
    CHECK_FALSE(survey.has(block));  // It has left nothing behind.
  }
  CHECK(places.size() == 16);
}

TEST_CASE("A part's L2 has room for what all blocks read, and its share of the rest", "[sampling]") {
  Survey survey{.step = 64, .asks = Question::Lines, .costs = std::vector<double>(100, 1.0), .shared = {}};
  SamplePlan plan;
  plan.num_blocks = 6400;
  plan.timed.resize(600), plan.warm.resize(1000);
  CHECK(footprint_share(survey, plan, 6000) == Approx(0.25));  // Each has lines for itself.
  survey.shared.resize(1600);  // These keep their room, and a quarter more. Of the rest a quarter is left.
  CHECK(footprint_share(survey, plan, 6000) == Approx((2000 + 4000 * 0.25) / 6000));
  CHECK(footprint_share(survey, plan, 2000) == 1);
  CHECK(footprint_share(survey, plan, 1000) == 1);
  survey.asks = Question::Cost;
  CHECK(footprint_share(survey, plan, 6000) == 1);

  const GpuParams gpu = test::preset("mobile");
  CHECK(cut(gpu, 4).memory.l2.slice_size == 4 * gpu.memory.l2.slice_size);
  CHECK(cut(gpu, 4, 0.25).memory.l2.slice_size == gpu.memory.l2.slice_size);
  CHECK(cut(gpu, 4, 0).memory.l2.slice_size == gpu.memory.l2.ways * gpu.memory.line);
}

TEST_CASE("Equal seeds choose equal blocks, and other seeds choose others", "[sampling]") {
  const auto timed = [](uint64_t seed) {
    return plan_sample({.share = 0.05, .seed = seed}, 8192, 42, 4).timed;
  };
  CHECK(timed(1) == timed(1));
  CHECK(timed(1) != timed(2));
}

TEST_CASE("A sample that cannot fill its machine is refused", "[sampling]") {
  CHECK_THROWS_WITH(plan_sample({.share = 0.05}, 512, 42, 4),
                    Catch::Contains("a sample of 5 % has 26 of 512"));
}

TEST_CASE("The machine is cut by what divides cores and partitions and leaves room for the share",
          "[sampling]") {
  GpuParams gpu;
  gpu.cores = 8, gpu.memory.dram.channels = 4;
  CHECK(largest_scale(gpu, 0.05) == 4);
  CHECK(largest_scale(gpu, 0.3) == 2);
  CHECK(largest_scale(gpu, 0.5) == 1);
  gpu.cores = 9;
  CHECK(largest_scale(gpu, 0.05) == 1);
  gpu.cores = 8;
  const GpuParams part = cut(gpu, 4);
  CHECK(part.cores == 2);
  CHECK(part.memory.dram.channels == 1);
  CHECK(part.memory.l2.slice_size == 4 * gpu.memory.l2.slice_size);
}

TEST_CASE("Cycles are those of the sample and, for the work that it lacks, those of each node",
          "[sampling]") {
  SamplePlan plan;
  plan.num_blocks = 40, plan.scale = 2, plan.sizes = {0, 0, 30};
  SampleCounts counts = counts_of(plan, {1000, 1000, 1000});
  counts.work[size_t(Stratum::Rest)] = {{0, 30}, {0, 30}};
  const std::vector<Estimate> all = estimate(counts);
  // The whole launch visits 300 + 30 * 30 nodes, of which a half machine does 600: twice the sample's.
  CHECK(find(all, "nodes").value == 1200);
  CHECK(find(all, "cycles").value == 6000);
  CHECK(find(all, "l1_hit_rate").value == 0.5);
  CHECK(find(all, "cycles").low < 6000);
  CHECK(find(all, "cycles").high > 6000);
}

TEST_CASE("The use of DRAM has the writes that a sample leaves to be done", "[sampling]") {
  SamplePlan plan;
  plan.num_blocks = 40, plan.scale = 2, plan.sizes = {0, 0, 30};
  const auto utilisation = [&](DramTraffic traffic) {
    SampleCounts counts = counts_of(plan, {1000, 1000, 1000});
    counts.work[size_t(Stratum::Rest)] = {{0, 30}, {0, 30}};  // The launch has four times the sample's work.
    counts.total[size_t(BatchCount::DramClocks)] = 1000;
    counts.total[size_t(BatchCount::DramBusy)] = 100;
    for (size_t i = 0; i < counts.total.size(); ++i) counts.half[i] = counts.total[i] / 2;
    counts.traffic = traffic;
    return find(estimate(counts), "dram_utilisation").value;
  };
  // 25 requests took 100 clocks.
  CHECK(utilisation({.reads = 25, .writes = 0, .unwritten = 0, .l2 = 10}) == Approx(0.1));
  // The second half of the sample makes 50 writes, and the launch 400, of which an L2 of 600 holds all.
  CHECK(utilisation({.reads = 25, .writes = 0, .unwritten = 50, .l2 = 600}) == Approx(0.1));
  // Of 400 writes and 200 reads an L2 of 60 holds a tenth: of each 100 writes 90 follow, with 4 clocks each.
  CHECK(utilisation({.reads = 25, .writes = 0, .unwritten = 50, .l2 = 60}) == Approx(0.1 + 0.36));
  // Nothing has been asked of DRAM yet. An L2 of 40 holds a tenth of 400 writes, and the configuration says
  // that each takes 2 clocks.
  CHECK(utilisation({.reads = 0, .writes = 0, .unwritten = 50, .l2 = 40, .clocks = 2}) == Approx(0.1 + 0.18));
}

TEST_CASE("An interval grows with the scatter of the batches and with that of the work", "[sampling]") {
  SamplePlan plan;
  plan.num_blocks = 40, plan.scale = 2, plan.sizes = {0, 0, 30};
  const auto width = [&](const std::vector<double>& cycles, uint64_t a, uint64_t b) {
    SampleCounts counts = counts_of(plan, cycles);
    counts.work[size_t(Stratum::Rest)] = {{0, a}, {0, b}};
    const std::vector<Estimate> all = estimate(counts);
    return find(all, "cycles").high - find(all, "cycles").low;
  };
  const double even = width({1000, 1000, 1000}, 30, 30);
  CHECK(width({900, 1000, 1100}, 30, 30) > 1.2 * even);
  CHECK(width({1000, 1000, 1000}, 20, 40) > 1.2 * even);
}

TEST_CASE("A hit rate of a few reads is not estimated", "[sampling]") {
  SamplePlan plan;
  plan.num_blocks = 40, plan.scale = 2, plan.sizes = {0, 0, 30};
  const auto is_estimated = [&](double reads) {
    SampleCounts counts = counts_of(plan, {1000, 1000, 1000});
    counts.work[size_t(Stratum::Rest)] = {{0, 30}, {0, 30}};
    counts.total[size_t(BatchCount::L2Reads)] = counts.total[size_t(BatchCount::L2Hits)] = reads;
    return std::ranges::any_of(estimate(counts),
                               [](const Estimate& one) { return one.name == "l2_hit_rate"; });
  };
  // The method's own error is 0.03, and 0.5 / sqrt(278) is as much.
  CHECK(!is_estimated(270));
  CHECK(is_estimated(280));
}

TEST_CASE("Student's quantiles are those of the tables", "[sampling]") {
  CHECK(student_quantile(1) == Approx(12.706));
  CHECK(student_quantile(9) == Approx(2.262));
  CHECK(student_quantile(10) == Approx(2.228).epsilon(0.001));
  CHECK(student_quantile(30) == Approx(2.042).epsilon(0.001));
  CHECK(student_quantile(100000) == Approx(1.960).epsilon(0.001));
}

TEST_CASE("A sampled frame estimates the whole one, with the same numbers on any number of threads",
          "[sampling]") {
  const auto job_on = [](uint32_t threads) {
    RenderJob job = test::small_job("SHIP", Workload::Shadow, 128, 1);
    job.gpu = test::preset("mobile");
    job.gpu.core.warps = 4;  // so that the sample fills the cores several times
    job.threads = threads;
    return job;
  };
  RenderJob one = job_on(1), two = job_on(2), whole = job_on(1);
  const SampleOptions options{.share = 0.15, .seed = 1};
  const SampledRun first = render_sampled(one, options), second = render_sampled(two, options);
  REQUIRE(first.estimates.size() == second.estimates.size());
  for (size_t i = 0; i < first.estimates.size(); ++i) {
    CHECK(first.estimates[i].value == second.estimates[i].value);
    CHECK(first.estimates[i].low == second.estimates[i].low);
  }
  CHECK(batches_csv(first) == batches_csv(second));
  CHECK(first.result.rgba == second.result.rgba);
  const RenderResult truth = render(whole);
  const Estimate& cycles = find(first.estimates, "cycles");
  CHECK(cycles.value == Approx(double(truth.cycles)).epsilon(0.15));
  CHECK(find(first.estimates, "nodes").value == Approx(double(truth.rays.nodes)).epsilon(0.1));
  // A pixel that was run is that of the whole frame.
  size_t run = 0, same = 0;
  for (size_t i = 0; i < truth.rgba.size(); i += 4) {
    if (std::all_of(&first.result.rgba[i], &first.result.rgba[i] + 4, [](float x) { return x == 0; }))
      continue;
    ++run;
    same += std::equal(&truth.rgba[i], &truth.rgba[i] + 4, &first.result.rgba[i]);
  }
  CHECK(run > truth.rgba.size() / 4 / 8);
  CHECK(run == same);
}
