// Tests the compilation of GLSL: includes, defines, messages, debug lines, and what simplification leaves.
// SPDX-License-Identifier: Apache-2.0
#include "base/diagnostics.h"
#include "frontend/pass_times.h"
#include "frontend/spirv/module.h"
#include "frontend/spirv/reflection.h"
#include "frontend/spirv/spirv.h"
#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"

namespace glint::frontend {
namespace {

using Catch::Contains;
using Catch::EndsWith;

std::string message_of(const std::string& path, const GlslOptions& options = {}) {
  try {
    glsl_to_spirv(path, options);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

int count_ops(const std::vector<uint32_t>& words, spv::Op op) {
  int n = 0;
  for (size_t i = 5; i < words.size(); i += words[i] >> 16) n += spv::Op(words[i] & 0xffff) == op;
  return n;
}

TEST_CASE("a mistake in a shader is reported with its file and line") {
  const lab::Folder folder;
  const std::string path =
      folder.write("bad.comp", "#version 460\nvoid main() {\n  int a = 1;\n  b = a;\n}\n");
  CHECK_THAT(message_of(path), Contains(path + ":4: error: 'b' : undeclared identifier"));
}

TEST_CASE("a mistake in a define of the command line names the define") {
  const lab::Folder folder;
  const std::string path = folder.write("d.comp", "#version 460\nvoid main() { int a = N; }\n");
  GlslOptions options;
  options.defines = {{"M", "1"}, {"N", "5ul"}};
  CHECK_THAT(message_of(path, options), Contains(path + ": -D N=5ul: error: '64-bit literal'"));
}

TEST_CASE("a mistake that only linking finds names the file") {
  const lab::Folder folder;
  const std::string path = folder.write("none.comp", "#version 460\nvoid f() {}\n");
  CHECK_THAT(message_of(path), Contains(path + ": error: Missing entry point"));
}

TEST_CASE("a mistake in an included file is reported at the included file's line") {
  const lab::Folder folder;
  const std::string header = folder.write("sub/bad.glsl", "\n\nint broken() { return missing; }\n");
  const std::string path =
      folder.write("main.comp", "#version 460\n#include \"sub/bad.glsl\"\nvoid main() {}\n");
  CHECK_THAT(message_of(path), Contains(header + ":3: error: 'missing'"));
}

TEST_CASE("an include is looked for next to the including file before the include directories") {
  const lab::Folder folder, other;
  folder.write("a/one.glsl", "#include \"two.glsl\"\n");
  folder.write("a/two.glsl", "int number() { return 1; }\n");
  const std::string wrong = other.write("two.glsl", "#error wrong file\n");
  const std::string found = other.write("three.glsl", "int three() { return 3; }\n");
  const std::string directory = found.substr(0, found.rfind('/'));
  const std::string path = folder.write("m.comp",
                                        "#version 460\n#include \"a/one.glsl\"\n#include "
                                        "\"three.glsl\"\nvoid main() { int x = number() + three(); }\n");
  CHECK_NOTHROW(glsl_to_spirv(path, {{directory}, {}}));
  CHECK_THAT(message_of(path), Contains("three.glsl"));
}

TEST_CASE("an include is looked for in the folders of all files that lead to it, the nearest first") {
  const lab::Folder folder;
  folder.write("a/one.glsl", "#include \"b/two.glsl\"\n");
  folder.write("a/b/two.glsl", "#include \"near.glsl\"\n#include \"far.glsl\"\n");
  folder.write("a/near.glsl", "int near() { return 1; }\n");
  folder.write("near.glsl", "#error wrong file\n");
  folder.write("far.glsl", "int far() { return 2; }\n");
  const std::string path = folder.write(
      "m.comp", "#version 460\n#include \"a/one.glsl\"\nvoid main() { int x = near() + far(); }\n");
  CHECK(message_of(path) == "no error");
}

TEST_CASE("an include in angle brackets is looked for only in the include directories") {
  const lab::Folder folder, other;
  folder.write("one.glsl", "#error wrong file\n");
  const std::string found = other.write("one.glsl", "int one() { return 1; }\n");
  const std::string path =
      folder.write("m.comp", "#version 460\n#include <one.glsl>\nvoid main() { int x = one(); }\n");
  CHECK(message_of(path, {{found.substr(0, found.rfind('/'))}, {}}) == "no error");
  CHECK_THAT(message_of(path), Contains(path + ":2: error: '#include' : cannot find one.glsl; there are no "
                                               "include folders (-I)"));
}

TEST_CASE("an include that is not found names the folders searched, each once, and nothing else") {
  const lab::Folder folder;
  const std::string header = folder.write("sub/one.glsl", "\n#include \"missing.glsl\"\nint a = b;\n");
  const std::string path =
      folder.write("m.comp", "#version 460\n#include \"sub/one.glsl\"\nvoid main() { missing(); }\n");
  const std::string place = path.substr(0, path.rfind('/'));
  CHECK(message_of(path, {{"/nowhere", place}, {}}) ==
        header + ":2: error: '#include' : cannot find missing.glsl; searched in " + place + "/sub, " + place +
            ", /nowhere");
}

TEST_CASE("a shader that includes itself is refused with the chain of files") {
  const lab::Folder folder;
  const std::string path =
      folder.write("m.comp", "#version 460\n#include \"m.comp\"\n#include \"m.comp\"\nvoid main() {}\n");
  CHECK(message_of(path) == path + ":2: error: '#include' : files include each other more than 100 deep: " +
                                path + " includes " + path);
}

TEST_CASE("two files that include each other are refused with the chain of files") {
  const lab::Folder folder;
  const std::string a = folder.write("a.glsl", "#include \"b.glsl\"\n");
  const std::string b = folder.write("b.glsl", "\n\n#include \"a.glsl\"\n#include \"a.glsl\"\n");
  const std::string path =
      folder.write("m.comp", "#version 460\n#include \"a.glsl\"\nvoid main() { f(); }\n");
  CHECK(message_of(path) == b + ":3: error: '#include' : files include each other more than 100 deep: " +
                                path + " includes " + a + ", which includes " + b + ", which includes " + a);
}

TEST_CASE("a mistake that comes from files that include each other is reported with the chain of files") {
  const lab::Folder folder;
  const std::string a = folder.write("a.glsl", "int f() { return 1; }\n#include \"b.glsl\"\n");
  const std::string b = folder.write("b.glsl", "#include \"a.glsl\"\n#include \"a.glsl\"\n");
  const std::string path = folder.write("m.comp", "#version 460\n#include \"a.glsl\"\nvoid main() {}\n");
  const std::string said = message_of(path);
  CHECK_THAT(said, Contains(a + ":1: error: 'f' : function already has a body"));
  CHECK_THAT(said, EndsWith("\nnote: " + path + " includes " + a + ", which includes " + b +
                            ", which includes " + a));
}

TEST_CASE("files that double what they include are refused before they fill the memory") {
  const lab::Folder folder;
  for (int i = 0; i < 40; ++i) {
    const std::string next = "#include \"f" + std::to_string(i + 1) + ".glsl\"\n";
    folder.write("f" + std::to_string(i) + ".glsl", next + next);
  }
  folder.write("f40.glsl", "\n");
  const std::string path = folder.write("m.comp", "#version 460\n#include \"f0.glsl\"\nvoid main() {}\n");
  CHECK_THAT(message_of(path), Contains("files include each other again and again, 10001 times by now: ") &&
                                   Contains("f9.glsl, which includes") && Contains(", and so on"));
}

TEST_CASE("a file may include itself until a macro ends it") {
  const lab::Folder folder;
  folder.write("count.glsl",
               "#ifndef A\n#define A\n#include \"count.glsl\"\n#elif !defined(B)\n#define B\n"
               "#include \"count.glsl\"\n#else\nint last() { return 3; }\n#endif\n");
  const std::string path =
      folder.write("m.comp", "#version 460\n#include \"count.glsl\"\nvoid main() { int x = last(); }\n");
  CHECK(message_of(path) == "no error");
}

TEST_CASE("a define reaches the shader with its value") {
  const lab::Folder folder;
  const std::string path =
      folder.write("d.comp", "#version 460\n#if VALUE != 42\n#error wrong value\n#endif\nvoid main() {}\n");
  CHECK_NOTHROW(glsl_to_spirv(path, {{}, {{"VALUE", "42"}}}));
  CHECK_THAT(message_of(path, {{}, {{"VALUE", "41"}}}), Contains(":3: error:"));
}

TEST_CASE("an unknown ending and a missing file are user errors that name the file") {
  CHECK_THAT(message_of("/nowhere/x.frag"), Contains("/nowhere/x.frag") && Contains("shader stage"));
  CHECK_THAT(message_of("/nowhere/x.rgen"), Contains("/nowhere/x.rgen") && Contains("cannot read"));
  CHECK(stage_of_file("a/b.rahit") == isa::Stage::AnyHit);
  CHECK_FALSE(stage_of_file("a/b.vert").has_value());
}

TEST_CASE("glslang's SPIR-V is version 1.6 and valid, and so is the simplified module") {
  const lab::Folder folder;
  const std::string path =
      folder.write("s.comp",
                   "#version 460\nlayout(binding = 0) buffer B { float a[]; } b;\n"
                   "float twice(float x) { if (x > 1.0) return 2.0 * x; return x; }\nvoid main() { for (int "
                   "i = 0; i < 4; ++i) b.a[i] = twice(b.a[i]); }\n");
  const auto words = glsl_to_spirv(path, {});
  CHECK(words[1] == 0x00010600);
  CHECK(validate_spirv(words).empty());
  CHECK(count_ops(words, spv::Op::OpFunctionCall) == 1);
  Diagnostics warnings;
  const auto simple = simplify(words, path, warnings);
  CHECK(warnings.messages().empty());
  CHECK(validate_spirv(simple).empty());
  CHECK(count_ops(simple, spv::Op::OpFunctionCall) == 0);
  CHECK_THAT(disassemble_spirv(simple), Contains("OpEntryPoint GLCompute"));
}

TEST_CASE("SPIR-V text becomes the newest version under which it is valid") {
  const std::string start =
      "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint GLCompute %main \"main\"\n"
      "OpExecutionMode %main LocalSize 1 1 1\n";
  const std::string types =
      "%void = OpTypeVoid\n%f = OpTypeFunction %void\n%uint = OpTypeInt 32 0\n%block = OpTypeStruct %uint\n"
      "%pointer = OpTypePointer Uniform %block\n%b = OpVariable %pointer Uniform\n";
  const std::string body = "%main = OpFunction %void None %f\n%entry = OpLabel\nOpReturn\nOpFunctionEnd\n";
  const std::string place =
      "OpMemberDecorate %block 0 Offset 0\nOpDecorate %b DescriptorSet 0\nOpDecorate %b Binding 0\n";
  CHECK(assemble_spirv(start + "OpDecorate %block Block\n" + place + types + body, "x")[1] == 0x00010600);
  // SPIR-V 1.4 removed BufferBlock.
  const auto old = assemble_spirv(start + "OpDecorate %block BufferBlock\n" + place + types + body, "x");
  CHECK(old[1] == 0x00010300);
  CHECK(validate_spirv(old).empty());
  CHECK_THROWS_AS(assemble_spirv("OpNonsense\n", "x"), UserError);
  const std::string beyond =
      "%one = OpConstant %uint 1\n%pair = OpTypeVector %uint 2\n%both = OpSpecConstantComposite %pair %one "
      "%one\n"
      "%third = OpSpecConstantOp %uint CompositeExtract %both 2\n";
  CHECK_THAT(validate_spirv(
                 assemble_spirv(start + "OpDecorate %block Block\n" + place + types + beyond + body, "x")),
             Contains("component 2 of a vector of 2"));
}

TEST_CASE("a module is validated once before it is simplified, and again when its constants are set") {
  const lab::Folder folder;
  const std::string path = folder.write("s.comp",
                                        "#version 460\nlayout(constant_id = 3) const int n = 2;\n"
                                        "layout(binding = 0) buffer B { int a[]; };\n"
                                        "void main() { a[0] = n; }\n");
  const auto validations = [&](const GlslOptions& glsl) {
    Diagnostics warnings;
    std::vector<std::string> when;
    for (const PassTime& row : time_compilation(path, glsl, {}, warnings))
      if (row.stage == "validation") when.push_back(row.pass);
    return when;
  };
  GlslOptions glsl;
  CHECK(validations(glsl) == std::vector<std::string>{"after"});
  glsl.specialization = {{3, 5}};
  CHECK(validations(glsl) == std::vector<std::string>{"before", "after"});
}

TEST_CASE("a message of the validator calls values by their names") {
  const std::string text =
      "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint GLCompute %main \"main\"\n"
      "OpExecutionMode %main LocalSize 1 1 1\nOpName %sum \"sum\"\n%void = OpTypeVoid\n"
      "%type = OpTypeFunction %void\n%uint = OpTypeInt 32 0\n%float = OpTypeFloat 32\n%one = OpConstant "
      "%uint 1\n"
      "%main = OpFunction %void None %type\n%label = OpLabel\n%sum = OpFAdd %float %one %one\nOpReturn\n"
      "OpFunctionEnd\n";
  CHECK_THAT(validate_spirv(assemble_spirv(text, "t.spvasm")), Contains("%sum = OpFAdd %float %uint_1"));
}

TEST_CASE("members of a block may overlap, as vkd3d writes them") {
  const std::string text =
      "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint GLCompute %main \"main\"\n"
      "OpExecutionMode %main LocalSize 1 1 1\nOpDecorate %block Block\nOpMemberDecorate %block 0 Offset 0\n"
      "OpMemberDecorate %block 1 Offset 4\n%void = OpTypeVoid\n%type = OpTypeFunction %void\n"
      "%float = OpTypeFloat 32\n%v4float = OpTypeVector %float 4\n%block = OpTypeStruct %v4float %v4float\n"
      "%pointer = OpTypePointer PushConstant %block\n%p = OpVariable %pointer PushConstant\n"
      "%main = OpFunction %void None %type\n%label = OpLabel\n%all = OpLoad %block "
      "%p\nOpReturn\nOpFunctionEnd\n";
  Diagnostics warnings;
  CHECK_NOTHROW(simplify(assemble_spirv(text, "t.spvasm"), "t.spvasm", warnings));
}

TEST_CASE("a size of blocks that is no constant is refused") {
  const std::string text =
      "OpCapability Shader\nOpMemoryModel Logical GLSL450\nOpEntryPoint GLCompute %main \"main\"\n"
      "OpExecutionModeId %main LocalSizeId %one SIZE %one\n%void = OpTypeVoid\n%type = OpTypeFunction %void\n"
      "%uint = OpTypeInt 32 0\n%one = OpConstant %uint 1\n"
      "%main = OpFunction %void None %type\n%label = OpLabel\nOpReturn\nOpFunctionEnd\n";
  const auto verdict_on = [&](const std::string& size) {
    std::string module = text;
    return validate_spirv(assemble_spirv(module.replace(module.find("SIZE"), 4, size), "t.spvasm"));
  };
  CHECK(verdict_on("%one").empty());
  CHECK_THAT(verdict_on("%uint"), Contains("of an execution mode is no constant"));
}

TEST_CASE("words that are not a valid module are refused") {
  Diagnostics warnings;
  CHECK_THROWS_AS(simplify({1, 2, 3}, "x", warnings), UserError);
  CHECK_THROWS_AS(Module::parse({1, 2, 3, 4, 5, 6}, "x"), UserError);
}

TEST_CASE("a module whose source is in a language younger than SPIRV-Tools is read") {
  const lab::Folder folder;
  std::vector<uint32_t> words = glsl_to_spirv(folder.write("s.comp", "#version 460\nvoid main() {}\n"), {});
  for (const uint32_t language : {5, 11, 13}) {
    for (size_t i = 5; i < words.size(); i += words[i] >> 16)
      if (spv::Op(words[i] & 0xffff) == spv::Op::OpSource) words[i + 1] = language;
    const std::string bytes(reinterpret_cast<const char*>(words.data()), words.size() * 4);
    const auto known = read_spirv(folder.write("s.spv", bytes));
    CHECK(count_ops(known, spv::Op::OpSource) == 1);
    CHECK((known == words) == (language == 5));
  }
}

TEST_CASE("an extension that the optimiser does not know does not stop it") {
  // Without help, SPV_KHR_ray_cull_mask makes most passes skip the module silently.
  const std::string body =
      "#extension GL_EXT_ray_cull_mask : require\nlayout(location = 0) rayPayloadInEXT vec4 p;\n"
      "struct S { float a; vec2 b; };\nS make(uint m) { S s; s.a = float(m); s.b = vec2(s.a); return s; }\n"
      "void main() { S s = make(gl_CullMaskEXT); p = vec4(s.a, s.b, 0); }\n";
  const auto words = lab::simplified(".rmiss", body);
  CHECK(count_ops(words, spv::Op::OpFunctionCall) == 0);
  const Module module = Module::parse(words, "x");
  for (const Block& block : module.functions.at(0).blocks)
    for (const Instruction& inst : block.code) CHECK(inst.op != spv::Op::OpVariable);
  CHECK(count_ops(words, spv::Op::OpExtension) >= 1);  // still declared
}

TEST_CASE("both reads of the ray's end around a report survive") {
  const auto words = lab::simplified(
      ".rint",
      "hitAttributeEXT vec4 a;\nvoid main() { float t = gl_RayTmaxEXT; reportIntersectionEXT(t * 0.5, 0u);\n"
      "a = vec4(t, gl_RayTmaxEXT, 0, 0); reportIntersectionEXT(t * 0.25, 1u); }\n");
  const Module module = Module::parse(words, "x");
  int loads = 0;
  for (const Block& block : module.functions.at(0).blocks)
    for (const Instruction& inst : block.code)
      if (inst.op == spv::Op::OpLoad) {
        const auto d = module.decorations.find(inst.operands[0]);
        loads += d != module.decorations.end() && d->second.builtin == spv::BuiltIn::RayTmaxKHR;
      }
  CHECK(loads == 2);
}

TEST_CASE("instructions know the file and line of an included function") {
  const lab::Folder folder;
  const std::string header = folder.write("f.glsl", "\n\nfloat work(float x) {\n  return sin(x);\n}\n");
  const std::string path = folder.write("m.comp",
                                        "#version 460\n#include \"f.glsl\"\nlayout(binding = 0) buffer B { "
                                        "float a; } b;\nvoid main() {\n  b.a = work(b.a);\n}\n");
  Diagnostics warnings;
  const VirtualProgram program = lower_to_virtual(simplify(glsl_to_spirv(path, {}), path, warnings), path);
  int found = 0;
  for (const VirtualBlock& block : program.blocks)
    for (const VirtualInst& inst : block.code) {
      const std::string_view op = isa::op_table()[inst.op].name;
      if (op != "sin.f32" && op != "st.global.b32") continue;
      CHECK(program.files.at(inst.line.file) == (op == "sin.f32" ? header : path));
      CHECK(inst.line.line == (op == "sin.f32" ? 4u : 5u));
      ++found;
    }
  CHECK(found == 2);
}

TEST_CASE("reflection lists bindings with kinds, names and array lengths, and payload sizes") {
  const lab::Folder folder;
  const std::string path = folder.write(
      "r.rchit", lab::source("layout(set = 1, binding = 3) uniform sampler2D textures[5];\nlayout(binding = "
                             "2) uniform U { mat4 m; } u;\n"
                             "layout(binding = 7) buffer B { float a[]; } b;\nlayout(binding = 0) uniform "
                             "accelerationStructureEXT scene;\n"
                             "layout(binding = 1, rgba32f) uniform image2D picture;\nlayout(binding = 9) "
                             "uniform sampler2D more[];\n"
                             "layout(location = 0) rayPayloadInEXT struct P { vec3 c; bool hit; } "
                             "p;\nlayout(location = 1) rayPayloadEXT vec4 q[5];\n"
                             "hitAttributeEXT vec2 uv;\nlayout(push_constant) uniform C { vec4 c; float d; } "
                             "pc;\nvoid main() { p.c = textureLod(more[gl_PrimitiveID], uv, 0.0).xyz; }\n"));
  const Reflection r = reflect(glsl_to_spirv(path, {}), path);
  CHECK(r.stage == isa::Stage::ClosestHit);
  CHECK(r.bindings == std::vector<Binding>{{0, 0, BindingKind::AccelerationStructure, "scene", 1},
                                           {0, 1, BindingKind::StorageImage, "picture", 1},
                                           {0, 2, BindingKind::UniformBuffer, "u", 1},
                                           {0, 7, BindingKind::StorageBuffer, "b", 1},
                                           {0, 9, BindingKind::SampledImage, "more", 0},
                                           {1, 3, BindingKind::SampledImage, "textures", 5}});
  CHECK(r.incoming_payload_bytes == 16);
  CHECK(r.largest_payload_bytes == 80);
  CHECK(r.attribute_bytes == 8);
  CHECK(r.push_constant_bytes == 20);
}

}  // namespace
}  // namespace glint::frontend
