// Tests that profile, time series and conservation of the machine add up, and that watching changes nothing.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>

#include "pipeline/conservation.h"
#include "pipeline/run_profile.h"
#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;

namespace {

struct Watched {
  Cycle cycles = 0, attributed = 0;
  ProfileTable profile;
  SeriesTable series;
  std::vector<pipeline::Balance> balances;
  uint64_t instructions = 0, slots = 0;
};

Watched watch(const pipeline::Observation& observation, bool no_skip = false, Cycle window = 0) {
  const pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::PathTracing, 16, 1);
  pipeline::SceneWorld scene(job);
  pipeline::HostOptions host;
  host.window = window;
  pipeline::TimingMachine machine(job.gpu, scene.world, no_skip, host);
  pipeline::observe(machine, observation);
  Watched out;
  out.cycles = machine.run({});
  out.attributed = machine.attributed_cycles();
  out.profile = pipeline::profile_of(machine, *scene.world.image);
  if (observation.sample) out.series = pipeline::series_of(machine, observation.sample);
  out.balances = pipeline::balances(machine);
  for (uint32_t i = 0; i < machine.num_cores(); ++i) {
    out.instructions += machine.core(i).stats().instructions.value();
    out.slots += machine.core(i).stats().stalls.total();
  }
  return out;
}

bool same(const ProfileTable& a, const ProfileTable& b) {
  return std::equal(a.rows.begin(), a.rows.end(), b.rows.begin(), b.rows.end(),
                    [](const ProfileRow& x, const ProfileRow& y) {
                      return x.shader == y.shader && x.index == y.index && x.issues == y.issues &&
                             x.lanes == y.lanes && x.sectors == y.sectors && x.latency == y.latency &&
                             x.slots == y.slots;
                    });
}

}  // namespace

TEST_CASE("everything that goes into a run balances, and a balance that does not is named") {
  std::vector<pipeline::Balance> balances = watch({.profile = true}).balances;
  CHECK(pipeline::broken(balances) == "");
  CHECK(balances.size() > 50);
  CHECK(std::count_if(balances.begin(), balances.end(), [](const auto& b) { return b.left > 0; }) > 25);

  const auto rays = std::find_if(balances.begin(), balances.end(), [](const auto& b) {
    return b.what == "core[1] RT unit: rays in = rays out";
  });
  REQUIRE(rays != balances.end());
  ++rays->left;
  CHECK(pipeline::broken(balances) ==
        fmt::format("core[1] RT unit: rays in = rays out: {} against {}\n", rays->left, rays->right));
}

TEST_CASE("the profile has every issue slot of every scheduler, and knows the lines of shaders") {
  const Watched run = watch({.profile = true});
  uint64_t slots = 0, issues = 0, with_line = 0, traces = 0;
  for (const ProfileRow& row : run.profile.rows) {
    slots += row.total();
    issues += row.issues;
    if (row.line) with_line += row.issues;
    if (row.op == "rt.trace") traces += row.slots[size_t(core::Stall::RtWait)];
  }
  CHECK(slots == run.slots);
  CHECK(issues == run.instructions);
  CHECK(with_line * 10 > issues * 9);
  CHECK(traces > 0);
}

TEST_CASE("watching changes no cycle, and stepping or another window no figure") {
  const Watched plain = watch({}), watched = watch({true, 1000}), stepped = watch({true, 1000}, true),
                narrow = watch({true, 1000}, false, 7);
  CHECK(plain.profile.rows.empty());
  CHECK(plain.cycles == watched.cycles);
  CHECK(same(watched.profile, stepped.profile));
  CHECK(watched.series.rows == stepped.series.rows);
  CHECK(watched.cycles == narrow.cycles);
  CHECK(same(ProfileTable{{}, {watched.profile.rows.begin(), watched.profile.rows.end() - 1}, {}},
             ProfileTable{{}, {narrow.profile.rows.begin(), narrow.profile.rows.end() - 1}, {}}));
  // The end of a run is in whole windows, so the last rows differ by that.
  const size_t whole = std::min(watched.attributed, narrow.attributed) / 1000;
  CHECK(std::equal(watched.series.rows.begin(), watched.series.rows.begin() + ptrdiff_t(whole),
                   narrow.series.rows.begin()));
}

TEST_CASE("a series has a row an interval, and its counts add up to the run's") {
  const Watched run = watch({false, 777});
  const auto column = [&](const std::string& name) {
    return size_t(std::find(run.series.columns.begin(), run.series.columns.end(), name) -
                  run.series.columns.begin());
  };
  CHECK(run.series.rows.size() == (run.attributed + 776) / 777);
  CHECK(run.series.rows.back()[column("cycle")] == double(run.attributed));
  double instructions = 0, warps = 0;
  for (const std::vector<double>& row : run.series.rows) {
    instructions += row[column("instructions")];
    warps = std::max(warps, row[column("rt_warps")]);
    CHECK(row[column("dram_use")] <= 1.01);
    CHECK(row[column("l1d_miss_rate")] <= 1.0);
  }
  CHECK(instructions == double(run.instructions));
  CHECK(warps > 0.0);
  CHECK(warps <= 2 * 4.0);  // two units of four warps
}
