// Checks asynchronous copies against plain bytes: how many come from global memory, and zeros behind them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include "tests/ops/op_lab.h"
#include "tests/ops/oracle.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

uint64_t check_once(const isa::OpRow& row, uint32_t bytes, int32_t displacement, uint64_t enabled) {
  OpLab lab(row, displacement);
  Random random{enabled + uint64_t(displacement)};
  Spaces before = lab.random_spaces(random), expected = before;
  REQUIRE(lab.num_sources() == 4);  // the shared address, the global address and the number of bytes
  std::vector<Column> sources(4);
  for (size_t t = 0; t < kThreads; ++t) {
    // Threads write into places of their own, because their order is open.
    const auto to = uint32_t(t) * 16, from = random.below(OpLab::kGlobalBytes / bytes) * bytes;
    const uint32_t size = random.below(3) == 0 ? random.below(bytes + 1) : bytes;
    const uint64_t address = lab.global_base() + from - uint64_t(int64_t(displacement));
    sources[0][t] = to;
    sources[1][t] = uint32_t(address);
    sources[2][t] = uint32_t(address >> 32);
    sources[3][t] = size;
    if (!(enabled >> t & 1)) continue;
    std::copy_n(before.global.begin() + from, size, expected.shared.begin() + to);
    std::fill_n(expected.shared.begin() + to + size, bytes - size, uint8_t{0});
  }
  const Outcome outcome = lab.run(sources, enabled, before);
  CHECK(difference(outcome, {}, expected) == "");
  return outcome.lanes;
}

}  // namespace

uint64_t check_copy(const isa::OpRow& row) {
  const std::string_view bits = parts_of(row.name).back().substr(1);
  uint32_t count = 0;
  std::from_chars(bits.data(), bits.data() + bits.size(), count);
  return check_once(row, count / 8, 0, ~uint64_t{0}) + check_once(row, count / 8, 32, 0x8421'0f07'1357'9bdf) +
         check_once(row, count / 8, -48, 0x7000'0000'ffff'0000);
}

}  // namespace glint::test
