// Models the ports through which the RT unit comes to rays' stacks in the SM's shared memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/stats.h"
#include "memsys/ring.h"
#include "rtunit/stack_model.h"

namespace glint::rt {

struct SharedStackStats {
  explicit SharedStackStats(stats::Group* parent) : group(parent, "shared_stack") {}
  stats::Group group;
  stats::Counter stores{&group, "stores", "sector",
                        "Number of rows of four entries that went from the chip to shared memory."};
  stats::Counter loads{&group, "loads", "sector",
                       "Number of rows of four entries that came from shared memory to the chip."};
  stats::Counter spills{&group, "spills", "sector",
                        "Number of rows of four entries that made room in shared memory and went to memory."};
  stats::Counter passes{&group, "passes", "pass", "Number of passes through the banks of shared memory."};
  stats::Counter conflicts{&group, "conflicts", "pass",
                           "Number of passes that ended because the next row wanted banks in use."};
  stats::Counter busy_cycles{&group, "busy_cycles", "cycle", "Number of cycles with a pass."};
  stats::Counter waited{&group, "waited", "row*cycle",
                        "Cycles from a row's coming to the ports to its pass, summed over rows."};
};

// Moves rows in the order in which they were asked for. A pass takes the rows up to the first whose banks it
// uses already.
class SharedStackPort {
 public:
  enum class Kind : uint8_t { Store, Load, Spill };
  struct Move {
    uint32_t slot = 0;
    uint16_t row = 0;
    uint8_t lane = 0;
    Kind kind = Kind::Store;
  };
  SharedStackPort(const SharedArea& area, stats::Group* stats) : area_(area), stats_(stats) {}

  // Asks for a move of the thread in lane `bank_lane` of its warp, from `now` on.
  void ask(const Move& move, int bank_lane, Cycle now) {
    num_loads_ += move.kind == Kind::Load;
    waiting_.push({move, uint8_t(area_.quarter(move.row, bank_lane)), now});
  }
  // Makes the passes of a cycle. Calls done(move) for each store that has passed, and for each row that has
  // been read.
  template <class Done>
  void run(Cycle now, Done&& done) {
    while (!arriving_.empty() && arriving_.front().at <= now) {
      const Move move = arriving_.front().move;
      arriving_.pop();
      num_loads_ -= move.kind == Kind::Load;
      done(move);
    }
    stats_.busy_cycles += !waiting_.empty();
    for (uint32_t i = 0; i < area_.ports && !waiting_.empty(); ++i) pass(now, done);
  }
  // Returns whether a ray waits for entries that are read.
  bool has_loads() const { return num_loads_ != 0; }
  // Returns the first cycle after `now` in which run() does anything.
  Cycle next_event(Cycle now) const {
    if (!waiting_.empty()) return now + 1;
    return arriving_.empty() ? kNever : arriving_.front().at;
  }

 private:
  struct Waiting {
    Move move;
    uint8_t quarter = 0;
    Cycle since = 0;
  };
  struct Arriving {
    Move move;
    Cycle at = 0;
  };

  template <class Done>
  void pass(Cycle now, Done&& done) {
    ++stats_.passes;
    uint32_t used = 0;
    while (!waiting_.empty()) {
      const Waiting next = waiting_.front();
      if (used >> next.quarter & 1) {
        ++stats_.conflicts;
        return;
      }
      used |= 1u << next.quarter;
      waiting_.pop();
      stats_.waited += now - next.since;
      ++counter_of(next.move.kind);
      if (next.move.kind == Kind::Store)
        done(next.move);
      else
        arriving_.push({next.move, now + area_.latency});
    }
  }
  stats::Counter& counter_of(Kind kind) {
    return kind == Kind::Store ? stats_.stores : kind == Kind::Load ? stats_.loads : stats_.spills;
  }

  const SharedArea area_;
  SharedStackStats stats_;
  mem::Ring<Waiting> waiting_;
  mem::Ring<Arriving> arriving_;
  uint32_t num_loads_ = 0;  // loads that were asked for and have not arrived
};

}  // namespace glint::rt
