// Renames the registers of a run from its first instruction to its last.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/value_names.h"

#include <algorithm>

namespace glint::frontend {
namespace {

auto place_of(auto& names, VirtualRegister r) {
  return std::lower_bound(names.begin(), names.end(), r,
                          [](const auto& a, VirtualRegister b) { return a.first < b; });
}

}  // namespace

VirtualRegister ValueNames::last(VirtualRegister r) const {
  const auto at = place_of(names_, r);
  return at != names_.end() && at->first == r ? at->second : r;
}

ValueNames::ValueNames(const std::vector<VirtualInst>& run, size_t registers)
    : code_(run), registers_(registers) {
  for (VirtualInst& inst : code_) {
    if (is_guarded(inst)) inst.guard = last(inst.guard);
    const auto for_each_register = [&](bool destinations, const auto& visit) {
      for_each_slot(row_of(inst), [&](size_t slot, isa::OperandKind kind) {
        VirtualOperand& o = inst.operands[slot];
        if (is_register(o) && isa::is_destination(kind) == destinations) visit(o.reg);
      });
    };
    for_each_register(false, [&](VirtualRegister& r) { r = last(r); });
    for_each_register(true, [&](VirtualRegister& r) {
      if (is_guarded(inst)) {
        r = last(r);
        return;
      }
      const auto name = VirtualRegister(size());
      written_.push_back(r);
      const auto at = place_of(names_, r);
      if (at != names_.end() && at->first == r)
        at->second = name;
      else
        names_.insert(at, {r, name});
      r = name;
    });
  }
}

}  // namespace glint::frontend
