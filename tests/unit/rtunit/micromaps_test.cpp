// Tests the order of micro-triangles, and how maps come into structures.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/structure/micromaps.h"

#include <cstddef>
#include <set>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/rt_brute.h"

namespace glint::rt::test {
namespace {

TEST_CASE("micro-triangles follow each other as the figure in Vulkan's specification shows") {
  // These are the middles of the 16 parts in order, in twelfths of the weights of corners 1 and 2.
  constexpr int kOrder[16][2] = {{1, 1}, {2, 2}, {4, 1},  {1, 4}, {2, 5}, {4, 4}, {5, 5}, {5, 2},
                                 {7, 1}, {8, 2}, {10, 1}, {7, 4}, {4, 7}, {2, 8}, {1, 7}, {1, 10}};
  for (uint32_t i = 0; i < 16; ++i) {
    CAPTURE(i);
    CHECK(number_of(micro_triangle_at(float(kOrder[i][0]) / 12, float(kOrder[i][1]) / 12, 2), 2) == i);
  }
}

TEST_CASE("each part of a level has a number of its own, and its first digits are those of the level above") {
  for (uint32_t level = 0; level <= MicromapFormat::kMostLevels; ++level) {
    std::set<uint32_t> numbers;
    const uint32_t size = 1u << level;
    for (uint32_t u = 0; u < size; ++u)
      for (uint32_t v = 0; u + v < size; ++v)
        for (const bool is_flipped : {false, true}) {
          if (is_flipped && u + v + 1 == size) continue;
          const uint32_t number = number_of({u, v, is_flipped}, level);
          numbers.insert(number);
          const float third = is_flipped ? 2.0f / 3 : 1.0f / 3;
          const float at_u = (float(u) + third) / float(size), at_v = (float(v) + third) / float(size);
          REQUIRE(number_of(micro_triangle_at(at_u, at_v, level), level) == number);
          if (level) REQUIRE(number_of(micro_triangle_at(at_u, at_v, level - 1), level - 1) == number / 4);
        }
    CHECK(numbers.size() == MicromapFormat{false, level}.num_states());
    CHECK(*numbers.rbegin() + 1 == numbers.size());
  }
}

TEST_CASE("weights on and behind the edges of a triangle name a part of it") {
  Random random{2};
  for (int i = 0; i < 10000; ++i) {
    const uint32_t level = random.below(MicromapFormat::kMostLevels + 1);
    const float u = random.uniform(-1e-6f, 1.000001f);
    const float v = random.below(2) ? 1 - u : random.uniform(-1e-6f, 1.000001f - u);
    REQUIRE(number_of(micro_triangle_at(u, v, level), level) < MicromapFormat{false, level}.num_states());
  }
}

TEST_CASE("leaves with the same maps share them, and structures stay valid") {
  // A strip of pairs of triangles, which all have the same two maps.
  constexpr uint32_t kPairs = 100;
  BottomScene bottom;
  Positions positions;
  for (uint32_t i = 0; i < kPairs; ++i) {
    const auto x = float(i);
    for (const auto& p :
         Positions{{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}})
      positions.push_back(p);
  }
  bottom.add_triangles(std::move(positions), false);
  Micromaps maps{{false, 3}, {}, std::vector<uint8_t>(32, 0x55)};
  for (uint32_t i = 0; i < kPairs; ++i) maps.index.insert(maps.index.end(), {0, 1});
  const uint64_t plain = encode_bottom("it", bottom.level).bytes.size();
  bottom.add_micromaps(maps);
  const EncodedStructure with = encode_bottom("it", bottom.level);
  CHECK(with.bytes.size() <= plain + 2 * kLeafBytes);
  const auto header = load<StructureHeader>(with.bytes.data());
  REQUIRE(header.micromaps != 0);
  const auto table = load<MicromapTable>(with.bytes.data() + size_t{header.micromaps} * kBlockBytes);
  CHECK(table.num_maps == 2);
  CHECK(table.format() == maps.format);
  for (uint32_t threads : {2u, 3u}) {
    const EncodedStructure again = encode_bottom("it", bottom.level, {}, threads);
    CHECK(std::equal(with.bytes.data(), with.bytes.data() + with.bytes.size(), again.bytes.data()));
  }
}

}  // namespace
}  // namespace glint::rt::test
