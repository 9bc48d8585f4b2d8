// Plans which threads of several warps change places, so that threads with equal keys share warps.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/types.h"

namespace glint::core {

// Plans without knowing what a thread is. It allocates only when it is made.
class Regrouping {
 public:
  // Holds what is known of a warp. `movable` has all lanes of `running`; `live` has those of threads that
  // have not ended. Only those of running threads have keys.
  struct Warp {
    LaneMask running = 0, movable = 0, live = 0;
    const uint64_t* keys = nullptr;  // by lane
  };
  struct Swap {
    uint8_t warp_a = 0, lane_a = 0, warp_b = 0, lane_b = 0;  // warps are numbered as in plan()
  };

  explicit Regrouping(uint32_t max_warps);

  // Returns swaps that bring running threads into the order of their keys, from warp to warp. Threads that
  // are in their warp already stay in their lane. With `compact` warps are filled up, and the last ones may
  // keep no running thread; without, each warp keeps its number of them.
  std::span<const Swap> plan(std::span<const Warp> warps, bool compact);
  // Returns the number of live threads that the last plan() takes to another warp.
  uint32_t num_moved() const { return num_moved_; }

 private:
  // These are the targets of threads that do not run; others have the number of a warp.
  static constexpr uint8_t kEnded = 0xff, kWaits = 0xfe;
  struct Thread {
    uint64_t key = 0;
    uint8_t warp = 0, lane = 0;
  };
  struct Place {
    uint8_t target = kEnded;  // the warp that the thread at this place belongs to
    uint8_t origin = 0;       // the warp that it came from
  };

  void sort_threads(std::span<const Warp> warps);
  void choose_targets(std::span<const Warp> warps, bool compact);
  void bring_home(uint8_t warp, std::span<const Warp> warps);
  int find_place(uint8_t warp, LaneMask movable, uint8_t from) const;

  std::vector<Thread> threads_;                    // running threads by key
  std::vector<std::array<Place, kLanes>> places_;  // by warp and lane, as the swaps so far have left them
  std::vector<Swap> swaps_;
  uint32_t num_moved_ = 0;
};

}  // namespace glint::core
