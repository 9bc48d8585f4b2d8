// Tests what MemorySystem::warm() leaves in the L2, and what becomes of the dirty lines that make way for it.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/support/memory_rig.h"

using namespace glint;
using namespace glint::mem;

namespace {

constexpr Address kStride = 128;

// Returns an L2 of one slice with one set of two lines.
Params two_lines() {
  Params params = bare();
  params.dram.channels = 1, params.hash = "none";
  params.l2.ways = 2, params.l2.slice_size = 2 * kStride;
  return params;
}
uint64_t reads(MemoryRig& rig) {
  return rig.memory().partition(0).dram().stats().reads.value();
}
uint64_t writes(MemoryRig& rig) {
  return rig.memory().partition(0).stats().dram_writes.value();
}

}  // namespace

TEST_CASE("What was warmed is read without DRAM, and its other sectors are not") {
  MemoryRig rig(two_lines());
  CHECK(rig.memory().warm(0, 0b0011) == 0);
  rig.read_latency(0, 0b0011);
  CHECK(reads(rig) == 0);
  rig.read_latency(0, 0b0100);
  CHECK(reads(rig) == 1);
}

TEST_CASE("A line that is warmed by reads is clean, and one that is warmed by writes is dirty") {
  MemoryRig rig(two_lines());
  rig.memory().warm(0, 0b1111, Touch::Read);
  CHECK(rig.memory().dirty_sectors() == 0);
  rig.memory().warm(0, 0b0110, Touch::Write);
  CHECK(rig.memory().dirty_sectors() == 2);
  rig.memory().warm(kStride, 0b0001, Touch::Write);
  CHECK(rig.memory().dirty_sectors() == 3);
  rig.memory().warm(0, 0b1111, Touch::Read);  // A dirty line stays dirty.
  CHECK(rig.memory().dirty_sectors() == 3);
}

TEST_CASE("A line that was warmed by writes is written to DRAM when an access needs its place") {
  for (const Touch touch : {Touch::Read, Touch::Write}) {
    MemoryRig rig(two_lines());
    rig.memory().warm(0, 0b0111, touch);
    rig.memory().warm(kStride, 0b1111, Touch::Read);
    rig.read_latency(2 * kStride, 0b0001);
    CHECK(rig.memory().dirty_sectors() == 0);
    CHECK(writes(rig) == (touch == Touch::Write ? 3 : 0));
  }
}

TEST_CASE("A dirty line that makes way for a warmed one is lost, and the least recent one makes way") {
  MemoryRig rig(two_lines());
  rig.memory().warm(0, 0b1111, Touch::Write);
  rig.memory().warm(kStride, 0b0001, Touch::Write);
  rig.memory().warm(0, 0b1111, Touch::Read);
  CHECK(rig.memory().warm(2 * kStride, 0b1111) == 1);
  CHECK(rig.memory().warm(3 * kStride, 0b1111) == 4);
  CHECK(rig.memory().dirty_sectors() == 0);
  rig.read_latency(4 * kStride, 0b0001);
  CHECK(writes(rig) == 0);
}

TEST_CASE(
    "Displaced lines that are written later go to DRAM one by one, as clean lines make way for others") {
  MemoryRig rig(two_lines());
  const auto warm = [&](Address line, Touch touch) {
    return rig.memory().warm(line * kStride, 0b1111, touch, Displaced::WrittenLater);
  };
  warm(0, Touch::Write), warm(1, Touch::Write);
  CHECK(warm(2, Touch::Read) == 0);
  CHECK(warm(3, Touch::Read) == 0);
  rig.drain();
  CHECK(writes(rig) == 0);  // Nothing has come into the slice.
  rig.read_latency(2 * kStride, 0b0001);
  CHECK(writes(rig) == 0);  // It was there.
  rig.read_latency(4 * kStride, 0b0001);
  CHECK(writes(rig) == 4);
  rig.read_latency(5 * kStride, 0b0001, true);
  CHECK(writes(rig) == 8);
  rig.read_latency(6 * kStride, 0b0001);
  CHECK(writes(rig) == 8);  // Nothing is left.
}

TEST_CASE("A dirty line that makes way itself goes before those that are written later") {
  MemoryRig rig(two_lines());
  rig.memory().warm(0, 0b0001, Touch::Write);
  rig.memory().warm(kStride, 0b1111, Touch::Read);
  rig.memory().warm(2 * kStride, 0b0111, Touch::Write, Displaced::WrittenLater);  // displaces the first
  rig.memory().warm(kStride, 0b1111, Touch::Read);
  rig.read_latency(3 * kStride, 0b0001);  // makes the third line way
  CHECK(writes(rig) == 3);
  rig.read_latency(4 * kStride, 0b0001);
  CHECK(writes(rig) == 4);
}

TEST_CASE(
    "Machines that share the L2 take a place each for an access to memory of a thread, and for no other") {
  struct Shared {
    uint32_t others = 0;
    Traffic traffic = Traffic::ShaderLocal;
    uint64_t writes = 0;
  };
  for (const Shared& shared :
       {Shared{0, Traffic::ShaderLocal, 0}, Shared{1, Traffic::ShaderLocal, 3},
        Shared{2, Traffic::ShaderLocal, 3}, Shared{2, Traffic::RtStack, 3}, Shared{2, Traffic::RtNode, 0}}) {
    MemoryRig rig(two_lines());
    rig.memory().share_with(shared.others);
    rig.memory().warm(0, 0b0111, Touch::Write);
    rig.read_latency(kStride, 0b0001, false, shared.traffic);
    CHECK(writes(rig) == shared.writes);
    CHECK(reads(rig) == 1);
    CHECK(rig.memory().dirty_sectors() == 3 - shared.writes);
  }
}
