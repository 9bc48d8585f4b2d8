// Implements the replacement policy `lru`: the line that has gone unused for longest makes way.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "memsys/replacement/slot_order.h"

namespace glint::mem {
namespace {

// A line that loses its last sector keeps its position in the order.
class Lru final : public Replacement {
 public:
  static constexpr const char* kName = "lru";
  static constexpr const char* kDoc = "The least recently used line of the set makes way.";
  struct Params {
    static ParamList params() { return {}; }
  };

  Lru(const Params&, const Context& context) : order_(context) {}

  uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const override {
    return order_.oldest_not_held(set, lines);
  }
  void filled(uint32_t slot) override { order_.make_newest(slot); }
  void touched(uint32_t slot) override { order_.make_newest(slot); }
  void prefetch(uint32_t set) const override { order_.prefetch(set); }

 private:
  SlotOrder order_;
};

const Register<Replacement, Lru> registered;

}  // namespace
}  // namespace glint::mem
