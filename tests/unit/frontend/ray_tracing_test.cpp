// Tests ray tracing shaders against the shader ABI, and the list of what is not supported.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include "base/diagnostics.h"
#include "isa/verify.h"
#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"

namespace glint::frontend {
namespace {

using Catch::Contains;
using lab::count;
using lab::lowered;

// Returns the names of the instructions in layout order, with SaveLive and RestoreLive.
std::vector<std::string> names(const VirtualProgram& program) {
  std::vector<std::string> result;
  for (const VirtualBlock& block : program.blocks)
    for (const VirtualInst& inst : block.code)
      result.push_back(inst.kind == VirtualInst::Kind::SaveLive ? "SaveLive"
                       : inst.kind == VirtualInst::Kind::RestoreLive
                           ? "RestoreLive"
                           : std::string(isa::op_table()[inst.op].name));
  return result;
}

const VirtualInst& only(const VirtualProgram& program, std::string_view op) {
  const VirtualInst* found = nullptr;
  for (const VirtualBlock& block : program.blocks)
    for (const VirtualInst& inst : block.code)
      if (inst.kind == VirtualInst::Kind::Real && isa::op_table()[inst.op].name == op) {
        REQUIRE(found == nullptr);
        found = &inst;
      }
  REQUIRE(found != nullptr);
  return *found;
}

const std::string kTrace =
    "layout(binding = 0) uniform accelerationStructureEXT scene;\nlayout(binding = 1, rgba32f) uniform "
    "image2D picture;\n"
    "layout(location = 0) rayPayloadEXT vec4 p;\nvoid main() {\n  p = vec4(1);\n"
    "  traceRayEXT(scene, 5u, 0xff, 1, 2, 3, vec3(0, 1, 2), 0.25, vec3(3, 4, 5), 100.0, 0);\n"
    "  imageStore(picture, ivec2(gl_LaunchIDEXT.xy), p);\n}\n";

TEST_CASE("a trace becomes the sequence of the ABI, in its order") {
  const auto all = names(lowered(".rgen", kTrace));
  const auto first = std::find(all.begin(), all.end(), "SaveLive");
  const std::vector<std::string> expected{"SaveLive",           "rt.trace",  "ssy",        "bra",
                                          "call.sbt.candidate", "rt.resume", "bra",        "join",
                                          "call.sbt.hit",       "rt.end",    "RestoreLive"};
  REQUIRE(all.end() - first > long(expected.size()));
  CHECK(std::vector<std::string>(first, first + long(expected.size())) == expected);
}

TEST_CASE("rt.trace takes its operands in the ABI's order, and addresses from before the frame moves") {
  const VirtualProgram program = lowered(".rgen", kTrace);
  const VirtualInst& trace = only(program, "rt.trace");
  REQUIRE(trace.operands.size() == 17);
  const uint32_t expected[] = {5,          0xff,       1,          2,          3,
                               0,          0x3f800000, 0x40000000, 0x3e800000, 0x40400000,
                               0x40800000, 0x40a00000, 0x42c80000};
  for (size_t i = 0; i < std::size(expected); ++i) CHECK(is_constant(trace.operands[2 + i], expected[i]));
  for (size_t i : {15, 16})
    CHECK(trace.operands[i].kind == VirtualOperand::Kind::Register);  // %r0 moves at SaveLive
  CHECK(trace.line.line == lab::kFirstLine + 5);
  CHECK(program.local_bytes == 16 + 128);  // the payload and two buffers of attributes
  CHECK(program.payload_bytes == 16);
}

TEST_CASE("a payload that is stored is read again after the trace, not remembered") {
  const VirtualProgram program = lowered(".rgen", kTrace);
  CHECK(count(program, "st.local.v4.b32") == 1);
  CHECK(count(program, "ld.local.v4.b32") == 1);
}

TEST_CASE("a closest-hit shader may pass on its own payload") {
  const VirtualProgram program = lowered(
      ".rchit",
      "layout(binding = 0) uniform accelerationStructureEXT scene;\nlayout(location = 0) rayPayloadInEXT "
      "vec4 p;\n"
      "void main() { traceRayEXT(scene, 0u, 0xff, 0, 0, 0, vec3(0), 0.0, vec3(1), 1.0, 0); p.x += 1.0; }\n");
  CHECK(count(program, "rt.trace") == 1);
  CHECK(program.payload_bytes == 16);
  const VirtualInst& load = only(program, "ld.local.b32");
  CHECK(load.operands[1].kind == VirtualOperand::Kind::Special);
  CHECK(load.operands[1].special == isa::Special::Payload);
}

TEST_CASE("a report becomes the sequence of the ABI and yields rt.accepted") {
  const auto all = names(lowered(
      ".rint",
      "hitAttributeEXT vec4 a;\nvoid main() { a = vec4(1, 2, 3, 4); reportIntersectionEXT(0.5, 7u); }\n"));
  CHECK(all == std::vector<std::string>{"mov.b32", "mov.b32", "mov.b32", "mov.b32", "st.local.v4.b32",
                                        "rt.report", "ssy", "bra", "SaveLive", "call.sbt.anyhit",
                                        "RestoreLive", "join", "ret"});
  CHECK(count(lowered(".rint",
                      "hitAttributeEXT float a;\nvoid main() { if (reportIntersectionEXT(0.5, 7u)) { a = "
                      "1.0; reportIntersectionEXT(0.25, 0u); } }\n"),
              "rt.accepted") == 1);
}

TEST_CASE("triangle attributes are specials, other attributes lie in memory") {
  const std::string payload = "layout(location = 0) rayPayloadInEXT vec4 p;\n";
  const VirtualProgram pair =
      lowered(".rchit", payload + "hitAttributeEXT vec2 uv;\nvoid main() { p.xy = uv; }\n");
  CHECK(count(pair, "ld.local.b32") + count(pair, "ld.local.v2.b32") == 0);
  const VirtualProgram sphere =
      lowered(".rchit", payload + "hitAttributeEXT vec4 s;\nvoid main() { p = s; }\n");
  CHECK(count(sphere, "ld.local.v4.b32") == 1);
  CHECK(sphere.attribute_bytes == 16);
}

TEST_CASE("ignore and terminate end an any-hit shader, also inside of a loop") {
  const VirtualProgram program =
      lowered(".rahit",
              "hitAttributeEXT vec2 uv;\nlayout(location = 0) rayPayloadInEXT vec4 p;\n"
              "void main() { for (int i = 0; i < int(p.x); ++i) { if (uv.x > p.y) ignoreIntersectionEXT; if "
              "(uv.y > p.z) terminateRayEXT; p.z += 1.0; } }\n");
  CHECK(count(program, "rt.ignore") == 1);
  CHECK(count(program, "rt.terminate") == 1);
  CHECK(count(program, "ret") == 1);
}

TEST_CASE("everything unsupported is listed at once, with op, file and line") {
  const std::string body =
      "#extension GL_ARB_sparse_texture2 : require\nlayout(binding = 0) buffer B { uint n; float f; } b;\n"
      "layout(binding = 1) uniform sampler2D flat_image;\nlayout(local_size_x = 1) in;\nvoid main() {\n  "
      "vec4 t;\n"
      "  b.n = uint(sparseTextureLodARB(flat_image, vec2(b.f), 0.0, t));\n"
      "  b.n += uint(sparseTexelFetchARB(flat_image, ivec2(0), 0, t));\n  b.f = t.x;\n}\n";
  std::string message;
  try {
    lowered(".comp", body);
  } catch (const UnsupportedError& error) {
    message = error.what();
  }
  for (const char* expected :
       {":11: OpImageSparseSampleExplicitLod", ":12: OpImageSparseFetch", "SparseResidency"})
    CHECK_THAT(message, Contains(expected));
}

TEST_CASE("textures of an array have consecutive handles") {
  const VirtualProgram program = lowered(
      ".rmiss",
      "layout(set = 1, binding = 2) uniform sampler2D t[];\nlayout(location = 0) rayPayloadInEXT vec4 p;\n"
      "void main() { p = textureLod(t[nonuniformEXT(int(p.x))], p.yz, 0.0); }\n");
  const VirtualInst& handle = only(program, "ld.const.b32");
  CHECK(handle.imm == 1024 + 2 * 16);
  CHECK(count(program, "add.u32") == 1);
  CHECK(count(program, "tex.2d.v4.f32.f32") == 1);
}

TEST_CASE("every shader of the project compiles to a program that the verifier accepts") {
  const std::filesystem::path root = std::filesystem::path(GLINT_SOURCE_DIR) / "shaders";
  int compiled = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string path = entry.path().string();
    if (!entry.is_regular_file() || !stage_of_file(path)) continue;
    INFO(path);
    Diagnostics warnings;
    const isa::Program program = compile_file(path, {{(root / "include").string()}, {}}, {}, warnings);
    Diagnostics diagnostics;
    isa::verify(program, diagnostics);
    CHECK(diagnostics.messages() == std::vector<std::string>{});
    ++compiled;
  }
  CHECK(compiled >= 18);  // three workloads of six shaders
}

// Returns the instructions of the program where threads may be regrouped, as text.
std::vector<std::string> reorders(const isa::Program& program) {
  std::vector<std::string> out;
  for (const isa::Inst& inst : program.code) {
    const isa::OpRow& row = isa::op_table()[inst.op];
    if (row.effect == isa::Effect::Reorder) out.push_back(std::string(row.name));
  }
  return out;
}

TEST_CASE("reorderThread is an instruction only for a machine that regroups threads, and so are traces") {
  const std::string path = std::string(GLINT_SOURCE_DIR) + "/examples/reordering/reordering.rgen";
  Diagnostics warnings;
  const auto compiled = [&](const BackendOptions& options) {
    return compile_file(path, {}, options, warnings);
  };
  CHECK(reorders(compiled({})).empty());
  CHECK(reorders(compiled({.reorder_traces = true})) == std::vector<std::string>{"rt.reorder"});
  const isa::Program program = compiled({.reorder_calls = true});
  REQUIRE(reorders(program) == std::vector<std::string>{"ho.reorder"});
  const auto reorder = std::find_if(program.code.begin(), program.code.end(), [](const isa::Inst& inst) {
    return isa::op_table()[inst.op].name == "ho.reorder";
  });
  // Behind the call the shader needs its stack pointer, the bounce, and nothing that was only for the hint.
  const uint32_t words = program.constants.at(reorder->operand[3] & isa::kSlotIndexMask);
  CHECK(words >= 2);
  CHECK(words < program.num_registers);
}

}  // namespace
}  // namespace glint::frontend
