// Runs whole scripts on both machines.
// SPDX-License-Identifier: Apache-2.0
#include "tests/amber/support.h"
#include "tests/support/catch.h"

namespace glint::amber {
namespace {

Outcome run(const std::string& name, bool timing) {
  LaunchOptions options;
  options.timing = timing;
  return run_script(std::string(GLINT_SOURCE_DIR) + "/tests/amber/scripts/" + name + ".amber", options);
}

TEST_CASE("scripts of every kind pass on the functional machine", "[amber]") {
  for (const char* name :
       {"values",    "shared",      "spirv",         "layouts", "images",   "rays",     "options",
        "resources", "entries",     "numbers",       "files",   "sections", "versions", "first_hit",
        "strides",   "far_binding", "chosen_arrays", "samples", "robust",   "clamped"}) {
    const Outcome outcome = run(name, false);
    INFO(name << ": " << outcome.message);
    CHECK(outcome.verdict == Verdict::Passed);
    CHECK(outcome.launches >= 1);
    CHECK(outcome.expectations >= 1);
    CHECK(outcome.cycles == 0);
  }
}

TEST_CASE("a script passes on the timing machine and takes time there", "[amber]") {
  for (const char* name : {"shared", "rays", "robust"}) {
    const Outcome outcome = run(name, true);
    INFO(name << ": " << outcome.message);
    CHECK(outcome.verdict == Verdict::Passed);
    CHECK(outcome.cycles > 100);
  }
}

TEST_CASE("REPEAT runs its commands as often as it says", "[amber]") {
  const Outcome outcome = run("shared", false);
  CHECK(outcome.launches == 5);
}

TEST_CASE("a script that is not there fails as bad input", "[amber]") {
  const Outcome outcome = run("no_such_script", false);
  CHECK(outcome.verdict == Verdict::Failed);
  CHECK(outcome.exit == Exit::UserInput);
  CHECK(contains(outcome.message, "cannot read"));
}

}  // namespace
}  // namespace glint::amber
