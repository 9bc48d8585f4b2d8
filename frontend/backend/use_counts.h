// Counts the instructions that read a register.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "frontend/backend/slots.h"

namespace glint::frontend {

// Returns how many instructions still to come read `r`.
inline uint32_t uses_of(const std::vector<std::pair<VirtualRegister, uint32_t>>& uses, VirtualRegister r) {
  const auto at = std::lower_bound(uses.begin(), uses.end(), r,
                                   [](const auto& a, VirtualRegister b) { return a.first < b; });
  return at != uses.end() && at->first == r ? at->second : 0;
}

template <class Visit>
void for_each_distinct_use(const VirtualInst& inst, Visit&& visit) {
  std::vector<VirtualRegister> seen;
  for_each_use(inst, [&](VirtualRegister r) {
    if (std::find(seen.begin(), seen.end(), r) != seen.end()) return;
    seen.push_back(r);
    visit(r);
  });
}

// Returns the number of instructions that read each register, sorted by register.
inline std::vector<std::pair<VirtualRegister, uint32_t>> count_uses(const std::vector<VirtualInst>& code) {
  std::vector<VirtualRegister> all;
  for (const VirtualInst& inst : code)
    for_each_distinct_use(inst, [&](VirtualRegister r) { all.push_back(r); });
  std::sort(all.begin(), all.end());
  std::vector<std::pair<VirtualRegister, uint32_t>> uses;
  for (VirtualRegister r : all) {
    if (uses.empty() || uses.back().first != r) uses.emplace_back(r, 0);
    ++uses.back().second;
  }
  return uses;
}

}  // namespace glint::frontend
