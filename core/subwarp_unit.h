// Models the part of a core that lets the diverged paths of a warp take turns while they wait for memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/core_parts.h"
#include "core/interleaving.h"

namespace glint::core {

struct SubwarpStats : stats::Group {
  explicit SubwarpStats(Group* parent) : Group(parent, "interleaving") {}

  stats::Counter asked{
      this, "asked", "path",
      "Number of times that another path of a warp could have gone on instead of the one that ran."};
  stats::Counter stalls{this, "stalls", "path",
                        "Number of changes to another path because one waited for memory."};
  stats::Counter yields{this, "yields", "path",
                        "Number of changes to another path because one had sent a load."};
  stats::Counter begun{this, "begun", "path",
                       "Number of paths that began before the one that ran had ended."};
};

// A warp has one scoreboard, which is that of its running path. The unit knows which lanes each access is
// for, so that a path waits for the registers of its own lanes only, and it makes the scoreboard anew when
// other lanes run.
//
// Model: hardware would keep a scoreboard for each path. Results that come while their path does not run are
// ready when it runs again. Results of fixed latency hold up all paths of a warp. Waits for rays, for records
// of the binding table, for barriers and for fences hold up the whole warp, and so do registers that another
// path's store has not read yet.
class SubwarpUnit {
 public:
  // Returns null when the policy never changes a path.
  static std::unique_ptr<SubwarpUnit> make(const CoreParts& core);
  SubwarpUnit(const CoreParts& core, std::unique_ptr<Interleaving> policy);

  // Notes that a warp begins in the slot.
  void start_warp(uint32_t slot) {
    slots_[slot].accesses.clear();
    slots_[slot].ready = 0;
  }
  // Notes an access that registers of `lanes` wait for.
  void begin(uint32_t slot, uint32_t access, uint32_t pc, LaneMask lanes);
  // Notes that the results of the access are ready in cycle `ready`. The registers of the running lanes are
  // ready then or later, when other lanes of the warp have results later.
  void end(uint32_t slot, uint32_t access, Cycle ready);
  // Notes that the warp has executed an instruction. `before` are the lanes that ran before it.
  void follow(uint32_t slot, LaneMask before) {
    if (core_.warps[slot].warp.simt.active != before) renew(core_.warps[slot], slots_[slot]);
  }
  // Lets the path that has sent an access make room for another one. The caller looks up what the warp waits
  // for.
  void yield(uint32_t slot, Cycle now);
  // Lets warps of the scheduler whose running paths wait for memory go on with others. It is called when the
  // scheduler has looked for warps that can issue.
  void look(Scheduler& scheduler, Cycle now);

 private:
  struct Access {
    uint32_t number, pc;
    LaneMask lanes;
  };
  struct Slot {
    std::vector<Access> accesses;  // those that registers wait for; it keeps its capacity
    Cycle ready = 0;               // when the results of all lanes are ready that have come
  };

  std::optional<size_t> offer(const WarpSlot& at, const Slot& slot);
  uint64_t waiting_of(const Scheduler& scheduler) const;
  Interleaving::View view_of(const WarpSlot& at, size_t path) const;
  std::optional<size_t> next_path(const WarpSlot& at, const Slot& slot) const;
  bool fills(const Slot& slot, LaneMask lanes, uint16_t def) const;
  bool can_issue(const exec::SimtStack::Entry& path, const Slot& slot) const;
  void change(WarpSlot& at, Slot& slot, size_t path, Cycle now);
  void renew(WarpSlot& at, Slot& slot) const;

  const CoreParts core_;
  const std::unique_ptr<Interleaving> policy_;
  SubwarpStats stats_;
  std::vector<Slot> slots_;
};

}  // namespace glint::core
