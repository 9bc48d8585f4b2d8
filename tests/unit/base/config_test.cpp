// Tests how configurations are read: layers, types, ranges, places and suggestions.
// SPDX-License-Identifier: Apache-2.0
#include "base/config.h"

#include "tests/support/catch.h"

namespace glint {
namespace {

std::string only_message(const Diagnostics& diagnostics) {
  REQUIRE(diagnostics.messages().size() == 1);
  return diagnostics.messages()[0];
}

TEST_CASE("a later layer wins key by key and leaves the others") {
  Config config;
  config.add_text("a.toml", "[core]\nwarps = 8\nregisters = 100\n");
  config.add_text("b.toml", "[core]\nwarps = 16\n");
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);
  ConfigTable core = root.take_table("core");

  CHECK(core.take_integer("warps", 1, 0, 64, "warp") == 16);
  CHECK(core.take_integer("registers", 1, 0, 1000, "") == 100);
  CHECK_FALSE(diagnostics.has_errors());
}

TEST_CASE("a setting wins over a file, and a bare word is a string") {
  Config config;
  config.add_text("a.toml", "[core]\nissue = \"gto\"\nwarps = 8\n");
  config.add_setting("core.issue=lrr");
  config.add_setting("core.warps=4");
  Diagnostics diagnostics;
  ConfigTable core = config.root(diagnostics).take_table("core");

  CHECK(core.take_name("issue", "x", {"gto", "lrr"}) == "lrr");
  CHECK(core.take_integer("warps", 1, 0, 64, "") == 4);
}

TEST_CASE("an absent key keeps the fallback without an error") {
  Diagnostics diagnostics;
  ConfigTable root = Config().root(diagnostics);

  CHECK(root.take_number("x", 2.5, 0, 10, "") == 2.5);
  CHECK_FALSE(diagnostics.has_errors());
}

TEST_CASE("an unknown key is reported at its line and column with the nearest known key") {
  Config config;
  config.add_text("gpu.toml", "\n[core]\n  wraps = 8\n");
  Diagnostics diagnostics;
  ConfigTable core = config.root(diagnostics).take_table("core");
  core.take_integer("warps", 1, 0, 64, "");
  core.reject_the_rest();

  CHECK(only_message(diagnostics) ==
        "gpu.toml:3:3: error: unknown key 'core.wraps'\n  note: did you mean 'warps'?");
}

TEST_CASE("an unknown key of a table without keys is told that there are none") {
  Config config;
  config.add_text("gpu.toml", "[gto]\nage = 8\n");
  Diagnostics diagnostics;
  config.root(diagnostics).take_table("gto").reject_the_rest();

  CHECK(only_message(diagnostics) ==
        "gpu.toml:2:1: error: unknown key 'gto.age'\n  note: this table has no keys");
}

TEST_CASE("a wrong type is reported with what was found and expected, and the fallback stays") {
  Config config;
  config.add_text("gpu.toml", "warps = \"many\"\n");
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);

  CHECK(root.take_integer("warps", 7, 0, 64, "warp") == 7);
  CHECK(only_message(diagnostics) == "gpu.toml:1:1: error: 'warps' is a string, expected an integer in warp");
}

TEST_CASE("an error in a later layer is reported at the later layer's place") {
  Config config;
  config.add_text("a.toml", "[core]\nwarps = 8\n");
  config.add_text("b.toml", "[core]\n\nwarps = 99\n");
  Diagnostics diagnostics;
  config.root(diagnostics).take_table("core").take_integer("warps", 7, 0, 64, "warp");

  CHECK(only_message(diagnostics) == "b.toml:3:1: error: 'core.warps' is 99, expected 0 to 64 warp");
}

TEST_CASE("both ends of a range are allowed and one beyond either is not") {
  for (const auto& [text, ok] :
       {std::pair{"w = 1", true}, {"w = 64", true}, {"w = 0", false}, {"w = 65", false}}) {
    Config config;
    config.add_text("gpu.toml", text);
    Diagnostics diagnostics;
    config.root(diagnostics).take_integer("w", 32, 1, 64, "warp");
    CHECK(diagnostics.has_errors() == !ok);
  }
}

TEST_CASE("an integer is a number but a number is not an integer") {
  Config config;
  config.add_text("gpu.toml", "a = 3\nb = 3.0\n");
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);

  CHECK(root.take_number("a", 0, 0, 10, "") == 3.0);
  CHECK_FALSE(diagnostics.has_errors());
  CHECK(root.take_integer("b", 9, 0, 10, "") == 9);
  CHECK(diagnostics.has_errors());
}

TEST_CASE("an unknown name lists the names and suggests the nearest") {
  Config config;
  config.add_setting("issue=gtoo");
  Diagnostics diagnostics;
  config.root(diagnostics).take_name("issue", "gto", {"gto", "lrr"});

  const std::string message = only_message(diagnostics);
  CHECK(message.find("'issue' is \"gtoo\", expected one of: gto, lrr") != std::string::npos);
  CHECK(message.find("did you mean \"gto\"?") != std::string::npos);
}

TEST_CASE("a table given as a value is an error at its place") {
  Config config;
  config.add_text("gpu.toml", "core = 3\n");
  Diagnostics diagnostics;
  config.root(diagnostics).take_table("core");

  CHECK(only_message(diagnostics).rfind("gpu.toml:1:1: error: 'core' is an integer, expected a table", 0) ==
        0);
}

TEST_CASE("text that is not TOML is a user error with file and line") {
  Config config;
  try {
    config.add_text("gpu.toml", "a = 1\nb = = 2\n");
    FAIL("no error");
  } catch (const UserError& error) {
    CHECK(std::string(error.what()).rfind("gpu.toml:2:", 0) == 0);
    CHECK(error.exit() == Exit::UserInput);
  }
}

TEST_CASE("a missing file and a setting without a value are user errors") {
  Config config;
  CHECK_THROWS_AS(config.add_file("/nonexistent/gpu.toml"), UserError);
  CHECK_THROWS_AS(config.add_setting("core.warps"), UserError);
  CHECK_THROWS_AS(config.add_setting("=3"), UserError);
}

TEST_CASE("values written as TOML read back as the same type and value") {
  CHECK(config_text(3.0) == "3.0");
  CHECK(config_text(0.1) == "0.1");
  CHECK(config_text(uint32_t{7}) == "7");
  CHECK(config_text(true) == "true");
  CHECK(config_text(std::string("gto")) == "\"gto\"");
}

}  // namespace
}  // namespace glint
