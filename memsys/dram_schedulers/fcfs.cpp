// Implements the DRAM scheduler `fcfs`: requests go in order of arrival over all banks. It is the baseline
// for FR-FCFS.
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "base/registry.h"
#include "memsys/dram_scheduler.h"

namespace glint::mem {
namespace {

// A bank gets a request only when that request is the oldest of all, so a busy bank holds up the others.
class Fcfs final : public DramScheduler {
 public:
  static constexpr const char* kName = "fcfs";
  static constexpr const char* kDoc =
      "The oldest request of the channel goes first; younger ones wait even when their banks are free.";
  struct Params {
    static ParamList params() { return {}; }
  };

  Fcfs(const Params&, Context context) : links_(context.capacity) {}

  void add(uint32_t slot, const DramRequest& request) override {
    links_[slot] = {request.bank, kNone};
    (last_ == kNone ? first_ : links_[last_].next) = slot;
    last_ = slot;
  }
  uint32_t pick(uint32_t bank, uint32_t) override {
    if (first_ == kNone || links_[first_].bank != bank) return kNone;
    const uint32_t slot = first_;
    first_ = links_[slot].next;
    if (first_ == kNone) last_ = kNone;
    return slot;
  }

 private:
  struct Link {
    uint32_t bank = 0, next = kNone;
  };
  std::vector<Link> links_;  // by slot
  uint32_t first_ = kNone, last_ = kNone;
};

const Register<DramScheduler, Fcfs> registered;

}  // namespace
}  // namespace glint::mem
