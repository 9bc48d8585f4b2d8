// Holds the stack of one ray: the nodes that it still has to visit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glint::rt {

// build_top() proves that no ray can need more entries. The stack model decides how many of them are on chip
// (rtunit/stack_model.h).
inline constexpr int kStackEntries = 192;

// Names a node that is still to be visited, and says where the ray enters it.
struct StackEntry {
  // NodeRef (rtunit/structure/structure.h): the kind, and the block from the base of the structure being
  // walked
  uint32_t node;
  float t_enter;
};

// Only entries that were set mean anything. Entries deeper than most rays ever go lie apart, in storage that
// is made when a ray first needs it and then kept. So a resident thread stays below 1 KB of the host's
// memory, and no ray waits for the heap twice.
class RayStack {
 public:
  const StackEntry& operator[](size_t i) const {
    if (i < kNear) [[likely]]
      return near_[i];
    return deep_[i - kNear];
  }
  void set(size_t i, const StackEntry& entry) {
    if (i < kNear) [[likely]]
      near_[i] = entry;
    else
      set_deep(i - kNear, entry);
  }

  // Returns where the entries from `size` on lie, or null when the next `count` may not all lie near.
  StackEntry* near_room(size_t size, size_t count) {
    if (size + count <= kNear) [[likely]]
      return near_.data() + size;
    return nullptr;
  }

 private:
  // Choice: of LumiBench's scenes, SHIP needs 16 entries and WKND 10; in PARK, one ray of fifty needs 31.
  static constexpr size_t kNear = 16;

  void set_deep(size_t i, const StackEntry& entry) {
    if (i >= deep_.size()) deep_.resize(2 * i + 8);
    deep_[i] = entry;
  }

  std::array<StackEntry, kNear> near_;  // It is left uninitialised.
  std::vector<StackEntry> deep_;
};

}  // namespace glint::rt
