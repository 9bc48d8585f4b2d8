// Tests the published simulator's memory system under its presets: hits without time, stores that evict,
// small packets.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/support/memory_rig.h"
#include "tests/support/preset.h"

namespace glint::mem {
namespace {

using glint::test::preset;

constexpr Address kLine = 128 * 1000;
constexpr Cycle kL2Hit = 1 + 84 + 2 + 1 + 84;  // port, way, slice, port, way: 160 of rop latency and 12

Request request(Token token, bool write = false, Traffic traffic = Traffic::RtNode, Address line = kLine) {
  return {line, 1, write, traffic, token};
}

void write(MemoryRig& rig, Traffic traffic) {
  const Cycle start = rig.now();
  rig.run([&](uint32_t, Cycle now) {
    if (now == start) CHECK(rig.l1().access(now, Client::Lsu, request(0, true, traffic)));
    return kNever;
  });
}

TEST_CASE("a hit of the RT unit is answered in the cycle of its request, beside four of shaders") {
  for (const char* name : {"vulkan-sim-desktop", "vulkan-sim-mobile"}) {
    MemoryRig rig(preset(name).memory, 1, 1365.0);
    const auto line = [](Token i) { return kLine + 128 * i; };
    for (Token i = 0; i < 6; ++i) rig.read_latency(line(i), 1);
    const Cycle now = rig.now();
    for (Token i = 0; i < 4; ++i)
      REQUIRE(rig.l1().access(now, Client::Lsu, request(i, false, Traffic::ShaderGlobal, line(i))));
    REQUIRE(rig.l1().access(now, Client::RtUnit, request(9, false, Traffic::RtNode, line(4))));
    CHECK_FALSE(rig.l1().access(now, Client::RtUnit, request(10, false, Traffic::RtNode, line(5))));
    CHECK(rig.l1().pop(now, Client::RtUnit) == Token{9});
  }
}

TEST_CASE("a store to global or local memory drops what it hits, so the next load goes to the L2") {
  for (Traffic traffic : {Traffic::ShaderGlobal, Traffic::ShaderLocal}) {
    MemoryRig rig(preset("vulkan-sim-desktop").memory, 1, 1365.0);
    rig.read_latency(kLine, 1);
    CHECK(rig.read_latency(kLine, 1) == 0);
    write(rig, traffic);
    CHECK(rig.read_latency(kLine, 1) == kL2Hit);
    CHECK(rig.read_latency(kLine, 1) == 0);
  }
  // In hardware-like presets the line has the new bytes, and local memory is written back.
  for (Traffic traffic : {Traffic::ShaderGlobal, Traffic::ShaderLocal}) {
    const Params params = preset("desktop").memory;
    MemoryRig rig(params, 1, 1365.0);
    rig.read_latency(kLine, 1);
    write(rig, traffic);
    CHECK(rig.read_latency(kLine, 1) == params.l1.hit_latency);
  }
}

TEST_CASE(
    "a packet is one flit, whatever it holds: four sectors cost the slice three cycles and the network "
    "none") {
  const Params params = preset("vulkan-sim-desktop").memory;
  const auto hit = [&](uint8_t sectors) {
    MemoryRig rig(params, 1, 1365.0);
    rig.read_latency(kLine, sectors, true);
    return rig.read_latency(kLine, sectors);
  };
  CHECK(hit(0b0001) == kL2Hit);
  CHECK(hit(0b1111) == kL2Hit + 3);
}

TEST_CASE(
    "a closed row of DRAM costs 100 cycles and 44 clocks of 3500 MHz, half of what the part would take") {
  const auto beyond_l2 = [](const char* name) {
    const Params params = preset(name).memory;
    MemoryRig rig(params, 1, 1365.0);
    const Cycle miss = rig.read_latency(kLine, 1),
                hit = (rig.read_latency(kLine + 128 * 64, 1, true), rig.read_latency(kLine + 128 * 64, 1));
    return miss - hit;
  };
  // RCD is 20, CL is 20 and data are 4 (mobile: two commands of 4) at 3500 MHz, in cycles of 1365 MHz, and
  // there are up to two to change clocks.
  CHECK(beyond_l2("vulkan-sim-desktop") >= 100 + 18);
  CHECK(beyond_l2("vulkan-sim-desktop") <= 100 + 20);
  CHECK(beyond_l2("vulkan-sim-mobile") - beyond_l2("vulkan-sim-desktop") <= 2);
  CHECK(beyond_l2("desktop") > 100 + 18 + 20);
}

TEST_CASE("under ideal-memory a first touch takes less than the hit of an L1") {
  MemoryRig rig(preset("ideal-memory").memory, 1, 1365.0);
  CHECK(rig.read_latency(kLine, 0b1111) < 20);
  CHECK(rig.read_latency(kLine, 0b1111) == 1);
}

}  // namespace
}  // namespace glint::mem
