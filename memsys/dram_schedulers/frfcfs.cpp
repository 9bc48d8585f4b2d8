// Implements the DRAM scheduler `frfcfs`: row hits go first, then the oldest request (FR-FCFS; Rixner et al.,
// ISCA 2000).
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "base/registry.h"
#include "memsys/dram_scheduler.h"

namespace glint::mem {
namespace {

// Each bank has a list of its requests, oldest first. Without a cap, a stream of row hits can starve a row
// miss for as long as the stream lasts, as in GPGPU-Sim.
class FrFcfs final : public DramScheduler {
 public:
  static constexpr const char* kName = "frfcfs";
  static constexpr const char* kDoc =
      "A bank takes a request to its open row first, then its oldest request.";
  struct Params {
    uint32_t hit_cap = 0;
    static ParamList params() {
      return {
          param(&Params::hit_cap, "hit_cap", "request",
                "Number of row hits in a row that may overtake the oldest request of a bank. 0: no limit.", 0,
                1 << 16)};
    }
  };

  FrFcfs(const Params& params, Context context)
      : params_(params), links_(context.capacity), banks_(context.banks) {}

  void add(uint32_t slot, const DramRequest& request) override {
    Bank& bank = banks_[request.bank];
    links_[slot] = {request.row, kNone};
    (bank.last == kNone ? bank.first : links_[bank.last].next) = slot;
    bank.last = slot;
  }
  uint32_t pick(uint32_t index, uint32_t open_row) override {
    Bank& bank = banks_[index];
    if (bank.first == kNone) return kNone;
    uint32_t before = kNone, slot = bank.first;
    if (params_.hit_cap == 0 || bank.overtaken < params_.hit_cap)
      while (slot != kNone && links_[slot].row != open_row) before = slot, slot = links_[slot].next;
    if (slot == kNone) before = kNone, slot = bank.first;
    bank.overtaken = before == kNone ? 0 : bank.overtaken + 1;
    (before == kNone ? bank.first : links_[before].next) = links_[slot].next;
    if (bank.last == slot) bank.last = before;
    return slot;
  }

 private:
  struct Link {
    uint32_t row = 0, next = kNone;
  };
  struct Bank {
    uint32_t first = kNone, last = kNone;
    uint32_t overtaken = 0;  // number of picks in a row that passed over the oldest request
  };
  Params params_;
  std::vector<Link> links_;  // by slot
  std::vector<Bank> banks_;
};

const Register<DramScheduler, FrFcfs> registered;

}  // namespace
}  // namespace glint::mem
