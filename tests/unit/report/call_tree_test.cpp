// Tests stacks of calls from the text of a shader.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/call_tree.h"

#include "report/files/profile_files.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::report;

namespace {

const std::string kMain = R"(#version 460
#define CALL(x) helper(x)   // no call
layout(set = 0, binding = 0) buffer Out { float x[]; } o;
struct Light { vec3 at; };
float twice(float x) { return x + x; }
void main() {
  /* shade(1.0); is no call either
  */
  float sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    sum += shade(float(i));  // line 11
  }
  o.x[0] = sum + twice(sum) + twice(1.0);
}
)";
const std::string kInclude = R"(float fresnel(float c) {
  return 1.0 - c;
}
float shade(float x)
{
  if (x > 1.0) return fresnel(x);
  return twice(x);
}
float over(int a) { return 1.0; }
float over(float a) { return over(int(a)); }
)";

CallTree tree() {
  return CallTree({"a.rgen", "b.glsl", "gone.glsl"},
                  [](const std::string& file) -> std::optional<std::string> {
                    if (file == "a.rgen") return kMain;
                    if (file == "b.glsl") return kInclude;
                    return std::nullopt;
                  });
}
using Frames = std::vector<std::string>;

}  // namespace

TEST_CASE("a line stands under the calls that lead to it") {
  CHECK(tree().frames("a.rgen", 11) == Frames{"main", "a.rgen:11"});
  CHECK(tree().frames("b.glsl", 7) == Frames{"main", "a.rgen:11", "shade", "b.glsl:7"});
  CHECK(tree().frames("b.glsl", 2) ==
        Frames{"main", "a.rgen:11", "shade", "b.glsl:6", "fresnel", "b.glsl:2"});
}

TEST_CASE("a function that is called from several places, has overloads or calls itself begins its stack") {
  CHECK(tree().frames("a.rgen", 5) == Frames{"twice", "a.rgen:5"});
  CHECK(tree().frames("b.glsl", 9) == Frames{"over", "b.glsl:9"});
  const CallTree self({"c"}, [](const std::string&) {
    return std::optional<std::string>("void f(int n) {\n  f(n - 1);\n}\n");
  });
  CHECK(self.frames("c", 2) == Frames{"f", "c:2"});
}

TEST_CASE("a line outside of all functions, or of a file that cannot be read, stands alone") {
  CHECK(tree().frames("a.rgen", 3) == Frames{"a.rgen:3"});
  CHECK(tree().frames("gone.glsl", 8) == Frames{"gone.glsl:8"});
}

TEST_CASE("functions that call each other end their stack") {
  const CallTree two({"c"}, [](const std::string&) {
    return std::optional<std::string>("void f() {\n  g();\n}\nvoid g() {\n  f();\n}\n");
  });
  CHECK(two.frames("c", 2).size() <= 6);
}

TEST_CASE("stacks of a profile have the stage, the calls and the reason") {
  ProfileTable profile;
  profile.reasons = {"issued", "raw_fixed"};
  ProfileRow row;
  row.shader = "a.rgen", row.stage = "raygen", row.file = "b.glsl", row.line = 2, row.slots = {3, 4};
  profile.rows.push_back(row);
  row.file = "a.rgen", row.line = 11, row.slots = {5, 0};
  profile.rows.push_back(row);
  const std::string folded = profile_folded(profile, [](const std::string& file) {
    return std::optional<std::string>(file == "a.rgen" ? kMain : kInclude);
  });
  CHECK(folded ==
        "raygen;main;a.rgen:11;issued 5\n"
        "raygen;main;a.rgen:11;shade;b.glsl:6;fresnel;b.glsl:2;issued 3\n"
        "raygen;main;a.rgen:11;shade;b.glsl:6;fresnel;b.glsl:2;raw_fixed 4\n");
}
