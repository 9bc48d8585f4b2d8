// Tests which passes of SPIRV-Tools a module gets, by its size and by what it declares.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/passes.h"

#include <algorithm>
#include <tuple>

#include "frontend/compile.h"
#include "tests/support/catch.h"

namespace glint::frontend {
namespace {

std::vector<uint32_t> module_with(const std::string& before, const std::string& body) {
  return glsl_text_to_spirv("#version 460\nlayout(binding = 0) buffer B { float v[]; };\n" + before +
                                "void main() {\n" + body + "\n}\n",
                            "t.comp", isa::Stage::Compute, {});
}

std::string table(int numbers) {
  std::string text = "const float t[" + std::to_string(numbers) + "] = float[](0.0";
  for (int i = 1; i < numbers; ++i) text += ", " + std::to_string(i) + ".0";
  return text + ");\n";
}

long count(const PassList& passes, const std::string& name) {
  return std::count(passes.names.begin(), passes.names.end(), name);
}

TEST_CASE("a large module without calls is optimised once, and others before and after inlining") {
  const auto words = module_with("", "v[0] = v[1];");
  for (const auto& [size, rewrites, promotes_over] :
       {std::tuple{InlinedSize{8192, 0}, 2, std::optional<uint32_t>()},
        {InlinedSize{8193, 0}, 1, 0},
        {InlinedSize{100'000, 0}, 1, 0},
        {InlinedSize{8192, 1}, 2, std::nullopt},
        {InlinedSize{8193, 1}, 2, 2000},
        {InlinedSize{100'000, 1}, 2, 0}}) {
    INFO(size.instructions << " instructions and " << size.calls << " calls");
    const PassList passes = passes_of(words, size);
    CHECK(count(passes, kSsaRewrite) == rewrites);
    CHECK(count(passes, "--inline-entry-points-exhaustive") == rewrites - 1);
    CHECK(passes.promotes_over == promotes_over);
    CHECK(passes.names.at(0) == "--strip-nonsemantic");
  }
}

TEST_CASE(
    "aggregates above 1,024 bytes are split whatever their length, and smaller ones up to 100 members") {
  for (const auto& [numbers, limited] : {std::pair{"256", 2}, {"257", 0}}) {
    const auto words =
        module_with("", std::string("float a[") + numbers + "]; a[1] = v[0]; v[1] = a[1] + a[int(v[2])];");
    const PassList passes = passes_of(words, {10, 0});
    CHECK(count(passes, "--scalar-replacement=100") == limited);
    CHECK(count(passes, "--scalar-replacement=0") == 2 - limited);
  }
}

TEST_CASE("unused constants stay where a constant has more than 2,000 members") {
  const std::string body = "v[0] = t[int(v[1])];";
  CHECK(count(passes_of(module_with(table(2000), body), {10, 0}), "--eliminate-dead-const") == 1);
  CHECK(count(passes_of(module_with(table(2001), body), {10, 0}), "--eliminate-dead-const") == 0);
}

}  // namespace
}  // namespace glint::frontend
