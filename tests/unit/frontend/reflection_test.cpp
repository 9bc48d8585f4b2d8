// Tests the reflection of modules with several entry points: each has its own bindings and its own size.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/reflection.h"

#include <array>
#include <cstdint>
#include <ios>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/spirv/spirv.h"
#include "tests/support/catch.h"

namespace glint::frontend {
namespace {

// Two compute shaders: `fill` writes %a through a function, and `copy` reads %b and push constants.
const char* const kTwo = R"(
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %fill "fill" %a
OpEntryPoint GLCompute %copy "copy" %b %p
OpExecutionMode %fill LocalSize 64 1 1
OpExecutionMode %copy LocalSize 8 4 1
OpName %a "a"
OpName %b "b"
OpMemberDecorate %block 0 Offset 0
OpDecorate %block Block
OpDecorate %a DescriptorSet 0
OpDecorate %a Binding 0
OpDecorate %b DescriptorSet 1
OpDecorate %b Binding 3
%void = OpTypeVoid
%type = OpTypeFunction %void
%uint = OpTypeInt 32 0
%zero = OpConstant %uint 0
%block = OpTypeStruct %uint
%buffer = OpTypePointer StorageBuffer %block
%word = OpTypePointer StorageBuffer %uint
%pushed = OpTypePointer PushConstant %block
%push_word = OpTypePointer PushConstant %uint
%a = OpVariable %buffer StorageBuffer
%b = OpVariable %buffer StorageBuffer
%p = OpVariable %pushed PushConstant
%fill = OpFunction %void None %type
%l1 = OpLabel
%r = OpFunctionCall %void %store
OpReturn
OpFunctionEnd
%store = OpFunction %void None %type
%l2 = OpLabel
%at = OpAccessChain %word %a %zero
OpStore %at %zero
OpReturn
OpFunctionEnd
%copy = OpFunction %void None %type
%l3 = OpLabel
%from = OpAccessChain %push_word %p %zero
%value = OpLoad %uint %from
%to = OpAccessChain %word %b %zero
OpStore %to %value
OpReturn
OpFunctionEnd
)";

}  // namespace

TEST_CASE("each entry point of a module has its own bindings, push constants and size") {
  std::vector<uint32_t> words = assemble_spirv(kTwo, "two.spvasm");
  for (const uint32_t version : {0x10600u, 0x10300u}) {
    INFO("SPIR-V " << std::hex << version);
    words[1] = version;
    const Reflection fill = reflect(words, "two", "fill"), copy = reflect(words, "two", "copy");
    CHECK(fill.bindings == std::vector<Binding>{{0, 0, BindingKind::StorageBuffer, "a", 1}});
    CHECK(copy.bindings == std::vector<Binding>{{1, 3, BindingKind::StorageBuffer, "b", 1}});
    CHECK(fill.push_constant_bytes == 0);
    CHECK(copy.push_constant_bytes == 4);
    CHECK(fill.local_size == std::array<uint32_t, 3>{64, 1, 1});
    CHECK(copy.local_size == std::array<uint32_t, 3>{8, 4, 1});
    CHECK(copy.entry_point == "copy");
  }
}

TEST_CASE("an entry point that is not there is refused with the names of those that are") {
  const std::vector<uint32_t> words = assemble_spirv(kTwo, "two.spvasm");
  CHECK_THROWS_WITH(reflect(words, "two", "main"),
                    Catch::Contains("the module has no entry point 'main': it has fill, copy"));
  CHECK_THROWS_WITH(reflect(words, "two"),
                    Catch::Contains("the module has several entry points: fill, copy"));
}

}  // namespace glint::frontend
