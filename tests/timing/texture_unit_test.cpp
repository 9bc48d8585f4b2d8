// Tests the texture unit's own way to the L1: its queues, its door, and the samples that it filters per
// cycle.
// SPDX-License-Identifier: Apache-2.0
#include "core/lsu.h"
#include "tests/support/catch.h"
#include "tests/unit/core/lsu_rig.h"
#include "tests/unit/core/one_core.h"
#include "tests/unit/exec/image_lab.h"

namespace glint::core {
namespace {

constexpr Cycle kTexelLatency = 20;

Params unit_params(TextureParams texture) {
  Params params;
  params.units.lsu = {12, 4};
  params.units.tex = {12, 4};
  params.texture = texture;
  return params;
}

void take_accesses(Lsu& lsu, uint32_t scheduler, Cycle now, bool texture, uint32_t lines = 1,
                   uint32_t samples = 0) {
  REQUIRE(lsu.can_take(scheduler, texture));
  MemoryAccess& access = lsu.take(scheduler, now, texture);
  access.write = false;
  access.samples = samples;
  for (uint32_t i = 0; i < lines; ++i) access.lines.add(4096 + 128 * i, 128, 0);
}

}  // namespace

TEST_CASE("textures that wait keep no place from loads, where they have a queue") {
  for (const uint32_t queue : {0u, 3u}) {
    CAPTURE(queue);
    mem::FixedLatencyMemory memory(kTexelLatency);
    Params params = unit_params({0, queue, false});
    params.lsu.queue = 3;
    Lsu lsu(params, memory);

    for (int i = 0; i < 3; ++i) take_accesses(lsu, 0, 0, true);
    CHECK_FALSE(lsu.can_take(0, true));
    CHECK(lsu.can_take(0, false) == (queue > 0));
    CHECK(lsu.can_take(1, true));
    lsu.tick(1);
    CHECK(lsu.can_take(0, true));
  }
}

TEST_CASE("a load is taken in the cycle of a texture, where that has a queue of its own") {
  for (const uint32_t queue : {0u, 3u}) {
    mem::FixedLatencyMemory memory(kTexelLatency);
    Lsu lsu(unit_params({0, queue, true}), memory);
    take_accesses(lsu, 0, 0, true);
    take_accesses(lsu, 0, 0, false);
    // In one queue, the load is taken when the scheduler's address generation is free again.
    CHECK(completions(lsu, 1) == std::vector<Cycle>{32, queue ? 32u : 36u});
  }
}

TEST_CASE("lines of textures and of loads are asked for in the same cycle, where there are two doors") {
  for (const bool own : {false, true}) {
    mem::FixedLatencyMemory memory(kTexelLatency);
    Lsu lsu(unit_params({0, 5, own}), memory);
    take_accesses(lsu, 0, 0, true, 4);
    take_accesses(lsu, 1, 0, false, 4);
    // Whole lines take a door for two cycles each.
    CHECK(completions(lsu, 1) == (own ? std::vector<Cycle>{38, 38} : std::vector<Cycle>{44, 46}));
  }
}

TEST_CASE("the two doors still share the L1's ports") {
  mem::FixedLatencyMemory memory(kTexelLatency, 1);
  Lsu lsu(unit_params({0, 5, true}), memory);
  take_accesses(lsu, 0, 0, true);
  take_accesses(lsu, 1, 0, false);
  CHECK(completions(lsu, 1) == std::vector<Cycle>{32, 33});
  CHECK(memory.refused() == 1);
}

TEST_CASE("samples take the texture units a cycle for as many as there are units") {
  struct Case {
    uint32_t rate, samples;
    Cycle first, second;
  };
  // The interval of 4 is the least, and the last sample is the access's.
  for (const auto& [rate, samples, first, second] :
       {Case{4, 16, 35, 39}, {4, 17, 36, 41}, {4, 32, 39, 47}, {4, 4, 32, 36}, {0, 32, 32, 36}}) {
    CAPTURE(rate, samples);
    mem::FixedLatencyMemory memory(kTexelLatency);
    Lsu lsu(unit_params({rate, 5, true}), memory);
    take_accesses(lsu, 0, 0, true, 1, samples);
    take_accesses(lsu, 1, 0, true, 1, samples);
    CHECK(completions(lsu, 1) == std::vector<Cycle>{first, second});
  }
}

TEST_CASE("a fetch is a sample a lane, and one between two levels is two") {
  const auto cycles = [](const char* op, uint32_t rate, LaneMask lanes) {
    Code code;
    code.add("setp.lt.u32",
             {0, special(isa::Special::LaneId), code.constant(uint32_t(std::popcount(lanes)))});
    const isa::Slot half = code.constant(exec::bits(0.5f));
    code.add(op, {reg(1), reg(2), reg(3), reg(4), code.constant(0), half, half, half}, 0, 0);
    code.add("add.u32", {reg(7), reg(4), reg(4)});
    code.add("exit");
    Params params = quick_params();
    params.texture.samples_per_cycle = rate;
    OneCore core(code, params, {});
    exec::ImageView texture;
    texture.shape = isa::ImageShape::D2;
    texture.format = exec::TexelFormat::R32Float;
    texture.width = texture.height = 4;
    texture.levels = 3;
    texture.sampler.min = texture.sampler.mag = texture.sampler.mip = exec::Filter::Linear;
    texture.base = core.memory.allocate("image", texture.bytes());
    core.world.images = {texture};
    const Cycle end = core.run();
    REQUIRE_FALSE(core.cell->fault());
    return end;
  };

  const Cycle plain = cycles("tex.level.2d.v4.f32.f32", 0, kAllLanes);
  // Half way between levels, each lane has 8 texels.
  CHECK(cycles("tex.level.2d.v4.f32.f32", 4, kAllLanes) == plain + 64 / 4 - 1);
  CHECK(cycles("tex.level.2d.v4.f32.f32", 8, kAllLanes) == plain + 64 / 8 - 1);
  CHECK(cycles("tex.level.2d.v4.f32.f32", 4, 0xff) == plain + 16 / 4 - 1);
}

TEST_CASE("each sample of an anisotropic filter takes the texture units as a sample of its own does") {
  const auto cycles = [](float anisotropy) {
    Code code;
    const isa::Slot half = code.constant(exec::bits(0.5f)), quarter = code.constant(exec::bits(0.25f)),
                    zero = code.constant(0);
    code.add("tex.grad.2d.v4.f32.f32",
             {reg(1), reg(2), reg(3), reg(4), zero, half, half, half, zero, zero, quarter});
    code.add("add.u32", {reg(7), reg(4), reg(4)});
    code.add("exit");
    Params params = quick_params();
    params.texture.samples_per_cycle = 4;
    OneCore core(code, params, {});
    exec::ImageView texture;
    texture.format = exec::TexelFormat::R32Float;
    texture.width = texture.height = 8;
    texture.sampler.max_anisotropy = anisotropy;
    texture.base = core.memory.allocate("image", texture.bytes());
    core.world.images = {texture};
    const Cycle end = core.run();
    REQUIRE_FALSE(core.cell->fault());
    return end;
  };

  // The footprint has 4 by 2 texels, so there are two samples of four texels for each lane.
  CHECK(cycles(16) == cycles(1) + 32 / 4);
}

TEST_CASE("a full queue of textures holds back textures only") {
  Code code;
  for (int i = 0; i < 6; ++i)
    code.add("tex.1d.v4.f32.f32", {reg(4 * i), reg(4 * i + 1), reg(4 * i + 2), reg(4 * i + 3),
                                   code.constant(0), code.constant(exec::bits(0.5f))});
  code.add("add.u32", {reg(60), reg(61), reg(61)});
  code.add("exit");
  Params params = quick_params();
  params.texture.queue = 2;
  OneCore core(code, params, {});
  exec::ImageView texture;
  texture.shape = isa::ImageShape::D1;
  texture.format = exec::TexelFormat::R32Float;
  texture.width = 16;
  texture.base = core.memory.allocate("image", 64);
  core.world.images = {texture};
  core.run();

  REQUIRE_FALSE(core.cell->fault());
  // They issue in 0, 1, 2 (one has been taken in 1), then as places come free in 5, 9 and 13.
  CHECK(core.stats().stalls.count(Stall::TexThrottle) == (5 - 3) + (9 - 6) + (13 - 10));
  CHECK(core.stats().stalls.count(Stall::LsuThrottle) == 0);
}

}  // namespace glint::core
