// Tests what a block that runs before its turn sees, what it is compared with, and what it leaves.
// SPDX-License-Identifier: Apache-2.0
#include "exec/block_memory.h"

#include <cstring>

#include "rtunit/structure/structure.h"
#include "tests/support/catch.h"

namespace glint::exec {
namespace {

using isa::Effect;

// Holds a buffer of 256 bytes with the values 0 to 255, and another one.
struct Lab {
  mem::AddressSpace memory;
  Address buffer = memory.allocate("buffer", 256), other = memory.allocate("other", 64);
  MemoryUses uses{memory};
  Lab() {
    for (int i = 0; i < 256; ++i) byte(i) = std::byte(i);
  }
  std::byte& byte(uint32_t i) { return *memory.find(buffer + i, 1); }
  WrittenBytes nothing() const { return WrittenBytes(uses.size()); }

  void store(BlockMemory& block, uint32_t at, uint32_t bytes, int value) {
    std::memset(block.place(buffer + at, &byte(at), bytes, Effect::Store), value, bytes);
  }
  int load(BlockMemory& block, uint32_t at) {
    return int(*block.place(buffer + at, &byte(at), 1, Effect::Load));
  }
};

TEST_CASE("a block sees its own stores, and memory has them after its turn only, byte by byte") {
  Lab lab;
  WrittenBytes written = lab.nothing();
  BlockMemory first(lab.uses), second(lab.uses);
  lab.store(first, 8, 4, 77);
  lab.store(second, 12, 1, 99);
  CHECK(lab.load(first, 8) == 77);
  CHECK(lab.load(first, 12) == 12);
  CHECK(int(lab.byte(8)) == 8);
  first.commit(written, lab.uses);
  second.commit(written, lab.uses);
  CHECK(int(lab.byte(7)) == 7);
  CHECK(int(lab.byte(11)) == 77);
  CHECK(int(lab.byte(12)) == 99);
  CHECK(int(lab.byte(13)) == 13);
}

TEST_CASE(
    "a block has read what was written by the byte where somebody wrote before, and else by the buffer") {
  Lab lab;
  for (const bool known : {false, true}) {
    INFO("known to be written: " << known);
    lab.uses = MemoryUses(lab.memory);
    if (known) lab.uses[lab.uses.number_of(lab.buffer)] = AllocationUse::Written;
    WrittenBytes written = lab.nothing();
    BlockMemory writer(lab.uses), same(lab.uses), beside(lab.uses), elsewhere(lab.uses), atomic(lab.uses);
    lab.store(writer, 40, 4, 1);
    lab.load(same, 43);
    lab.load(beside, 44);
    elsewhere.place(lab.other, lab.memory.find(lab.other, 4), 4, Effect::Load);
    atomic.place(lab.buffer + 40, &lab.byte(40), 4, Effect::Atomic);
    CHECK_FALSE(same.has_read(written));
    writer.commit(written, lab.uses);
    CHECK(same.has_read(written));
    CHECK(beside.has_read(written) == !known);
    CHECK_FALSE(elsewhere.has_read(written));
    CHECK(atomic.has_read(written));
  }
}

TEST_CASE("what a block wrote itself before it read it was not read from memory") {
  Lab lab;
  WrittenBytes written = lab.nothing();
  BlockMemory first(lab.uses), second(lab.uses);
  lab.store(first, 0, 8, 1);
  lab.store(second, 0, 4, 2);
  CHECK(lab.load(second, 3) == 2);
  first.commit(written, lab.uses);
  CHECK_FALSE(second.has_read(written));
  CHECK(lab.load(second, 4) == 4);  // This byte is the first block's.
  CHECK(second.has_read(written));
}

TEST_CASE("stores into structures and samples of written images cannot be followed") {
  Lab lab;
  const uint32_t magic = rt::StructureHeader::kMagic;
  const Address structure = lab.memory.allocate("structure", 256);
  lab.memory.write(structure, &magic, sizeof magic);
  lab.uses = MemoryUses(lab.memory);
  BlockMemory block(lab.uses), reader(lab.uses);
  block.read_as_it_is(structure);
  block.read_as_it_is(lab.buffer);
  CHECK_FALSE(block.is_unsuited());
  lab.store(reader, 0, 1, 1);
  reader.read_as_it_is(lab.buffer);
  CHECK(reader.is_unsuited());
  block.place(structure + 64, lab.memory.find(structure + 64, 4), 4, Effect::Store);
  CHECK(block.is_unsuited());
}

TEST_CASE("a block has read what was written through another window on the same bytes") {
  Lab lab;
  const mem::Backing backing = lab.memory.add_backing(256);
  const Address low = lab.memory.open_window("low", backing, 0, 96),
                high = lab.memory.open_window("high", backing, 96, 32),  // It begins in low's last line.
      far = lab.memory.open_window("far", backing, 128, 128);
  lab.uses = MemoryUses(lab.memory);
  CHECK(lab.uses.number_of(low) == lab.uses.number_of(high));
  CHECK(lab.uses.number_of(low) != lab.uses.number_of(far));
  CHECK(lab.uses.number_of(far) != lab.uses.number_of(lab.buffer));
  WrittenBytes written = lab.nothing();
  BlockMemory writer(lab.uses), reader(lab.uses), beside(lab.uses);
  const auto place = [&](BlockMemory& block, Address at, Effect effect) {
    return block.place(at, lab.memory.find(at, 4), 4, effect);
  };
  std::memset(place(writer, low + 92, Effect::Store), 7, 4);
  CHECK(int(*place(writer, low + 92, Effect::Load)) == 7);
  place(reader, high, Effect::Load);
  place(beside, far, Effect::Load);
  writer.commit(written, lab.uses);
  CHECK(reader.has_read(written));
  CHECK_FALSE(beside.has_read(written));
}

}  // namespace
}  // namespace glint::exec
