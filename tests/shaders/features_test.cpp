// Compiles shaders that use many features at once and verifies them with few registers and with many.
// SPDX-License-Identifier: Apache-2.0
#include "isa/verify.h"
#include "tests/shaders/ray_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

TEST_CASE("shaders that use many features at once compile to programs that verify") {
  const std::string file = GENERATE(as<std::string>{}, "halves.comp", "mixed.comp", "addresses.rgen",
                                    "ballots.comp", "blocks.comp", "small_groups.comp", "nested.comp",
                                    "pointers_in_calls.comp", "legacy.rgen", "wide.rgen");
  for (const uint32_t registers : {24u, 64u}) {
    INFO(file << " with " << registers << " registers");
    CHECK(compile_lab("features/" + file, {}, {registers, true, false}).code.size() > 8);
  }
}

TEST_CASE("printing does not keep the rest from being simplified") {
  Diagnostics warnings;
  const isa::Program program = frontend::compile_file(lab_file("features/printing.comp"), {}, {}, warnings);
  CHECK(warnings.messages().empty());
  CHECK(program.messages == std::vector<std::string>{"a %d"});
  CHECK(program.local_bytes == 0);
}

}  // namespace
}  // namespace glint::test
