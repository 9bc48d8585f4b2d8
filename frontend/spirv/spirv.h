// Validates SPIR-V words and turns them into text and back through SPIRV-Tools.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::frontend {

// Returns an empty text when `words` are valid SPIR-V for Vulkan 1.3 with scalar block layout, and otherwise
// the validator's messages, one per line. Known false alarms are left out (is_false_alarm() in the .cpp
// file), and modules deeper than kDeepestValidated (limits.h) are hardly looked at.
std::string validate_spirv(const std::vector<uint32_t>& words);

// Does the same for a module that glslang or the optimiser made. Only builds with GLINT_DCHECKS look at one
// with more than kMostValidated selections and loops (limits.h).
std::string validate_made_spirv(const std::vector<uint32_t>& words);

// Throws UnsupportedError with the numbers of the capabilities that the installed SPIRV-Tools do not know and
// so cannot validate.
void refuse_unknown_capabilities(const std::vector<uint32_t>& words, const std::string& name);

// Turns SPIR-V text into words. Throws UserError with the text's line and column.
std::vector<uint32_t> assemble_spirv(const std::string& text, const std::string& name);

// Returns "OpIAdd" for spv::Op::OpIAdd, and "OpUnknown(n)" for opcodes that the installed SPIRV-Tools do not
// know.
std::string name_of_opcode(uint32_t opcode);

// These functions return SPIR-V's names of enumerants, such as "RayQueryKHR", or the number where SPIRV-Tools
// do not know it.
std::string name_of_capability(uint32_t capability);
std::string name_of_storage_class(uint32_t storage);
std::string name_of_builtin(uint32_t builtin);
std::string name_of_execution_model(uint32_t model);
std::string name_of_glsl_function(uint32_t function);  // "GLSL.std.450 Ldexp"

}  // namespace glint::frontend
