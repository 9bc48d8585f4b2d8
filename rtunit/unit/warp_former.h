// Keeps the rays that wait for a place in the RT unit, and forms its warps as a ray pool decides.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/probe.h"
#include "memsys/l1_port.h"
#include "memsys/ring.h"
#include "rtunit/params.h"
#include "rtunit/unit/entry_look_up.h"
#include "rtunit/unit/fetch_queue.h"
#include "rtunit/unit/ray_walk.h"
#include "rtunit/unit/request_source.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

struct PoolStats {
  explicit PoolStats(stats::Group* parent) : group(parent, "pool") {}
  stats::Group group;
  stats::Counter formed{&group, "formed", "warp", "Number of warps that were formed from waiting rays."};
  stats::Counter formed_rays{&group, "formed_rays", "ray", "Number of rays of the warps that were formed."};
  stats::Ratio rays_per_warp{&group,     "rays_per_warp",
                             "ray/warp", formed_rays,
                             formed,     "Mean number of rays of a warp when it is formed."};
  stats::Counter returned{&group, "returned", "ray",
                          "Number of times that a ray went back to the pool before it had stopped."};
  stats::Counter waited{&group, "waited", "ray*cycle",
                        "Cycles from a ray's coming into the pool to its place in a warp, summed over rays."};
  stats::Counter state_writes{&group, "state_writes", "request",
                              "Number of requests that wrote the state of a ray that went back."};
  stats::Counter state_reads{&group, "state_reads", "request",
                             "Number of requests that read the state of a ray that had gone back."};
};

// The unit accepts rt.pool_warps warps of the core, and works on rt.warps warps that it forms itself. A ray
// that waits is in the core's storage; one that is in a formed warp is in storage of the unit.
// Model: a ray without a visit, be it new or looked up, costs nothing to place. A ray that goes back writes
// 32 B, and reads them when it comes into a warp again; with rt.pool_stacks the entries on its stack move,
// too, 32 B for four, as far as they fit into the same line. Model: a warp of the core is complete when its
// last ray has stopped and, with rt.shortcuts.store_each_hit, the acknowledgement of a store sent then has
// come.
class WarpFormer final : public RequestSource, public WalkHook {
 public:
  // `states` is the physical, line-aligned address of bytes() for the states of the rays that went back.
  WarpFormer(const Params& params, const mem::AddressSpace& memory, Address states, mem::L1Port& l1,
             WarpBuffer& buffer, FetchQueue& fetches, RayWalk& walk, RtStats& stats);
  static uint64_t bytes(const Params& params) { return uint64_t{params.pool_warps} * kLanes * kStateBytes; }

  bool has_room() const { return num_accepted_ < accepted_.size(); }
  uint32_t num_accepted() const { return num_accepted_; }
  void accept(Cycle now, uint32_t warp_slot, LaneMask mask, RayState* states);
  // Takes back the formed warps that have left the buffer, and forms new ones while there is room.
  void form(Cycle now);
  std::optional<uint32_t> pop_completion(Cycle now);
  Probe<WarpMoved>& warp_moved() { return warp_moved_; }
  // Returns the hook that takes rays back. It is the last to be asked, when no other part has anything to do
  // for the ray.
  WalkHook& taker() { return taker_; }

  // Lets the pool take rays back whose look-up has given a node.
  void set_look_up(const EntryLookUp& look_up) { look_up_ = &look_up; }

  // A ray that had gone back reads its state before anything else.
  bool detour(uint32_t slot, int lane, Cycle now) override;

  bool has_request(Cycle now) const override;
  bool send(Cycle now) override;
  bool has_reads_waiting() const override { return !moves_.empty() && moves_.front().is_read; }
  Cycle next_event(Cycle now) const override;

 private:
  static constexpr uint32_t kStateBytes = 128;  // room for the state of a ray, which is one line

  // Holds a warp of the core. Its rays have the ids from kLanes times its number on.
  struct Accepted {
    bool is_used = false;
    uint32_t warp_slot = 0;
    Cycle arrived = 0;
    LaneMask mask = 0;
    uint32_t running = 0;  // rays that have not stopped
    RayState* states = nullptr;
    std::array<Cycle, kLanes> since{};  // when the ray began to wait
    LaneMask returned = 0;              // rays that have gone back since they were accepted
  };
  // Holds a warp that was formed.
  struct Formed {
    std::array<RayState, kLanes> states;
    std::array<uint32_t, kLanes> id{};
    std::array<Thread, kLanes> threads{};
    LaneMask to_load = 0;  // lanes whose ray must read its state
    LaneMask visited = 0;  // lanes whose ray has made a visit since it was asked about last
  };
  struct Move {
    uint32_t id = 0, slot = 0;
    uint8_t lane = 0, sectors = 1;
    bool is_read = false;
  };
  struct Complete {
    Cycle ready = 0;
    uint32_t number = 0;  // of the accepted warp
  };
  class Taker final : public WalkHook {
   public:
    explicit Taker(WarpFormer& former) : former_(former) {}
    void visited(const Visit& visit) override {
      former_.formed_[visit.slot].visited |= LaneMask{1} << visit.lane;
    }
    bool detour(uint32_t slot, int lane, Cycle now) override { return former_.takes_back(slot, lane, now); }
    void stopped(uint32_t slot, int lane) override { former_.note_stop(slot, lane); }

   private:
    WarpFormer& former_;
  };

  void add_to_pool(uint32_t id, Cycle now);
  bool form_warp(Cycle now);
  void enter(uint32_t slot, int lane, Cycle now);
  bool takes_back(uint32_t slot, int lane, Cycle now);
  bool takes_predicted(uint32_t slot, int lane, Cycle now);
  void take_back(uint32_t slot, int lane, Cycle now);
  FormedWarp view_of(uint32_t slot) const;
  void note_stop(uint32_t slot, int lane);
  Accepted& of(uint32_t id) { return accepted_[id / kLanes]; }
  RayState& home_of(uint32_t id) { return of(id).states[id % kLanes]; }
  uint8_t sectors_of(const RayState& ray) const;

  const std::unique_ptr<RayPool> policy_;
  const bool moves_stacks_;
  const Cycle acknowledgement_;
  const Address states_;
  mem::L1Port& l1_;
  WarpBuffer& buffer_;
  FetchQueue& fetches_;
  RayWalk& walk_;
  RtStats& unit_stats_;
  PoolStats stats_;
  Probe<WarpMoved> warp_moved_;
  const EntryLookUp* look_up_ = nullptr;
  Taker taker_{*this};
  std::vector<Accepted> accepted_;
  std::vector<Formed> formed_;  // by slot of the warp buffer
  uint32_t num_accepted_ = 0, num_waiting_ = 0;
  bool has_changed_ = false;  // form() may do something that it could not do before.
  mem::Ring<Move> moves_;
  mem::Ring<Complete> complete_;
  Cycle now_ = 0;  // the cycle of the present step
};

}  // namespace glint::rt
