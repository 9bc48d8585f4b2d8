// Tests compute shaders: blocks, shared memory, atomics, addresses, layouts, small types, constants and entry
// points.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <functional>

#include "base/diagnostics.h"
#include "tests/shaders/compute_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using Catch::Contains;

// Runs `lab` anew for every machine and register limit, and calls `check` after each run.
void each_machine(const ComputeLab& fresh, const std::function<void(ComputeLab&)>& check) {
  for (const LabOptions& options : compute_lab_options()) {
    INFO(to_string(options));
    ComputeLab lab = fresh;
    lab.run(options);
    check(lab);
  }
}

TEST_CASE("blocks of several warps share memory, meet at barriers and know who they are") {
  ComputeLab lab("compute/shared.comp");
  constexpr uint32_t kBlocks = 6, kThreads = 160;
  lab.grid = {3, 2, 1};
  lab.buffers[0] = Words(kBlocks * kThreads * 8);
  lab.buffers[1] = Words(kBlocks);
  each_machine(lab, [](ComputeLab& after) {
    for (uint32_t block = 0; block < kBlocks; ++block) {
      const uint32_t sum = 159 * 160 * 319 / 6 + 160 * block, bx = block % 3, by = block / 3;
      CHECK(after.buffers[1][block] == sum);
      for (uint32_t t = 0; t < kThreads; ++t) {
        INFO("block " << block << " thread " << t);
        const uint32_t x = t % 16, y = t / 16 % 5, z = t / 80;
        const uint32_t* row = &after.buffers[0][(block * kThreads + t) * 8];
        CHECK(row[0] == sum + 1 + 4 * block);
        CHECK(row[1] == (x | y << 8 | z << 16));
        CHECK(row[2] == ((bx * 16 + x) | (by * 5 + y) << 8 | z << 16));
        CHECK(row[3] == (bx | by << 8 | 3 << 16 | 2 << 24));
        CHECK(row[4] == (t / 32 | 5 << 8 | 32 << 16));
        CHECK(row[5] == t % 32);
        CHECK(row[6] == 20516);
      }
    }
  });
}

TEST_CASE("atomics change buffers, shared memory and texels once for each thread") {
  ComputeLab lab("compute/atomics.comp");
  Words words(24);
  words[1] = 0xffff'ffff, words[3] = 0xffff'ffff;
  lab.buffers[0] = words;
  Words wide(24);
  wide[4] = wide[5] = 0xffff'ffff, wide[8] = wide[9] = 0xffff'ffff, wide[14] = 11;
  lab.buffers[1] = wide;
  lab.buffers[2] = Words(64);
  LabImage picture{{}, Words(8)}, line{{}, Words(4)};
  picture.view.format = exec::TexelFormat::R32Uint, picture.view.width = 4, picture.view.height = 2;
  line.view.format = exec::TexelFormat::R32Sint, line.view.width = 4, line.view.shape = isa::ImageShape::D1;
  lab.images[3] = {picture}, lab.images[4] = {line};
  each_machine(lab, [](ComputeLab& after) {
    const Words& u = after.buffers[0];
    const Words expected{192, 100, 63, 0x80, 0xffff'ffff, 0, 77, 2016, 133, 437, 9, 64};
    for (size_t i = 0; i < expected.size(); ++i) {
      INFO("word " << i);
      CHECK(u[i] == expected[i]);
    }
    CHECK(int32_t(u[16]) == -20);
    CHECK(int32_t(u[17]) == 0);
    CHECK(int32_t(u[18]) == -2016);
    CHECK(u[20] == bits(32.0f));
    CHECK(u[21] == bits(63.0f));
    CHECK(u[22] == bits(-63.0f));
    CHECK(u[23] == bits(2.5f));
    const auto at = [&](size_t i) {
      return uint64_t{after.buffers[1][2 * i]} | uint64_t{after.buffers[1][2 * i + 1]} << 32;
    };
    CHECK(at(0) == 64 * 0x1'0000'0001);
    CHECK(at(1) == uint64_t{63} << 33);
    CHECK(at(2) == uint64_t{1} << 40);
    CHECK(at(3) == ~uint64_t{0});
    CHECK(at(4) == 0);
    CHECK(at(5) == 0);
    CHECK(at(6) == 5);
    CHECK(at(7) == uint64_t{12} << 32);
    CHECK(int64_t(at(8)) == -90);
    CHECK(int64_t(at(9)) == 0);
    CHECK(at(10) == std::bit_cast<uint64_t>(16.0));
    CHECK(at(11) == std::bit_cast<uint64_t>(2016.0));
    Words old = after.buffers[2];
    std::sort(old.begin(), old.end());
    for (uint32_t i = 0; i < 64; ++i) CHECK(old[i] == 3 * i);
    CHECK(after.images[3][0].texels == Words{0, 0, 63, 0, 64, 64, 0, 0xffff'ffff});
    CHECK(after.images[4][0].texels == Words{0, 42, uint32_t(-7), uint32_t(-63)});
  });
}

// Returns numbers as std140 lays them out: each column, row or element at a multiple of 16 bytes.
Words uniforms() {
  Words w(40);
  for (uint32_t r = 0; r < 3; ++r)
    for (uint32_t c = 0; c < 3; ++c) w[4 * r + c] = bits(float(10 * r + c));  // row r, column c
  for (uint32_t i = 0; i < 2; ++i) {
    uint32_t* inner = &w[12 + 12 * i];  // a, b, then two rows of the matrix
    for (uint32_t k = 0; k < 4; ++k) inner[k] = bits(float(100 * i + k));
    for (uint32_t r = 0; r < 2; ++r)
      for (uint32_t c = 0; c < 2; ++c) inner[4 + 4 * r + c] = bits(float(1000 * i + 10 * r + c));
  }
  w.resize(48);
  for (uint32_t i = 0; i < 3; ++i) w[36 + 4 * i] = bits(float(i) + 0.5f);
  return w;
}

TEST_CASE(
    "addresses are followed, computed with and compared; blocks keep their layouts; buffers have numbers") {
  ComputeLab lab("compute/memory.comp");
  lab.buffers[0] = Words(32 * 16);
  lab.buffers[1] = uniforms();
  lab.buffers[20] = Words(64);
  for (uint32_t i = 0; i < 64; ++i) lab.buffers[20][i] = 7 * i;
  lab.buffer_arrays[2] = {{5, 50, 51}, {6, 60, 61, 62}, {7, 70, 71, 72, 73}};
  lab.buffer_arrays[3] = {{0, 0, 0, bits(3.0f)}, {0, 0, 0, bits(4.0f)}};
  lab.buffers[21] = Words(24);  // four nodes of 24 bytes; the addresses of the next nodes follow below
  lab.addressed = {21, 20, 20};
  lab.linked = {21, 24, 4};
  for (uint32_t i = 0; i < 4; ++i)
    lab.buffers[21][6 * i + 2] = 11 * i, lab.buffers[21][6 * i + 5] = bits(float(i) * 2);
  each_machine(lab, [](ComputeLab& after) {
    for (uint32_t id = 0; id < 32; ++id) {
      INFO("lane " << id);
      const uint32_t* row = &after.buffers[0][id * 16];
      const uint32_t step = id % 4;
      CHECK(row[0] == 11 * step);
      CHECK(row[1] == bits(float(step) * 2));
      CHECK(row[2] == 7 * (id + 1) + 7 * id);
      CHECK(row[3] == bits(2.0f) + 48);
      CHECK(row[4] == 7 * (id % 2 ? 2 * id : id));
      CHECK(row[5] == bits(float(10 * (id % 2) + id % 3)));
      CHECK(row[6] == bits(float(1000 * (id % 2) + 1) + 103.0f));
      CHECK(row[7] == bits(float(id % 3) + 0.5f + float(100 * (id % 2) + 1)));
      const uint32_t which = id % 3;
      CHECK(row[8] == 50 + 10 * which + id % 2 + 5 + which);
      CHECK(row[9] == 2 + which);
      CHECK(row[10] == 512);
      CHECK(row[11] == bits(id & 1 ? 4.0f : 3.0f));
    }
    for (uint32_t i = 0; i < 3; ++i) CHECK(after.buffer_arrays[2][i][2] == i + 70);
    for (uint32_t i = 0; i < 4; ++i) CHECK(after.buffers[21][6 * i + 2] == 11 * i + 1000);
  });
}

TEST_CASE("specialisation constants size blocks and arrays, by default and as given from outside") {
  const auto expect = [](uint32_t width, uint32_t count, bool more, float scale,
                         const std::map<uint32_t, uint64_t>& given) {
    ComputeLab lab("compute/special.comp");
    lab.buffers[0] = Words(width * 2 * 4);
    lab.glsl.specialization = given;
    const uint32_t size = count * 2 + (more ? 10 : 0);
    each_machine(lab, [&](ComputeLab& after) {
      for (uint32_t id = 0; id < width * 2; ++id) {
        const uint32_t* row = &after.buffers[0][id * 4];
        CHECK(row[0] == width * 100 + 2);
        CHECK(row[1] == size);
        CHECK(row[2] == bits(float(id % size) * scale));
        CHECK(row[3] == count * 10);
      }
    });
  };
  expect(4, 3, false, 0.5f, {});
  expect(40, 5, true, 4.0f, {{0, 40}, {1, 5}, {2, 1}, {3, bits(4.0f)}});
}

TEST_CASE("a module's entry points are chosen by name, and the names are told when none is given") {
  ComputeLab lab("compute/two.spvasm");
  lab.buffers[0] = Words(8);
  lab.glsl.entry_point = "wide";
  each_machine(lab, [](ComputeLab& after) {
    CHECK(after.buffers[0] == Words{20, 100, 20, 1, 100, 100, 100, 100});
  });
  lab.glsl.entry_point = "chosen";
  each_machine(lab, [](ComputeLab& after) { CHECK(after.buffers[0] == Words{5, 6, 0, 0, 0, 0, 7, 8}); });
  for (const std::string name : {"", "other"}) {
    lab.glsl.entry_point = name;
    CHECK_THROWS_WITH(lab.run(), Contains("wide, chosen"));
  }
}

TEST_CASE("what is stored through one shared block is read through another that overlaps it") {
  ComputeLab lab("compute/overlap.comp");
  lab.buffers[0] = Words(96);
  each_machine(lab, [](ComputeLab& after) {
    for (uint32_t i = 0; i < 32; ++i) {
      INFO("thread " << i);
      CHECK(after.buffers[0][i] == i + 1);
      CHECK(after.buffers[0][32 + i] == 0x10000 * ((i ^ 5) + 1) + 7 * (i ^ 5));
      CHECK(after.buffers[0][64 + i] == 0x10000 * (i + 1) + 9);
    }
  });
}

TEST_CASE("a pointer to shared memory is null only where it is the null pointer") {
  ComputeLab lab("compute/nulls.spvasm");
  lab.buffers[0] = Words(32 * 8);
  each_machine(lab, [](ComputeLab& after) {
    for (uint32_t i = 0; i < 32; ++i) {
      INFO("thread " << i);
      const uint32_t* row = &after.buffers[0][i * 8];
      CHECK(Words(row, row + 7) == Words{0, 1, i & 1, 1, 3, 0, i % 2 == 1 ? 7u : 5u});
    }
  });
}

TEST_CASE("pointers to the memory of one lane are compared as addresses, and none of them is null") {
  ComputeLab lab("compute/local_nulls.spvasm");
  lab.buffers[0] = Words(32 * 5);
  each_machine(lab, [](ComputeLab& after) {
    for (uint32_t i = 0; i < 32; ++i) {
      INFO("thread " << i);
      const uint32_t* row = &after.buffers[0][i * 5];
      CHECK(Words(row, row + 5) == Words{0, 1, 1 - (i & 1), 1, 3});
    }
  });
}

struct Cell {  // scalar layout
  uint8_t a;
  int16_t b;
  uint16_t c;
  uint64_t d;
  uint16_t e[3];
};

TEST_CASE("bytes, halves and 64-bit integers go through buffers, shared memory and whole structs") {
  ComputeLab lab("compute/widths.comp");
  static_assert(offsetof(Cell, d) == 8 && offsetof(Cell, e) == 16 && sizeof(Cell) == 24);
  std::vector<Cell> cells(32);
  for (uint32_t i = 0; i < 32; ++i)
    cells[i] = {uint8_t(i * 8 + 1),
                int16_t(100 * int(i) - 1000),
                uint16_t(0x3c00 + i),
                uint64_t(i) * 0x123456789,
                {0x4000, uint16_t(0x4400 + i), 0xc800}};
  lab.buffers[0] = Words(32 * 4);
  lab.buffers[1] = Words(32 * 6);
  std::memcpy(lab.buffers[1].data(), cells.data(), 32 * 24);
  each_machine(lab, [&](ComputeLab& after) {
    for (uint32_t id = 0; id < 32; ++id) {
      INFO("lane " << id);
      const Cell& other = cells[31 - id];
      const uint32_t* row = &after.buffers[0][id * 4];
      const bool deep = id > 3;
      const auto b = int16_t(deep ? other.b + int(id) : cells[id].b + int(id) + 1);
      CHECK(row[0] == (uint32_t(other.a) | uint32_t(uint16_t(b)) << 8));
      const float c = 1.0f + float(31 - id) / 1024.0f;
      const float e[3] = {2.0f, 4.0f + 4.0f * float(31 - id) / 1024.0f, -8.0f};
      CHECK(row[1] == bits(c + e[id % 3] + float(deep ? id : id + 1)));
      CHECK(row[2] == (uint32_t(other.d >> 20) ^ uint32_t(other.d)));
      CHECK(row[3] == ((id * 9 & 0xff) | (200 - id) << 8));
    }
    Cell last;
    std::memcpy(&last, after.buffers[1].data() + 6 * 5, sizeof(last));
    CHECK(last.d == cells[26].d + 1);
    CHECK(last.e[2] == 0x4500);
    CHECK(last.e[0] == cells[26].e[0]);
  });
}

TEST_CASE("one built-in in both its forms compiles, though glslang declares it twice") {
  CHECK(compile_lab("compute/objects.rchit").stage == isa::Stage::ClosestHit);
}

}  // namespace
}  // namespace glint::test
