// Implements the replacement policy `fifo`: the line that came first makes way, however often it is used.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "memsys/replacement/slot_order.h"

namespace glint::mem {
namespace {

// A line that loses its last sector keeps its position in the order.
class Fifo final : public Replacement {
 public:
  static constexpr const char* kName = "fifo";
  static constexpr const char* kDoc = "The line of the set that was filled first makes way.";
  struct Params {
    static ParamList params() { return {}; }
  };

  Fifo(const Params&, const Context& context) : order_(context) {}

  uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const override {
    return order_.oldest_not_held(set, lines);
  }
  void filled(uint32_t slot) override { order_.make_newest(slot); }
  void touched(uint32_t) override {}
  void prefetch(uint32_t set) const override { order_.prefetch(set); }

 private:
  SlotOrder order_;
};

const Register<Replacement, Fifo> registered;

}  // namespace
}  // namespace glint::mem
