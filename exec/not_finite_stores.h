// Notes which instructions stored infinities and NaNs to images.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <unordered_map>

#include "base/types.h"

namespace glint::exec {

// Knows for each texel the last store to it that was not finite. When a texel is not finite after a launch,
// and only stores have written it, this is the store that made it so.
class NotFiniteStores {
 public:
  struct Store {
    Cycle at = 0;
    uint32_t pc = 0;
  };
  // Notes a store. Of one texel's stores the latest stays, and at the same time the one that is noted later.
  void note(Address texel, const Store& store) {
    Store& kept = stores_[texel];
    if (store.at >= kept.at) kept = store;
  }
  void add(const NotFiniteStores& other) {
    for (const auto& [texel, store] : other.stores_) note(texel, store);
  }
  const std::unordered_map<Address, Store>& by_texel() const { return stores_; }

 private:
  std::unordered_map<Address, Store> stores_;
};

}  // namespace glint::exec
