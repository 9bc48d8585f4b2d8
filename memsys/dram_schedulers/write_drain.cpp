// Implements the DRAM scheduler `write_drain`: FR-FCFS holds writes back and drains many at once, so that the
// data bus turns less often.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "base/registry.h"
#include "memsys/dram_scheduler.h"

namespace glint::mem {
namespace {

// A drain serves writes; it begins when `high` writes wait and ends when `low` are left. Writes are also
// served while there is no read. Among reads and among writes, row hits go first, then the oldest, as in
// GPGPU-Sim's write queue with its two watermarks.
class WriteDrain final : public DramScheduler {
 public:
  static constexpr const char* kName = "write_drain";
  static constexpr const char* kDoc =
      "FR-FCFS serves reads; writes wait until enough of them can be drained in a row.";
  struct Params {
    uint32_t high = 32;
    uint32_t low = 16;
    static ParamList params() {
      return {
          param(
              &Params::high, "high", "request",
              "Number of waiting writes at which a drain begins. More than half of the queue counts as half.",
              1, 1 << 16),
          param(&Params::low, "low", "request",
                "Number of waiting writes at which a drain ends. A number of `high` or more counts as `high` "
                "- 1.",
                0, 1 << 16)};
    }
  };

  WriteDrain(const Params& params, Context context)
      : high_(std::max(1u, std::min(params.high, context.capacity / 2))),
        low_(std::min(params.low, high_ - 1)),
        links_(context.capacity),
        lists_(size_t{context.banks} * 2) {}

  void add(uint32_t slot, const DramRequest& request) override {
    List& list = lists_[request.bank * 2 + request.write];
    links_[slot] = {request.row, kNone};
    (list.last == kNone ? list.first : links_[list.last].next) = slot;
    list.last = slot;
    ++count_[request.write];
    if (count_[1] >= high_) draining_ = true;
  }
  uint32_t pick(uint32_t bank, uint32_t open_row) override {
    const bool writes = draining_ || count_[0] == 0;
    const uint32_t slot = take(lists_[bank * 2 + writes], open_row);
    if (slot == kNone) return kNone;
    --count_[writes];
    if (count_[1] <= low_) draining_ = false;
    return slot;
  }

 private:
  struct Link {
    uint32_t row = 0, next = kNone;
  };
  // Holds the requests of one bank and one direction, oldest first.
  struct List {
    uint32_t first = kNone, last = kNone;
  };

  uint32_t take(List& list, uint32_t open_row) {
    if (list.first == kNone) return kNone;
    uint32_t before = kNone, slot = list.first;
    while (slot != kNone && links_[slot].row != open_row) before = slot, slot = links_[slot].next;
    if (slot == kNone) before = kNone, slot = list.first;
    (before == kNone ? list.first : links_[before].next) = links_[slot].next;
    if (list.last == slot) list.last = before;
    return slot;
  }

  const uint32_t high_, low_;
  std::vector<Link> links_;  // by slot
  std::vector<List> lists_;  // by bank * 2 + write
  uint32_t count_[2] = {};   // numbers of waiting reads and writes
  bool draining_ = false;
};

const Register<DramScheduler, WriteDrain> registered;

}  // namespace
}  // namespace glint::mem
