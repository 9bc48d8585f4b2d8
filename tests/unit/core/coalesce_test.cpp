// Tests how lane addresses are merged into sectors of lines.
// SPDX-License-Identifier: Apache-2.0
#include "core/coalesce.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/support/catch.h"

namespace glint::core {
namespace {

constexpr uint32_t kLineBytes = 128;

struct Fixture {
  Fixture() { base = memory.allocate("buffer", 1 << 16); }
  LineList& with_stride(uint64_t stride, uint32_t bytes, LaneMask lanes = kAllLanes, uint64_t offset = 0) {
    for (size_t i = 0; i < kLanes; ++i) access.address[i] = base + offset + i * stride;
    list.clear();
    coalesce_global(list, memory, access, lanes, bytes);
    return list;
  }
  mem::AddressSpace memory;
  Address base = 0;
  isa::Access access;
  LineList list{kLineBytes};
};

}  // namespace

TEST_CASE_METHOD(Fixture, "consecutive words of a warp are one line of four sectors") {
  with_stride(4, 4);

  REQUIRE(list.lines().size() == 1);
  CHECK(list.lines()[0].line == memory.physical(base));
  CHECK(list.lines()[0].sectors == 0xf);
}

TEST_CASE_METHOD(Fixture, "a stride of a line makes 32 lines of one sector, in lane order") {
  with_stride(128, 4);

  REQUIRE(list.lines().size() == 32);
  CHECK(list.num_sectors() == 32);
  for (size_t i = 0; i < 32; ++i) CHECK(list.lines()[i].line == memory.physical(base) + i * 128);
}

TEST_CASE_METHOD(Fixture, "lanes that read one word share one sector") {
  with_stride(0, 4, kAllLanes, 100);

  REQUIRE(list.lines().size() == 1);
  CHECK(list.lines()[0].sectors == 0x8);
}

TEST_CASE_METHOD(Fixture, "lanes that are off ask for nothing") {
  with_stride(128, 4, 0x8000'0001);

  REQUIRE(list.lines().size() == 2);
  CHECK(list.lines()[1].line == memory.physical(base) + 31 * 128);
}

TEST_CASE_METHOD(Fixture,
                 "a turn of an atomic takes the lanes of a sector in order, up to a word that it has") {
  const auto turns = [&](auto word, LaneMask lanes = kAllLanes, uint32_t bytes = 4, bool returns = true) {
    for (size_t i = 0; i < kLanes; ++i) access.address[i] = base + 4 * word(i);
    list.clear();
    coalesce_global(list, memory, access, lanes, bytes);
    count_turns(list, memory, access, bytes, true, returns);
    return list.lines()[0].atomic();
  };
  CHECK(int(turns([](size_t i) { return i; }).turns) == 4);      // eight lanes share a sector
  CHECK(int(turns([](size_t i) { return i * 8; }).turns) == 4);  // a line has four sectors of one lane
  CHECK(int(turns([](size_t i) { return i * 8; }).lanes) == 4);
  CHECK(int(turns([](size_t) { return 3; }).turns) == 32);
  CHECK(int(turns([](size_t i) { return i % 2; }).turns) == 16);
  // The turns take 0, 0, 0, 0+1, 1, 1, 1+2, ..., without the first of each.
  CHECK(int(turns([](size_t i) { return i / 4; }).turns) == 25);
  CHECK(int(turns([](size_t i) { return i % 8; }).turns) == 4);
  CHECK(int(turns([](size_t i) { return i % 8 * 2; }, 0xff, 8).turns) == 2);  // two sectors of four
  CHECK(int(turns([](size_t) { return 3; }, 0x101).turns) == 2);
  CHECK(int(turns([](size_t) { return 3; }, kAllLanes, 4, false).turns) == 1);  // a reduction of one word
  CHECK(int(turns([](size_t) { return 3; }, kAllLanes, 4, false).lanes) == 1);
  CHECK(int(turns([](size_t i) { return i % 2; }, kAllLanes, 4, false).turns) == 16);
  count_turns(list, memory, access, 4, false, true);
  CHECK(int(list.lines()[0].atomic().turns) == 0);
  CHECK(int(list.lines()[0].atomic().lanes) == 32);
}

TEST_CASE_METHOD(Fixture, "an access across a line's end touches both lines") {
  with_stride(0, 16, 0x1, 120);

  REQUIRE(list.lines().size() == 2);
  CHECK(list.lines()[0].sectors == 0x8);
  CHECK(list.lines()[1].sectors == 0x1);
}

TEST_CASE_METHOD(Fixture, "lanes that alternate between two lines still make two lines") {
  for (size_t i = 0; i < kLanes; ++i) access.address[i] = base + (i % 2) * 1024 + i * 4;
  coalesce_global(list, memory, access, kAllLanes, 4);

  CHECK(list.lines().size() == 2);
  CHECK(list.num_sectors() == 8);
}

TEST_CASE_METHOD(Fixture, "one word of local memory of all lanes is one whole line") {
  const LocalLayout layout{0x10000, 64};
  access.address.fill(8);  // word 2
  coalesce_local(list, layout, 3, access, kAllLanes, 4);

  REQUIRE(list.lines().size() == 1);
  CHECK(list.lines()[0].line == 0x10000 + (3 * 64 + 2) * 128);
  CHECK(list.lines()[0].sectors == 0xf);
}

TEST_CASE_METHOD(Fixture, "four words of local memory are four lines, one for each word") {
  const LocalLayout layout{0x10000, 64};
  access.address.fill(16);
  coalesce_local(list, layout, 0, access, kAllLanes, 16);

  REQUIRE(list.lines().size() == 4);
  CHECK(list.num_sectors() == 16);
  for (size_t i = 0; i < 4; ++i) CHECK(list.lines()[i].line == 0x10000 + (4 + i) * 128);
}

TEST_CASE_METHOD(Fixture, "stacks of single threads share no sector, and a vector of a lane is one sector") {
  const LocalLayout layout{0x10000, 65, true, 4};  // 260 bytes, which take 512, and 256 of attributes
  access.address.fill(16);
  coalesce_local(list, layout, 3, access, kAllLanes, 16);

  REQUIRE(list.lines().size() == 32);
  CHECK(list.num_sectors() == 32);
  for (size_t i = 0; i < 32; ++i) CHECK(list.lines()[i].line == 0x10000 + (3 * 32 + i) * 768);
  CHECK(layout.attributes(3, 31) == 0x10000 + (3 * 32 + 31) * 768 + 512);
  CHECK(layout.record(1) == 0x10000 + 4 * 32 * 768 + 256);
  CHECK(layout.record(LocalLayout::kRecords) == layout.record(0));
  CHECK(layout.bytes() == 4 * 32 * 768 + uint64_t{LocalLayout::kRecords} * 256);
}

TEST_CASE_METHOD(Fixture,
                 "the parts of a line that are touched whole are known, and those touched in part are not") {
  with_stride(8, 4, 0x0000'000f);
  CHECK(list.lines()[0].words == 0b0101'0101);

  with_stride(0, 2, 0x1, 4);  // half a word
  CHECK(list.lines()[0].words == 0);

  with_stride(0, 8, 0x1, 6);  // the end of a word, a word, the beginning of a word
  CHECK(list.lines()[0].words == 0b0100);

  with_stride(4, 4);
  CHECK(list.lines()[0].words == 0xffff'ffff);
}

TEST_CASE("a matrix takes a pass of shared memory, or as many as its rows meet in a bank") {
  isa::Access access;
  const auto passes = [&](uint32_t matrices, uint32_t spread, LaneMask lanes) {
    for (size_t lane = 0; lane < kLanes; ++lane) access.address[lane] = lane * spread;
    return matrix_passes(access, lanes, matrices, 16);
  };

  CHECK(passes(1, 16, 0xff) == 1);
  CHECK(passes(2, 16, 0xffff) == 2);
  CHECK(passes(4, 16, kAllLanes) == 4);
  CHECK(passes(4, 144, kAllLanes) == 4);
  CHECK(passes(4, 128, kAllLanes) == 32);
  CHECK(passes(1, 64, 0xff) == 4);
}

TEST_CASE("loads and stores of shared memory take the passes that an H100 takes") {
  std::ifstream file(GLINT_SOURCE_DIR "/bench/probes/shared.csv");
  std::string line;
  REQUIRE(std::getline(file, line));
  int rows = 0;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string op, bits, pattern, cycles, index;
    for (std::string* cell : {&op, &bits, &pattern, &cycles}) REQUIRE(std::getline(cells, *cell, ','));
    const auto bytes = uint32_t(std::stoul(bits) / 8);
    isa::Access access;
    LaneMask lanes = 0;
    for (size_t lane = 0; lane < kLanes; ++lane) {
      REQUIRE(std::getline(cells, index, ','));
      if (std::stoi(index) < 0) continue;
      lanes |= LaneMask{1} << lane;
      access.address[lane] = Address(std::stoi(index)) * bytes;
    }
    const double measured = std::stod(cycles);
    INFO(line);
    // The measurement includes the ends of a loop, and its stores overlap a little.
    CHECK(std::abs(shared_passes(access, lanes, bytes, op == "store") - measured) < 0.12 + 0.03 * measured);
    ++rows;
  }
  CHECK(rows == 6 * 133);
}

}  // namespace glint::core
