// SPIR-V words as SPIRV-Tools sees them: validation and text.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// Empty when `words` are valid SPIR-V for Vulkan 1.3 with scalar block layout; else the validator's messages,
// one a line. Known false alarms are left out (see the .cpp).
std::string validate_spirv(const std::vector<uint32_t>& words);

// UnsupportedError with the numbers of the capabilities that the installed SPIRV-Tools do not know, and so
// cannot validate.
void refuse_unknown_capabilities(const std::vector<uint32_t>& words, const std::string& name);

// SPIR-V text to words. UserError with the text's line and column.
std::vector<uint32_t> assemble_spirv(const std::string& text, const std::string& name);

// "OpIAdd" for spv::Op::OpIAdd; "OpUnknown(n)" for opcodes that the installed SPIRV-Tools does not know.
std::string name_of_opcode(uint32_t opcode);

// SPIR-V's names of enumerants, as "RayQueryKHR"; the number where SPIRV-Tools does not know it.
std::string name_of_capability(uint32_t capability);
std::string name_of_storage_class(uint32_t storage);
std::string name_of_builtin(uint32_t builtin);
std::string name_of_execution_model(uint32_t model);
std::string name_of_glsl_function(uint32_t function);  // "GLSL.std.450 Ldexp"

}  // namespace glint::frontend
