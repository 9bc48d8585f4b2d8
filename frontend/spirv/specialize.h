// Specialisation constants of a SPIR-V module: what there are, and other values for them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace glint::frontend {

struct SpecConstant {
  uint32_t id = 0;     // SpecId, constant_id of GLSL
  std::string name;    // empty when the module has no names
  std::string number;  // "bool", "u32", "s32", "f32", "f16", ...
  uint64_t value = 0;  // the default: bits; a bool is 0 or 1
};

// In the order of their ids. UserError when the words are malformed.
std::vector<SpecConstant> spec_constants(const std::vector<uint32_t>& words, const std::string& name);

// Gives constants by SpecId other bits. Ids that the module lacks are left out, as VkSpecializationInfo does.
std::vector<uint32_t> specialize(std::vector<uint32_t> words, const std::map<uint32_t, uint64_t>& values);

}  // namespace glint::frontend
