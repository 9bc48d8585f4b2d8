// Runs both machines in step: every warp retires the same instructions with the same results.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "base/registry.h"
#include "pipeline/functional_machine.h"
#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;

namespace {

// Holds one retired instruction: where, for which lanes, and a hash of what it wrote there.
struct Step {
  uint32_t pc;
  LaneMask lanes;
  uint64_t result;
  bool operator==(const Step&) const = default;
};
using History = std::vector<std::vector<Step>>;  // by warp of the launch

uint64_t mix(uint64_t hash, uint64_t value) {
  return (hash ^ value) * 0x9e3779b97f4a7c15ull + (hash >> 29);
}

uint64_t result_of(const exec::Retired& retired) {
  uint64_t hash = 1;
  size_t slot = 0;
  for (isa::OperandKind kind : retired.issued.row->operands.view()) {
    const bool written = isa::is_destination(kind);
    int parts = isa::slots_of(kind);
    for (int part = 0; part < parts; ++part, ++slot) {
      if (!written) continue;
      const isa::Slot operand = retired.issued.inst->operand[slot];
      if (kind == isa::OperandKind::DstPred) {
        if (retired.issued.row->effect == isa::Effect::None)  // rays answer later
          hash = mix(hash, retired.warp.regs.predicate[operand] & retired.issued.lanes);
        continue;
      }
      for (int half = 0; half < (kind == isa::OperandKind::Dst64 ? 2 : 1); ++half)
        for_each_lane(retired.issued.lanes, [&](int lane) {
          hash = mix(hash, retired.warp.regs.read(isa::Slot(operand + half))[lane]);
        });
    }
  }
  return hash;
}

void record(History& history, const exec::Retired& retired) {
  history[retired.warp.warp_index].push_back({retired.issued.pc, retired.issued.lanes, result_of(retired)});
}

std::string describe(const exec::World& world, const Step& step) {
  return fmt::format("{} lanes {:08x} result {:016x}", world.image->place_of(step.pc), step.lanes,
                     step.result);
}

// Returns "" when the histories are equal, and otherwise the first difference.
std::string first_difference(const exec::World& world, const History& a, const History& b) {
  for (size_t warp = 0; warp < a.size(); ++warp)
    for (size_t i = 0; i < std::max(a[warp].size(), b[warp].size()); ++i) {
      if (i < a[warp].size() && i < b[warp].size() && a[warp][i] == b[warp][i]) continue;
      return fmt::format("warp {}, instruction {}:\n  functional: {}\n  timing:     {}", warp, i,
                         i < a[warp].size() ? describe(world, a[warp][i]) : "ended",
                         i < b[warp].size() ? describe(world, b[warp][i]) : "ended");
    }
  return {};
}

std::string compare_machines(const pipeline::RenderJob& job) {
  pipeline::SceneWorld for_functional(job), for_timing(job);
  const uint32_t warps = exec::Executor(for_functional.world).num_warps();
  History functional(warps), timing(warps);
  pipeline::run_functional(for_functional.world, job.gpu.core.instruction_budget, {},
                           [&](const exec::Retired& retired) { record(functional, retired); });
  pipeline::TimingMachine machine(job.gpu, for_timing.world, false);
  for (uint32_t c = 0; c < machine.num_cores(); ++c)
    machine.core(c).executor().retired.listen([&](const exec::Retired& retired) { record(timing, retired); });
  machine.run({});
  std::string difference = first_difference(for_functional.world, functional, timing);
  if (difference.empty() && for_functional.read_image(pipeline::SceneWorld::kPicture) !=
                                for_timing.read_image(pipeline::SceneWorld::kPicture))
    difference = "the pictures differ";
  return difference;
}

}  // namespace

TEST_CASE("the timing machine retires what the functional machine retires, instruction by instruction") {
  const auto scene = GENERATE("WKND", "CORNELL");
  const auto workload = GENERATE(pipeline::Workload::PathTracing, pipeline::Workload::Shadow,
                                 pipeline::Workload::AmbientOcclusion);
  INFO(scene << " " << test::shader_folder(workload));

  CHECK(compare_machines(test::small_job(scene, workload, 16, 1)) == "");
}

TEST_CASE("both machines retire the same in every node format") {
  const auto format = GENERATE(from_range(Registry<rt::NodeFormat>::names()));
  pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::PathTracing, 16, 1);
  job.gpu.bvh.format.name = format;
  INFO(format);

  CHECK(compare_machines(job) == "");
}

TEST_CASE("no node format changes a byte of a picture") {
  const auto scene = GENERATE("WKND", "SHIP");
  pipeline::RenderJob job = test::small_job(
      scene, *scene == 'W' ? pipeline::Workload::PathTracing : pipeline::Workload::Shadow, 48, 1);
  job.timing = false;
  const std::vector<float> expected = pipeline::render(job).accumulation;
  for (const std::string& format : Registry<rt::NodeFormat>::names()) {
    job.gpu.bvh.format.name = format;
    const pipeline::RenderResult result = pipeline::render(job);
    INFO(scene << " " << format);
    REQUIRE(result.accumulation.size() == expected.size());
    CHECK(std::memcmp(result.accumulation.data(), expected.data(), expected.size() * sizeof expected[0]) ==
          0);
  }
}

TEST_CASE("the any-hit shader runs alike on both machines") {
  pipeline::RenderJob job = test::small_job("CORNELL", pipeline::Workload::PathTracing, 16, 1);
  job.scene.alpha_test = true;
  job.gpu.rt.any_hit.name = GENERATE("immediate", "deferred");

  CHECK(compare_machines(job) == "");
}
