// Validation and disassembly of SPIR-V through SPIRV-Tools.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv.h"

#include <fmt/format.h>
#include <spirv-tools/libspirv.hpp>

#include "frontend/compile.h"

namespace glint::frontend {

std::string validate_spirv(const std::vector<uint32_t>& words) {
  std::string messages;
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  tools.SetMessageConsumer(
      [&](spv_message_level_t level, const char*, const spv_position_t& at, const char* text) {
        if (level <= SPV_MSG_ERROR) messages += fmt::format("word {}: {}\n", at.index, text);
      });
  spvtools::ValidatorOptions options;
  options.SetScalarBlockLayout(true);
  if (tools.Validate(words.data(), words.size(), options)) return {};
  return messages.empty() ? "the SPIR-V validator rejected the module without a message\n" : messages;
}

std::string name_of_opcode(uint32_t opcode) {
  const char* name = spvOpcodeString(opcode);
  if (name == nullptr || std::string_view(name) == "unknown") return fmt::format("OpUnknown({})", opcode);
  return fmt::format("Op{}", name);
}

std::string disassemble_spirv(const std::vector<uint32_t>& words) {
  std::string text;
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  const uint32_t options = SPV_BINARY_TO_TEXT_OPTION_INDENT | SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES;
  if (!tools.Disassemble(words, &text, options))
    throw UserError("error: not a SPIR-V module: it cannot be disassembled");
  return text;
}

}  // namespace glint::frontend
