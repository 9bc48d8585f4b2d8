// Tests what cores see of each other's stores and atomics within a turn, and the order in which memory gets
// them.
// SPDX-License-Identifier: Apache-2.0
#include "exec/memory_view.h"

#include <cstring>
#include <vector>

#include "memsys/address_space.h"
#include "tests/support/catch.h"

namespace glint::exec {
namespace {

struct TwoCores {
  TwoCores() { bytes = memory.find(memory.allocate("words", kWords * 4), kWords * 4); }
  std::byte* at(uint32_t word) { return bytes + word * 4; }
  uint32_t in_memory(uint32_t word) {
    uint32_t value;
    std::memcpy(&value, at(word), 4);
    return value;
  }
  uint32_t seen(const MemoryView& view, uint32_t word) {
    std::array<std::byte, MemoryView::kWidest> scratch;
    uint32_t value;
    std::memcpy(&value, view.read(at(word), 4, scratch), 4);
    return value;
  }
  void store(MemoryView& view, Cycle now, uint32_t word, uint32_t value) {
    view.begin(now);
    view.store(at(word), &value, 4);
  }
  // Adds `add` to the word, and puts the old value into `to`.
  void add(MemoryView& view, Cycle now, uint32_t word, uint32_t add, uint32_t* to) {
    view.begin(now);
    view.modify({at(word), [](uint64_t old, uint64_t b, uint64_t) { return old + b; }, add, 0, 4, to});
  }
  void end_turn() {
    MemoryView* const both[] = {&first, &second};
    MemoryView::commit(both);
  }
  static constexpr uint32_t kWords = 64 * 1024;
  mem::AddressSpace memory;
  std::byte* bytes;
  MemoryView first, second;
};

}  // namespace

TEST_CASE("a core sees its own stores at once, and those of others from the next turn on") {
  TwoCores cores;
  cores.store(cores.first, 3, 5, 77);

  CHECK(cores.seen(cores.first, 5) == 77);
  CHECK(cores.seen(cores.second, 5) == 0);
  CHECK(cores.in_memory(5) == 0);
  cores.end_turn();
  CHECK(cores.seen(cores.second, 5) == 77);
  CHECK_FALSE(cores.first.touched());
}

TEST_CASE("of stores to one place the latest stays, and of equally late ones the higher core's") {
  TwoCores cores;
  cores.store(cores.second, 4, 0, 2);
  cores.store(cores.first, 5, 0, 1);
  cores.store(cores.first, 9, 1, 1);
  cores.store(cores.second, 9, 1, 2);
  cores.end_turn();

  CHECK(cores.in_memory(0) == 1);
  CHECK(cores.in_memory(1) == 2);
}

TEST_CASE("cores that store to different bytes of a line leave each other's alone") {
  TwoCores cores;
  for (uint32_t word = 0; word < 16; ++word)
    cores.store(word % 2 ? cores.first : cores.second, 40 - word, word, word + 1);
  cores.end_turn();

  for (uint32_t word = 0; word < 16; ++word) CHECK(cores.in_memory(word) == word + 1);
}

TEST_CASE("atomics and stores of all cores take turns in order of cycle, then core") {
  TwoCores cores;
  uint32_t old[4] = {99, 99, 99, 99};
  cores.add(cores.second, 1, 7, 10, &old[0]);
  cores.add(cores.second, 6, 7, 10, &old[3]);
  cores.store(cores.first, 3, 7, 100);
  cores.add(cores.first, 6, 7, 1, &old[2]);
  CHECK(old[0] == 99);  // nothing is known yet
  cores.end_turn();

  CHECK(old[0] == 0);
  CHECK(old[2] == 100);
  CHECK(old[3] == 101);
  CHECK(cores.in_memory(7) == 111);
}

TEST_CASE(
    "only the bytes that an atomic changes wait for the turn's end, until a store of the core covers them") {
  TwoCores cores;
  cores.add(cores.first, 1, 7, 10, nullptr);

  CHECK(cores.first.waits(cores.at(7), 4));
  CHECK(cores.first.waits(cores.at(7) + 3, 1));
  CHECK(cores.first.waits(cores.at(6), 8));
  CHECK_FALSE(cores.first.waits(cores.at(6), 4));
  CHECK_FALSE(cores.first.waits(cores.at(8), 4));
  CHECK_FALSE(cores.second.waits(cores.at(7), 4));
  cores.store(cores.first, 2, 7, 50);
  CHECK_FALSE(cores.first.waits(cores.at(7), 4));
  CHECK(cores.seen(cores.first, 7) == 50);
  cores.end_turn();
  CHECK(cores.in_memory(7) == 50);
}

TEST_CASE("a load behind an atomic reads what the atomic left, and not a later store") {
  TwoCores cores;
  uint32_t row[32] = {};
  cores.store(cores.first, 0, 7, 0xfffffff0);
  cores.add(cores.first, 1, 7, 5, nullptr);
  cores.first.begin(2);
  cores.first.load(MemoryView::Load{cores.at(7), 4, false, &row[0]});
  cores.first.load(MemoryView::Load{cores.at(7), 1, true, &row[1]});
  cores.first.load(MemoryView::Load{cores.at(7), 1, false, &row[2]});
  cores.store(cores.first, 3, 7, 1);
  CHECK(row[0] == 0);
  cores.end_turn();

  CHECK(row[0] == 0xfffffff5);
  CHECK(row[1] == 0xfffffff5);
  CHECK(row[2] == 0xf5);
}

TEST_CASE("an access across two lines is read and stored in both") {
  TwoCores cores;
  const uint64_t value = 0x1122334455667788;
  cores.first.begin(0);
  cores.first.store(cores.bytes + 60, &value, 8);
  std::array<std::byte, MemoryView::kWidest> scratch;
  uint64_t seen = 0;
  std::memcpy(&seen, cores.first.read(cores.bytes + 60, 8, scratch), 8);
  CHECK(seen == value);
  cores.end_turn();

  CHECK(cores.in_memory(15) == 0x55667788);
  CHECK(cores.in_memory(16) == 0x11223344);
}

TEST_CASE("a core keeps any number of lines apart, turn after turn") {
  TwoCores cores;
  for (uint32_t turn = 1; turn <= 3; ++turn) {
    for (uint32_t line = 0; line < 4000; ++line)
      cores.store(cores.first, line, line * 16, turn * 10'000 + line);
    bool all = true;
    for (uint32_t line = 0; line < 4000; ++line) {
      all &= cores.seen(cores.first, line * 16) == turn * 10'000 + line;
      all &= cores.in_memory(line * 16) == (turn == 1 ? 0 : (turn - 1) * 10'000 + line);
    }
    CHECK(all);
    cores.end_turn();
  }
  CHECK(cores.in_memory(3999 * 16) == 33'999);
}

}  // namespace glint::exec
