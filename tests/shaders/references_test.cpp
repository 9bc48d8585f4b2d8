// Tests parameters that GLSL copies in and out: arrays passed by reference must look as if they had been
// copied.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <filesystem>
#include <span>

#include "frontend/compile.h"
#include "frontend/spirv/by_reference.h"
#include "frontend/spirv/spirv.h"
#include "tests/shaders/compute_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using Eight = std::array<uint32_t, 8>;

void bump(Eight& a, uint32_t at) {
  a[at & 7] += 1 + at;
}

void twice(Eight& a, uint32_t at) {
  bump(a, at);
  if (a[1] > 20) return;
  bump(a, at + 3);
  a[2] ^= 5;
}

void both(Eight& a, Eight& b) {
  a[0] += 100;
  b[0] += b[0];
  a[1] = b[0];
}

std::array<uint32_t, 19> expected_words(uint32_t lane) {
  Eight a, b;
  for (uint32_t i = 0; i < 8; ++i) a[i] = lane + i, b[i] = lane * i;
  twice(a, lane);
  both(a, b);
  const uint32_t second = a[0] + b[0];
  b[0] += b[0];     // both(b, b): the value that is copied back last stays
  a[3] = a[3] + 1;  // part: the element is copied back after the array
  b[3] = 9;         // part_first: the element is copied back before the array
  a[4] += 3;
  a[5] += a[4];
  std::array<uint32_t, 19> words{};
  for (uint32_t i = 0; i < 8; ++i) words[i] = a[i], words[8 + i] = b[i];
  words[16] = second;
  words[17] = lane;  // the global variable does not show what a function wrote to its copy
  words[18] = 5;
  return words;
}

TEST_CASE(
    "parameters copied in and out are what copies would make of them, whoever else names the variable") {
  for (const LabOptions& options : compute_lab_options()) {
    ComputeLab lab("compute/references.comp");
    lab.buffers[0].assign(32 * 32, 0);
    lab.run(options);
    for (uint32_t lane = 0; lane < 32; ++lane) {
      const auto row = std::span(lab.buffers[0]).subspan(lane * 32, 19);
      const auto words = expected_words(lane);
      CAPTURE(lane);
      CHECK(std::vector<uint32_t>(row.begin(), row.end()) ==
            std::vector<uint32_t>(words.begin(), words.end()));
    }
  }
}

TEST_CASE("copies around calls go where nothing tells the difference, and the module stays valid") {
  const std::string path = std::string(GLINT_SOURCE_DIR) + "/tests/shaders/glsl/compute/references.comp";
  const std::vector<uint32_t> before = frontend::glsl_to_spirv(path, {}),
                              after = frontend::with_references(before);
  CHECK(after.size() < before.size());
  CHECK(frontend::validate_spirv(after).empty());
  CHECK(frontend::with_references(after) == after);
}

}  // namespace
}  // namespace glint::test
