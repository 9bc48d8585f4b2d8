// Tests what the frontend refuses: everything at once, by name, with file and line, also in included files.
// SPDX-License-Identifier: Apache-2.0
#include "base/diagnostics.h"
#include "tests/shaders/ray_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using Catch::Contains;

template <class Kind>
std::string message_of(const std::string& file) {
  try {
    compile_lab(file);
  } catch (const Kind& error) {
    return error.what();
  }
  return "not refused";
}

TEST_CASE("all that is unsupported in one shader comes in one message, by name, line and count") {
  const std::string message = message_of<UnsupportedError>("refused.rgen");
  const std::string file = lab_file("refused.rgen");
  for (const char* expected :
       {":18: OpImageSparseSampleExplicitLod (2 times)", "capability SparseResidency"}) {
    INFO(expected);
    CHECK_THAT(message, Contains(expected));
  }
  CHECK_THAT(message, Contains(file + ":18: ") && !Contains("function 53") && !Contains("capability 4"));
}

TEST_CASE("an unsupported op in an included function is listed under the included file's line") {
  CHECK_THAT(message_of<UnsupportedError>("refused.rgen"),
             Contains("parts/refused.glsl:5: OpImageSparseFetch"));
}

TEST_CASE("a mistake in a file that an included file includes is reported there") {
  CHECK_THAT(message_of<UserError>("mistake.rchit"), Contains("glsl/parts/mistake.glsl:6: error: 'nothing'"));
}

TEST_CASE(
    "a capability younger than the validator is refused by its number, with the extension that brings it") {
  CHECK_THAT(message_of<UnsupportedError>("future.rchit"),
             Contains("capability 2147483000") && Contains("SPV_GLINT_from_the_future"));
}

TEST_CASE("a GLSL extension younger than the compiler is refused by name at its line") {
  CHECK_THAT(message_of<UnsupportedError>("future.rmiss"),
             Contains(":5: error: '#extension' : extension not supported: GL_GLINT_from_the_future"));
}

TEST_CASE(
    "a second incoming payload, callable data or hit attribute of a shader is refused, and both are named") {
  struct Row {
    const char* qualifier;
    isa::Stage stage;
    const char* storage;
  };
  const Row rows[] = {{"rayPayloadIn", isa::Stage::Miss, "IncomingRayPayloadKHR"},
                      {"rayPayloadIn", isa::Stage::ClosestHit, "IncomingRayPayloadKHR"},
                      {"callableDataIn", isa::Stage::Callable, "IncomingCallableDataKHR"},
                      {"hitAttribute", isa::Stage::AnyHit, "HitAttributeKHR"}};
  for (const Row& row : rows) {
    INFO(row.qualifier);
    const bool has_location = std::string(row.qualifier) != "hitAttribute";
    const auto declared = [&](int location, const char* name) {
      return (has_location ? "layout(location = " + std::to_string(location) + ") " : std::string()) +
             row.qualifier + "EXT vec2 " + name + ";\n";
    };
    const auto compile = [&](const std::string& declarations) {
      frontend::glsl_text_to_spirv(
          "#version 460\n#extension GL_EXT_ray_tracing : require\n" + declarations + "void main() {}\n",
          "twice", row.stage, {});
    };
    CHECK_NOTHROW(compile(declared(0, "first")));
    CHECK_THROWS_WITH(compile(declared(0, "first") + declared(1, "second")),
                      Contains("twice: error: ") &&
                          Contains("two variables of storage class " + std::string(row.storage)) &&
                          Contains("'first'") && Contains("'second'"));
  }
}

TEST_CASE("functions that would grow past all bounds when inlined are refused at once, by name and number") {
  // The functions have ten levels, and each calls the next one three times, which makes 3 to the 10th copies
  // of the last.
  std::string text =
      "#version 450\nlayout(binding = 0) buffer B { vec4 v[]; };\nvec4 last(vec4 x) { return sin(x) * v[3]; "
      "}\n";
  std::string callee = "last";
  for (int level = 0; level < 10; ++level) {
    const std::string name = "f" + std::to_string(level);
    text += "vec4 " + name + "(vec4 x) { return " + callee + "(x) + " + callee + "(x.yzwx) * " + callee +
            "(-x); }\n";
    callee = name;
  }
  const auto compile = [&] {
    Diagnostics notes;
    const std::vector<uint32_t> words = frontend::glsl_text_to_spirv(
        text + "void main() { v[0] = " + callee + "(v[1]); }\n", "deep.comp", isa::Stage::Compute, {});
    frontend::compile_module(words, "deep.comp", "main", {}, notes, nullptr);
  };
  CHECK_THROWS_WITH(compile(), Contains("'last' is inlined 59049 times") &&
                                   Contains("deep.comp: inlining all calls makes"));
  CHECK_THROWS_AS(compile(), UnsupportedError);
}

}  // namespace
}  // namespace glint::test
