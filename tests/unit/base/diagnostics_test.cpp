// Tests the wording of diagnostics and the choice of "did you mean".
// SPDX-License-Identifier: Apache-2.0
#include "base/diagnostics.h"

#include "tests/support/catch.h"

namespace glint {
namespace {

TEST_CASE("a place leaves out what is not known") {
  CHECK(SourceLocation{"a.rgen", 3, 4}.to_string() == "a.rgen:3:4");
  CHECK(SourceLocation{"a.rgen", 3, 0}.to_string() == "a.rgen:3");
  CHECK(SourceLocation{"a.rgen", 0, 4}.to_string() == "a.rgen");
  CHECK(SourceLocation{"", 3, 4}.to_string().empty());
}

TEST_CASE("a user error says place, fault and fix, and exits with 2") {
  const UserError error({"a.toml", 2, 1}, "bad", "do good");
  CHECK(std::string(error.what()) == "a.toml:2:1: error: bad\n  note: do good");
  CHECK(int(error.exit()) == 2);
  CHECK(int(UnsupportedError("x").exit()) == 3);
}

TEST_CASE("a warning alone does not throw and two errors throw together") {
  Diagnostics diagnostics;
  diagnostics.warning({"a", 1, 1}, "odd");
  CHECK_NOTHROW(diagnostics.throw_if_errors());

  diagnostics.error({"a", 2, 1}, "one");
  diagnostics.error({"a", 3, 1}, "two");
  CHECK_THROWS_WITH(diagnostics.throw_if_errors(),
                    "a:1:1: warning: odd\na:2:1: error: one\na:3:1: error: two");
}

TEST_CASE("the nearest word is suggested and a far one is not") {
  const std::vector<std::string> words{"warps", "registers", "gto"};
  CHECK(nearest("wraps", words) == "warps");
  CHECK(nearest("register", words) == "registers");
  CHECK(nearest("zzzzz", words).empty());
  CHECK(nearest("x", {}).empty());
}

}  // namespace
}  // namespace glint
