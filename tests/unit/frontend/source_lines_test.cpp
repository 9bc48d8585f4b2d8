// Tests where ISA instructions say they come from: SPIR-V instruction, line, and the calls after inlining.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/source_lines.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>

#include "frontend/compile.h"
#include "frontend/spirv/inline_scopes.h"
#include "frontend/spirv/module.h"
#include "frontend/spirv/spirv.h"
#include "isa/text.h"
#include "tests/support/catch.h"

namespace glint::frontend::source_lines_test {
namespace {

// In this text, square() is at line 5, twice() at 8, and main() at 11 to 13.
const std::string kNested = R"(#version 460
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer B { float v[]; };
float square(float x) {
  return sin(x) * x;
}
float twice(float x) {
  return square(x) + square(x + 1.0);
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  float a = twice(v[i]);
  v[i] = a + square(v[i + 32]);
}
)";

std::vector<uint32_t> words_of(const std::string& glsl) {
  return glsl_text_to_spirv(glsl, "nested.comp", isa::Stage::Compute, {});
}

isa::Program compiled(const std::vector<uint32_t>& words) {
  Diagnostics warnings;
  isa::Program out = compile_module(words, "nested.comp", {}, {}, warnings, nullptr).program;
  CHECK(warnings.messages().empty());
  return out;
}

// Returns a stack of calls such as "main:12 twice:8 square:5".
std::string stack_of(const isa::Program& program, const isa::Line& line) {
  std::string out =
      fmt::format("{}:{}", line.scope ? program.scopes[line.scope - 1].function : "?", line.line);
  for (uint32_t scope = line.scope; scope && program.scopes[scope - 1].caller;
       scope = program.scopes[scope - 1].caller) {
    const isa::Scope& row = program.scopes[scope - 1];
    out = fmt::format("{}:{} ", program.scopes[row.caller - 1].function, row.call.line) + out;
  }
  return out;
}

// Returns the module with an unknown set of extended instructions, because of which nothing is marked.
std::vector<uint32_t> with_foreign_set(std::vector<uint32_t> words) {
  const std::string name = "NonSemantic.Other";
  std::vector<uint32_t> import{0, words[3]++};
  for (size_t i = 0; i <= name.size() / 4; ++i) {
    uint32_t word = 0;
    for (size_t k = 0; k < 4 && 4 * i + k < name.size(); ++k)
      word |= uint32_t(uint8_t(name[4 * i + k])) << 8 * k;
    import.push_back(word);
  }
  import[0] = uint32_t(import.size()) << 16 | uint32_t(spv::Op::OpExtInstImport);
  size_t at = 5;
  while (spv::Op(words[at] & 0xffff) != spv::Op::OpMemoryModel) at += words[at] >> 16;
  words.insert(words.begin() + long(at), import.begin(), import.end());
  return words;
}

// Counts the rows of the listing that belong to functions, without constants that only marks need.
size_t rows_of_functions(const isa::Program& program) {
  const auto is_head = [](const isa::SpirvLine& line) {
    return line.text.find("= OpFunction ") != std::string::npos;
  };
  return size_t(program.spirv.end() - std::find_if(program.spirv.begin(), program.spirv.end(), is_head));
}

}  // namespace

TEST_CASE("after inlining every instruction says under which calls it stands, a chain of calls by itself") {
  const isa::Program program = compiled(words_of(kNested));
  std::multiset<std::string> sines;
  for (size_t i = 0; i < program.code.size(); ++i)
    if (isa::to_text(program, program.code[i]).find("cos") == std::string::npos && program.lines[i].line == 5)
      sines.insert(stack_of(program, program.lines[i]));
  const std::set<std::string> stacks(sines.begin(), sines.end());
  CHECK(stacks == std::set<std::string>{"main:12 twice:8 square:5", "main:13 square:5"});
  // twice() calls square() two times, so its chain of calls has twice as many instructions.
  CHECK(sines.count("main:12 twice:8 square:5") == 2 * sines.count("main:13 square:5"));
  for (const isa::Line& line : program.lines)
    if (line.line >= 11) CHECK(stack_of(program, line) == fmt::format("main:{}", line.line));
}

TEST_CASE("functions with local arrays keep their marks when they are inlined") {
  const std::string text = R"(#version 460
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer B { float v[]; };
float pick(vec2 r, int k) {
  float parts[2] = float[](r.x, r.y);
  return parts[k];
}
float twice(vec2 r, int k) {
  float both[3] = float[](r.x, pick(r, k), 1.0);
  return both[k + 1];
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  v[i] = twice(vec2(v[i], v[i + 32]), int(i) & 1);
}
)";
  const isa::Program program = compiled(words_of(text));
  std::set<std::string> stacks;
  for (size_t i = 0; i < program.code.size(); ++i)
    if (isa::to_text(program, program.code[i]).find(".local.") != std::string::npos)
      stacks.insert(stack_of(program, program.lines[i]));
  CHECK(stacks == std::set<std::string>{"main:14 twice:9 pick:5", "main:14 twice:9 pick:6", "main:14 twice:9",
                                        "main:14 twice:10"});
}

TEST_CASE("marks of functions change no instruction, no constant and no line") {
  std::vector<std::string> sources{"path_tracing/raygen.rgen", "path_tracing/triangle.rchit",
                                   "ambient_occlusion/raygen.rgen"};
  for (const std::string& name : sources) {
    GlslOptions options;
    options.include_dirs = {GLINT_SOURCE_DIR "/shaders/include"};
    const std::vector<uint32_t> words = glsl_to_spirv(GLINT_SOURCE_DIR "/shaders/" + name, options);
    const isa::Program marked = compiled(words), plain = compiled(with_foreign_set(words));
    CHECK(marked == plain);
    CHECK(!marked.scopes.empty());
    CHECK(plain.scopes.empty());
    CHECK(rows_of_functions(marked) == rows_of_functions(plain));
  }
}

TEST_CASE(
    "every instruction names a SPIR-V instruction of its own line, and the listing numbers them in order") {
  const isa::Program program = compiled(words_of(kNested));
  size_t known = 0;
  for (const isa::Line& line : program.lines) {
    if (line.spirv == 0) continue;
    ++known;
    REQUIRE(line.spirv <= program.spirv.size());
    CHECK(program.spirv[line.spirv - 1].line.line == line.line);
  }
  CHECK(known + 2 >= program.code.size());
  size_t sines = 0;
  for (const isa::SpirvLine& line : program.spirv) {
    CHECK(line.text.find("OpLine") == std::string::npos);
    CHECK(line.text.find("NonSemantic") == std::string::npos);
    if (line.text.find(" Sin ") == std::string::npos) continue;
    ++sines;
    CHECK(line.line.line == 5);
    const auto number = uint32_t(&line - program.spirv.data()) + 1;
    CHECK(std::any_of(program.lines.begin(), program.lines.end(),
                      [&](const isa::Line& each) { return each.spirv == number; }));
  }
  CHECK(sines == 3);
  CHECK(program.spirv.front().text.find("OpCapability") == 0);
  CHECK(program.spirv.back().text == "OpFunctionEnd");
}

TEST_CASE("texts with line ends in a module do not shift its listing") {
  const std::vector<uint32_t> words = words_of(
      "#version 460\n#extension GL_EXT_debug_printf : require\nvoid main() {\n  "
      "debugPrintfEXT(\"a\\nb\\n%u\", gl_GlobalInvocationID.x);\n}\n");
  const Module module = Module::parse(words, "print.comp");
  const std::vector<std::string> listing = listing_of(words);
  REQUIRE(listing.size() == module.lines.size());
  const auto print = std::find_if(listing.begin(), listing.end(), [](const std::string& line) {
    return line.find("OpExtInst ") != std::string::npos;
  });
  REQUIRE(print != listing.end());
  CHECK(module.lines[size_t(print - listing.begin())].line == 4);
}

TEST_CASE("modules with debug information of their own keep their lines and get calls, too") {
  // The module has the form that glslang -gVS writes: lines are DebugLine and numbers are constants.
  const std::string text = R"(
    OpCapability Shader
    OpExtension "SPV_KHR_non_semantic_info"
    %set = OpExtInstImport "NonSemantic.Shader.DebugInfo.100"
    OpMemoryModel Logical GLSL450
    OpEntryPoint GLCompute %main "main" %out
    OpExecutionMode %main LocalSize 32 1 1
    %file = OpString "own.comp"
    OpName %main "main"
    OpName %add "add(u1;"
    OpDecorate %block Block
    OpMemberDecorate %block 0 Offset 0
    OpDecorate %out DescriptorSet 0
    OpDecorate %out Binding 0
    %void = OpTypeVoid
    %uint = OpTypeInt 32 0
    %block = OpTypeStruct %uint
    %pointer = OpTypePointer StorageBuffer %block
    %element = OpTypePointer StorageBuffer %uint
    %out = OpVariable %pointer StorageBuffer
    %zero = OpConstant %uint 0
    %seven = OpConstant %uint 7
    %nine = OpConstant %uint 9
    %source = OpExtInst %void %set DebugSource %file
    %of_main = OpTypeFunction %void
    %of_add = OpTypeFunction %uint %uint
    %add = OpFunction %uint None %of_add
    %x = OpFunctionParameter %uint
    %add_body = OpLabel
    %line7 = OpExtInst %void %set DebugLine %source %seven %seven %zero %zero
    %sum = OpIMul %uint %x %x
    OpReturnValue %sum
    OpFunctionEnd
    %main = OpFunction %void None %of_main
    %main_body = OpLabel
    %line9 = OpExtInst %void %set DebugLine %source %nine %nine %zero %zero
    %at = OpAccessChain %element %out %zero
    %was = OpLoad %uint %at
    %is = OpFunctionCall %uint %add %was
    OpStore %at %is
    OpReturn
    OpFunctionEnd)";
  const isa::Program program = compiled(assemble_spirv(text, "own.spvasm"));
  std::set<std::string> stacks;
  for (const isa::Line& line : program.lines)
    if (line.line) stacks.insert(stack_of(program, line));
  CHECK(stacks == std::set<std::string>{"main:9", "main:9 add:7"});
  CHECK(program.files == std::vector<std::string>{"own.comp"});
}

TEST_CASE("modules without lines, of older versions or with unknown sets are left as they are") {
  std::vector<uint32_t> words = words_of(kNested);
  CHECK(with_inline_scopes(words).has_value());
  CHECK(!with_inline_scopes(with_foreign_set(words)).has_value());
  std::vector<uint32_t> bare(words.begin(), words.begin() + 5);
  for (size_t i = 5; i < words.size(); i += words[i] >> 16)
    if (spv::Op(words[i] & 0xffff) != spv::Op::OpLine)
      bare.insert(bare.end(), words.begin() + long(i), words.begin() + long(i + (words[i] >> 16)));
  CHECK(!with_inline_scopes(bare).has_value());
  words[1] = 0x10500;
  CHECK(!with_inline_scopes(words).has_value());
}

}  // namespace glint::frontend::source_lines_test
