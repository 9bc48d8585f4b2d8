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

// "OpIAdd" for spv::Op::OpIAdd; "OpUnknown(n)" for opcodes that the installed SPIRV-Tools does not know.
std::string name_of_opcode(uint32_t opcode);

}  // namespace glint::frontend
