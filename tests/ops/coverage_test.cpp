// Tests that every op of the table is executed by an oracle that compares what it does, or has examples.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <string>

#include "isa/op_tests.h"
#include "isa/paths.h"
#include "tests/ops/oracle.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

Oracle oracle_of(const isa::OpRow& row) {
  for (const OracleFile& oracle : kOracles)
    if (oracle.file == isa::test_of(row)) return oracle.check;
  return nullptr;
}

}  // namespace

TEST_CASE("every op without examples does what its name says to an oracle, on both machines") {
  for (const isa::Family& family : isa::families()) DYNAMIC_SECTION(family.name) {
      for (const isa::OpRow& row : isa::op_table().subspan(family.first, family.count)) {
        if (row.examples.count > 0) continue;
        INFO(row.name << ", which " << isa::test_of(row) << " checks");
        const Oracle oracle = oracle_of(row);
        REQUIRE(oracle != nullptr);
        CHECK(oracle(row) > 0);
      }
    }
}

TEST_CASE("every op has examples or an oracle, in a file that exists") {
  for (const isa::OpRow& row : isa::op_table()) {
    INFO(row.name);
    const std::string_view test = isa::test_of(row);
    CHECK((row.examples.count > 0 || oracle_of(row) != nullptr));
    CHECK(std::filesystem::exists(std::string(GLINT_SOURCE_DIR) + "/" + std::string(test)));
  }
}

}  // namespace glint::test
