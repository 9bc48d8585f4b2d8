// Lists the specialisation constants of a SPIR-V module and gives them other values.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace glint::frontend {

struct SpecConstant {
  uint32_t id = 0;     // SpecId, which GLSL calls constant_id
  std::string name;    // empty when the module has no names
  std::string number;  // "bool", "u32", "s32", "f32", "f16", ...
  uint64_t value = 0;  // bits of the default; a bool is 0 or 1
};

// Returns the constants in the order of their ids. Throws UserError when the words are malformed.
std::vector<SpecConstant> spec_constants(const std::vector<uint32_t>& words, const std::string& name);

// Gives constants new bits by SpecId. Ids that the module lacks are ignored, as in VkSpecializationInfo.
std::vector<uint32_t> specialize(std::vector<uint32_t> words, const std::map<uint32_t, uint64_t>& values);

}  // namespace glint::frontend
