// Remembers in which treelet each lane's node lies.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "memsys/address_space.h"
#include "rtunit/treelets.h"

namespace glint::rt {

// Looks a node up once, though it is asked for each time that a request is chosen.
class LaneTreelets {
 public:
  LaneTreelets(const mem::AddressSpace& memory, uint32_t warps) : treelets_(memory), last_(warps) {}

  // Returns the treelet of the node at `address`, which the lane of the slot wants.
  TreeletId of(uint32_t slot, int lane, Address address) {
    Last& last = last_[slot][size_t(lane)];
    if (last.address != address) last = {address, treelets_.of(address)};
    return last.treelet;
  }

 private:
  struct Last {
    Address address = 0;
    TreeletId treelet = kNoTreelet;
  };
  const Treelets treelets_;
  std::vector<std::array<Last, kLanes>> last_;  // by slot
};

}  // namespace glint::rt
