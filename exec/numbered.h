// Finds ray queries and hit objects, which instructions name by number.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "exec/fault_gate.h"
#include "exec/warp_context.h"

namespace glint::exec {

// Returns the number that all executing lanes give in `operand`, or nothing after a fault. `what` names the
// kind of object for the message.
std::optional<uint32_t> shared_number(FaultGate& faults, const WarpContext& warp, isa::Slot operand,
                                      std::string_view what);

// Returns the objects that all executing lanes name, one per lane, of a level of traces. Returns null after a
// fault.
template <class Object>
Object* find_numbered(FaultGate& faults, WarpContext& warp, Numbered<Object>& objects, isa::Slot operand,
                      uint32_t level, std::string_view what) {
  const std::optional<uint32_t> number = shared_number(faults, warp, operand, what);
  if (!number) return nullptr;
  const size_t place = size_t(level) * kMaxNumbered + *number;
  if (objects.size() <= place) objects.resize(place + 1);
  if (!objects[place]) objects[place] = std::make_unique<std::array<Object, kLanes>>();
  return objects[place]->data();
}

}  // namespace glint::exec
