// Tests how the optimiser is helped: lengths of arrays that are 0 by default, any-hit shaders that end in
// continue constructs, and queries of levels.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/diagnostics.h"
#include "exec/texture_format.h"
#include "frontend/compile.h"
#include "frontend/spirv/module_repairs.h"
#include "tests/shaders/compute_lab.h"
#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

TEST_CASE("an any-hit shader ends in a function that a loop's continue construct calls") {
  RayLab lab({"anyhit.rgen", {"anyhit.rmiss"}, {{}, {"anyhit.rchit", "continue.rahit", ""}}, {}});
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    if (x < 2 || x >= 6) return Row{0, 0, 7, 0};
    const uint32_t geometry = x & 1, hit = 50 + geometry;
    if (y % 2 == 0 && geometry == 0) return Row{0, 0, hit, 0};  // opaque
    if (y == 1) return Row{203, 0, 7, 1};
    if (y == 3) return Row{304, 0, hit, 2};
    return Row{404, 1000, hit, 0};
  });
}

TEST_CASE(
    "small constants of specialisation constants, and structures that ?: takes from blocks, have their "
    "values") {
  ComputeLab lab("compute/glslang_repairs.comp");
  lab.glsl.specialization = {{0, std::bit_cast<uint32_t>(2.5f)}, {1, uint32_t(-7)}};
  lab.buffers[0] = Words(32 * 12);
  lab.buffers[1] = Words(128);
  for (const LabOptions& options : compute_lab_options()) {
    ComputeLab after = lab;
    after.run(options);
    for (uint32_t lane = 0; lane < 32; ++lane) {
      INFO(to_string(options) << ", thread " << lane);
      const uint32_t other = lane ^ 1;
      const bool is_kept = lane > 20;
      const uint32_t* row = after.buffers[1].data() + size_t{4} * lane;
      CHECK(row[0] == (is_kept ? 200 : 100) + other);
      CHECK(row[1] == (is_kept ? 900 : 700) + other);
      CHECK(row[2] == (is_kept ? 2 : 1) * other);
      const uint32_t halves = 0x4100u | uint32_t{exec::to_half(float(lane))} << 16;  // 2.5 is 0x4100
      CHECK(row[3] == (uint32_t(int(lane) - 7) ^ halves));
    }
  }
}

TEST_CASE("arrays are as long as the specialisation constants that are set say") {
  ComputeLab lab("compute/lengths.comp");
  lab.glsl.specialization = {{1, 12}, {2, 4}};
  lab.buffers[0] = Words(32);
  lab.run();
  for (uint32_t i = 0; i < 32; ++i) CHECK(lab.buffers[0][i] == 3 * (i ^ 1) + 300 + 7);
}

TEST_CASE(
    "a shader whose arrays have length 0 by default compiles, with a warning that names the arrays' "
    "constant") {
  Diagnostics warnings;
  frontend::compile_file(lab_file("compute/lengths.comp"), {}, {}, warnings);
  REQUIRE(warnings.messages().size() == 1);
  CHECK_THAT(warnings.messages()[0], Catch::Contains("kParts") && Catch::Contains("taken as 1"));
}

TEST_CASE("arrays of constant lengths, and lengths that are not 0, are left as they are") {
  const auto words = frontend::spirv_of_file(lab_file("compute/query_lod.comp"), {});
  CHECK_FALSE(frontend::has_specialised_lengths(words));
  std::vector<std::string> names;
  CHECK(frontend::with_positive_lengths(words, &names) == words);
}

TEST_CASE("textureQueryLod tells the level of the wider step, held to the image's levels and before that") {
  ComputeLab lab("compute/query_lod.comp");
  lab.buffers[0] = Words(64);
  LabImage image;
  image.view.format = exec::TexelFormat::R32Float;
  image.view.width = image.view.height = 4, image.view.levels = 3;
  image.texels.assign(16 + 4 + 1, 0);
  lab.images[1] = {image};
  for (const LabOptions& options : compute_lab_options()) {
    ComputeLab after = lab;
    after.run(options);
    for (uint32_t i = 0; i < 32; ++i) {
      INFO(to_string(options) << ", thread " << i);
      const float wanted = std::array{-1.0f, 0.0f, 1.0f, 6.0f}[i / 16 * 2 + i % 8 / 4];
      const auto level = [&](uint32_t word) { return std::bit_cast<float>(after.buffers[0][word]); };
      CHECK(level(2 * i) == std::min(std::max(wanted, 0.0f), 2.0f));
      CHECK(level(2 * i + 1) == wanted);
    }
  }
}

}  // namespace
}  // namespace glint::test
