// Tests expectations that do not hold: what the message says and which line it names.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "tests/amber/support.h"
#include "tests/support/catch.h"

namespace glint::amber {
namespace {

const std::string kBuffers =
    "BUFFER ints DATA_TYPE int32 DATA -1 2 3 END\n"  // line 2
    "BUFFER reals DATA_TYPE float DATA 0.1 100 nan END\n"
    "BUFFER others DATA_TYPE float DATA 0.1 101 nan END\n"
    "BUFFER bytes DATA_TYPE R8G8B8A8_UNORM WIDTH 2 HEIGHT 1 DATA 255 0 0 255  0 255 0 255 END\n"
    "BUFFER dark DATA_TYPE R8G8B8A8_UNORM WIDTH 2 HEIGHT 1 FILL 0\n"
    "BUFFER longs DATA_TYPE uint64 DATA 18446744073709551615 END\n";
const std::string kLine = "t.amber:8: failed: ";

TEST_CASE("a comparison that does not hold fails with its line, the bytes' place and both values",
          "[amber]") {
  const std::pair<const char*, const char*> wrong[] = {
      {"EXPECT ints IDX 4 EQ 5", "buffer 'ints' at byte 4 (value 0): expected == 5, found 2"},
      {"EXPECT ints IDX 0 EQ -1 2 4", "at byte 8 (value 2): expected == 4, found 3"},
      {"EXPECT ints IDX 0 NE -1", "expected != -1, found -1"},
      {"EXPECT ints IDX 0 LT -1", "expected < -1, found -1"},
      {"EXPECT ints IDX 0 GT 0", "expected > 0, found -1"},
      {"EXPECT ints IDX 4 LE 1", "expected <= 1, found 2"},
      {"EXPECT ints IDX 4 GE 3", "expected >= 3, found 2"},
      {"EXPECT longs IDX 0 LT 5", "expected < 5, found 18446744073709551615"},
      {"EXPECT reals IDX 0 EQ 0.10000003", "found 0.1"},
      {"EXPECT reals IDX 8 EQ 1", "found nan"},
      {"EXPECT reals IDX 8 GE 1", "found nan"},
      {"EXPECT reals IDX 4 TOLERANCE 0.5 EQ 101", "expected == 101 within the tolerance, found 100"},
      {"EXPECT reals IDX 4 TOLERANCE 1% EQ 102", "found 100"},
      {"EXPECT reals EQ_BUFFER others", "differ at byte 4: 100 and 101"},
      {"EXPECT bytes RMSE_BUFFER dark TOLERANCE 100", "root mean square error of at most 100, found 180"},
      {"EXPECT bytes EQ_HISTOGRAM_EMD_BUFFER dark TOLERANCE 0.5", "of at most 0.5, found 0.99609375"},
      {"EXPECT bytes IDX 0 0 SIZE 2 1 EQ_RGB 255 0 0",
       "'bytes' at 1, 0: expected 255 0 0, found 0 255 0 255"},
      {"EXPECT bytes IDX 0 0 SIZE 1 1 EQ_RGBA 255 0 0 250", "expected 255 0 0 250, found 255 0 0 255"}};
  for (const auto& [command, message] : wrong) {
    const Outcome outcome = outcome_of(kBuffers + command + "\n");
    INFO(command << ": " << outcome.message);
    CHECK(outcome.verdict == Verdict::Failed);
    CHECK(outcome.exit == Exit::Failure);
    CHECK(outcome.message.rfind(kLine, 0) == 0);
    CHECK(contains(outcome.message, message));
  }
}

TEST_CASE("comparisons that hold pass, at their very edges too", "[amber]") {
  for (const char* command :
       {"EXPECT ints IDX 0 EQ -1 2 3", "EXPECT ints IDX 0 LE -1", "EXPECT ints IDX 0 GE -1",
        "EXPECT ints IDX 0 LT 0", "EXPECT ints IDX 4 GT -1", "EXPECT longs IDX 0 GT 5",
        "EXPECT reals IDX 0 EQ 0.1 100 nan", "EXPECT reals IDX 8 NE 1",
        "EXPECT reals IDX 4 TOLERANCE 1 EQ 101", "EXPECT reals IDX 4 TOLERANCE 1% EQ 101",
        "EXPECT reals EQ_BUFFER reals", "EXPECT bytes RMSE_BUFFER dark TOLERANCE 181",
        "EXPECT bytes IDX 1 0 SIZE 1 1 EQ_RGB 0 255 0",
        "EXPECT bytes IDX 1 0 SIZE 1 1 TOLERANCE 5 EQ_RGBA 4 251 0 250"}) {
    const Outcome outcome = outcome_of(kBuffers + command + "\n");
    INFO(command << ": " << outcome.message);
    CHECK(outcome.verdict == Verdict::Passed);
    CHECK(outcome.expectations == 1);
  }
}

TEST_CASE("nothing after the first expectation that fails is looked at", "[amber]") {
  const Outcome outcome = outcome_of(kBuffers + "EXPECT ints IDX 0 EQ 7\nEXPECT ints IDX 0 EQ 8\n");
  CHECK(outcome.expectations == 1);
  CHECK(contains(outcome.message, "== 7"));
}

}  // namespace
}  // namespace glint::amber
