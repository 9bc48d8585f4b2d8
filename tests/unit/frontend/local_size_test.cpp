// Tests where the size of a compute shader's block comes from.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "frontend/compile.h"
#include "frontend/spirv/specialize.h"
#include "frontend/spirv/spirv.h"
#include "tests/support/catch.h"

namespace glint::frontend {
namespace {

// glslang writes so what GLSL calls local_size_x_id, for versions of SPIR-V before 1.6.
const char* const kSizedByConstant = R"(
OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main"
OpExecutionMode %main LocalSize 1 1 1
OpDecorate %x SpecId 7
OpDecorate %size BuiltIn WorkgroupSize
%void = OpTypeVoid
%function = OpTypeFunction %void
%uint = OpTypeInt 32 0
%uint3 = OpTypeVector %uint 3
%x = OpSpecConstant %uint 32
%two = OpConstant %uint 2
%one = OpConstant %uint 1
%size = OpSpecConstantComposite %uint3 %x %two %one
%main = OpFunction %void None %function
%begin = OpLabel
OpReturn
OpFunctionEnd
)";

std::array<uint32_t, 3> local_size(const std::map<uint32_t, uint64_t>& constants) {
  Diagnostics notes;
  const auto words = specialize(assemble_spirv(kSizedByConstant, "sized.spvasm"), constants);
  return compile_module(words, "sized", "main", {}, notes, nullptr).program.local_size;
}

TEST_CASE("a block has the size of a specialisation constant that no code reads") {
  CHECK(local_size({}) == std::array<uint32_t, 3>{32, 2, 1});
  CHECK(local_size({{7, 64}}) == std::array<uint32_t, 3>{64, 2, 1});
}

}  // namespace
}  // namespace glint::frontend
