// Tests that launches on one device keep what they should keep: memory, warm caches, and nothing else.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/device.h"

#include <string>
#include <vector>

#include "pipeline/launch_builder.h"
#include "pipeline/run_stats.h"
#include "tests/support/catch.h"
#include "tests/support/stat_listing.h"

namespace glint::pipeline::device_test {
namespace {

constexpr uint32_t kThreads = 8192;
constexpr const char* kDouble = R"(#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Data { uint value[]; };
void main() { value[gl_GlobalInvocationID.x] = 2 * value[gl_GlobalInvocationID.x] + 1; }
)";

struct Host {
  GpuParams gpu;
  CompiledStage stage = compile();
  LinkedShaders shaders{{stage.program}, stage.reflection.bindings, gpu, nullptr};
  mem::AddressSpace memory;
  Address data = memory.allocate("data", kThreads * 4);
  LaunchBuilder builder{shaders, memory};

  Host() {
    builder.bind_buffers({0, 0}, {{data, kThreads * 4}});
    builder.set_blocks(0, {kThreads / 64, 1, 1});
    builder.finish();
  }
  static CompiledStage compile() {
    Diagnostics notes;
    return compile_stage(frontend::glsl_text_to_spirv(kDouble, "double.comp", isa::Stage::Compute, {}),
                         {"double.comp", "", {}}, {}, notes, nullptr);
  }
  uint32_t last() const { return memory.view<uint32_t>(data, kThreads)[kThreads - 1]; }
};

LaunchMode mode(Caches caches, bool timing = true) {
  return {timing, false, 1, caches, {}};
}

std::string listing(const RenderResult& result) {
  return test::listing(result.statistics());
}

TEST_CASE("a cold launch on a used device has every statistic of the same launch on a new one") {
  Host host;
  Device used(host.gpu), fresh(host.gpu);
  used.run(host.builder.world, mode(Caches::Cold), {});
  const RenderResult again = used.run(host.builder.world, mode(Caches::Cold), {});
  const RenderResult alone = fresh.run(host.builder.world, mode(Caches::Cold), {});
  CHECK(listing(again) == listing(alone));
  CHECK(again.cycles == alone.cycles);
  CHECK(host.last() == 7);
}

TEST_CASE("a warm launch finds in the L2 what the launch before it has read and written") {
  Host host;
  Device device(host.gpu);
  const RenderResult cold = device.run(host.builder.world, mode(Caches::Warm), {});
  const RenderResult warm = device.run(host.builder.world, mode(Caches::Warm), {});
  const auto reads = [](const RenderResult& result) {
    uint64_t sum = 0;
    const mem::MemorySystem& memory = result.stats->timing()->memory();
    for (uint32_t i = 0; i < memory.num_partitions(); ++i)
      sum += memory.partition(i).dram().stats().reads.value();
    return sum;
  };
  constexpr uint64_t kCode = 8;  // sectors of instructions
  CHECK(reads(cold) == kThreads * 4 / 32 + kCode);
  CHECK(reads(warm) == 0);
  CHECK(warm.cycles < cold.cycles);
}

TEST_CASE("cooling a device makes its next launch that of a new one, and so does a launch that was cut") {
  Host host;
  Device device(host.gpu);
  const std::string alone = listing(device.run(host.builder.world, mode(Caches::Cold), {}));
  device.cool();
  CHECK(listing(device.run(host.builder.world, mode(Caches::Warm), {})) == alone);
  LaunchWatch cut;
  cut.max_cycles = 5100;
  CHECK(device.run(host.builder.world, mode(Caches::Warm), cut).end == LaunchEnd::MaxCycles);
  CHECK(listing(device.run(host.builder.world, mode(Caches::Warm), {})) == alone);
}

TEST_CASE("functional launches between timed ones leave the caches as they are") {
  Host host;
  Device device(host.gpu);
  device.run(host.builder.world, mode(Caches::Cold), {});
  const std::string warm = listing(device.run(host.builder.world, mode(Caches::Warm), {}));
  device.run(host.builder.world, mode(Caches::Cold), {});
  device.run(host.builder.world, mode(Caches::Warm, false), {});
  CHECK(listing(device.run(host.builder.world, mode(Caches::Warm), {})) == warm);
}

TEST_CASE("launches give back the physical memory that the machine reserved, also when they fail") {
  Host host;
  Device device(host.gpu);
  const uint64_t before = host.memory.bytes_in_use();
  device.run(host.builder.world, mode(Caches::Cold), {});
  CHECK(host.memory.bytes_in_use() == before);
  host.builder.bind_buffers({0, 0}, {LaunchBuilder::unbound({0, 0})});
  CHECK_THROWS(device.run(host.builder.world, mode(Caches::Cold), {}));
  CHECK(host.memory.bytes_in_use() == before);
}

TEST_CASE("the sum of two launches has their counters, and ratios of both together") {
  Host host;
  Device device(host.gpu);
  RenderResult sum = device.run(host.builder.world, mode(Caches::Cold), {});
  const RenderResult second = device.run(host.builder.world, mode(Caches::Warm), {});
  const uint64_t cycles = sum.cycles, instructions = sum.warp_instructions;
  const auto answered = [](const RenderResult& result) {
    return result.stats->timing()->memory().l1(0).stats().timed_misses.value();
  };
  const auto mean = [](const RenderResult& result) {
    return result.stats->timing()->memory().l1(0).stats().mean_miss_latency.value();
  };
  const double n = double(answered(sum)), m = double(answered(second));
  const double expected = (n * mean(sum) + m * mean(second)) / (n + m);
  sum.add(second);
  CHECK(sum.cycles == cycles + second.cycles);
  CHECK(sum.warp_instructions == 2 * instructions);
  CHECK(mean(sum) == Catch::Approx(expected));
  CHECK(expected != Catch::Approx(mean(second)));
}

}  // namespace
}  // namespace glint::pipeline::device_test
