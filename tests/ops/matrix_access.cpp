// Checks ldmatrix and stmatrix against plain bytes: the number of matrices and their layout as the op's name
// says them.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>

#include "tests/ops/op_lab.h"
#include "tests/ops/oracle.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

constexpr uint32_t kRowBytes = 16, kWarpBytes = 512;

// Says what the name of an op asks for.
struct Form {
  bool store = false, is_transposed = false;
  uint32_t matrices = 1;
};
Form form_of(std::string_view name) {
  Form out;
  for (std::string_view part : parts_of(name)) {
    out.store |= part == "stmatrix";
    out.is_transposed |= part == "trans";
    if (part == "x2" || part == "x4") out.matrices = part == "x2" ? 2 : 4;
  }
  return out;
}

// PTX gives lane 4g + t the elements 2t and 2t + 1 of row g. Choice: elements of lanes that do not execute
// are stored as zeros, and rows of such lanes are zeros and are not stored.
uint64_t check_once(const isa::OpRow& row, int32_t displacement, uint64_t enabled) {
  const Form form = form_of(row.name);
  OpLab lab(row, displacement);
  Random random{enabled + uint64_t(displacement) + form.matrices};
  Spaces before = lab.random_spaces(random), expected = before;
  REQUIRE(lab.num_sources() == 1 + (form.store ? form.matrices : 0));
  REQUIRE(lab.num_results() == (form.store ? 0 : form.matrices));
  std::vector<Column> sources(lab.num_sources()), results(lab.num_results());
  // Rows lie in any order, and those of a warp in memory of its own.
  std::array<uint32_t, kThreads> row_at{};
  for (uint32_t t = 0; t < kThreads; ++t) {
    row_at[t] = t / 32 * kWarpBytes + (t * 13 + 5) % 32 * kRowBytes;
    sources[0][t] = uint32_t(int64_t(row_at[t]) - displacement);
  }
  for (uint32_t t = 0; t < kThreads; ++t)
    for (uint32_t m = 0; m < form.matrices; ++m) {
      const bool executes = enabled >> t & 1;
      const uint32_t lane = t % 32, first = t / 32 * 32 + 8 * m;
      if (form.store) sources[1 + m][t] = uint32_t(random.next());
      if (!form.store) results[m][t] = executes ? 0 : uint32_t(OpLab::kUntouched);
      for (uint32_t half = 0; half < 2; ++half) {
        const uint32_t g = lane / 4, along = lane % 4 * 2 + half, its_row = form.is_transposed ? along : g;
        if (!(enabled >> (first + its_row) & 1)) continue;
        uint8_t* const at = &expected.shared[row_at[first + its_row] + 2 * (form.is_transposed ? g : along)];
        uint16_t value = uint16_t(form.store && executes ? sources[1 + m][t] >> (16 * half) : 0);
        if (form.store)
          std::memcpy(at, &value, 2);
        else if (executes)
          std::memcpy(&value, at, 2), results[m][t] |= uint32_t{value} << (16 * half);
      }
    }
  const Outcome outcome = lab.run(sources, enabled, before);
  CHECK(difference(outcome, results, expected) == "");
  return outcome.lanes;
}

}  // namespace

uint64_t check_matrix_access(const isa::OpRow& row) {
  return check_once(row, 0, ~uint64_t{0}) + check_once(row, -32, ~uint64_t{0}) +
         check_once(row, 48, 0x8421'0f07'1357'9bdf);
}

}  // namespace glint::test
