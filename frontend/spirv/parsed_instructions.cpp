// Lets SPIRV-Tools parse a module, because it knows which operands are ids.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/parsed_instructions.h"

#include <cstdint>
#include <spirv-tools/libspirv.h>
#include <utility>
#include <vector>

namespace glint::frontend {
namespace {

struct ParsedModule {
  std::vector<ParsedInst> insts;
  size_t next = kHeaderWords;
};

spv_result_t take_instruction(void* module, const spv_parsed_instruction_t* parsed) {
  auto& out = *static_cast<ParsedModule*>(module);
  ParsedInst inst{spv::Op(parsed->opcode), out.next,          parsed->num_words,
                  parsed->type_id,         parsed->result_id, {}};
  for (uint16_t i = 0; i < parsed->num_operands; ++i) {
    const spv_parsed_operand_t& operand = parsed->operands[i];
    const bool is_id = operand.type == SPV_OPERAND_TYPE_ID || operand.type == SPV_OPERAND_TYPE_SCOPE_ID ||
                       operand.type == SPV_OPERAND_TYPE_MEMORY_SEMANTICS_ID;
    if (is_id) inst.ids.push_back(operand.offset);
  }
  out.next += parsed->num_words;
  out.insts.push_back(std::move(inst));
  return SPV_SUCCESS;
}

}  // namespace

std::vector<ParsedInst> parsed_instructions(const Words& words) {
  ParsedModule module;
  const spv_context context = spvContextCreate(SPV_ENV_UNIVERSAL_1_6);
  const spv_result_t result =
      spvBinaryParse(context, &module, words.data(), words.size(), nullptr, take_instruction, nullptr);
  spvContextDestroy(context);
  return result == SPV_SUCCESS ? std::move(module.insts) : std::vector<ParsedInst>{};
}

}  // namespace glint::frontend
