// Moves entries of rays' stacks between the chip, shared memory and memory, as the stack model asks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "memsys/l1_port.h"
#include "memsys/ring.h"
#include "rtunit/stack_model.h"
#include "rtunit/unit/fetch_queue.h"
#include "rtunit/unit/ray_walk.h"
#include "rtunit/unit/request_source.h"
#include "rtunit/unit/shared_stack_port.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

// Model: each request moves one sector; lanes do not share requests.
class StackMover final : public RequestSource, public WalkHook {
 public:
  // `stacks` is the physical, line-aligned address of bytes_per_warp() for each warp slot of the core.
  StackMover(std::unique_ptr<StackModel> model, Address stacks, mem::L1Port& l1, WarpBuffer& buffer,
             FetchQueue& fetches, RayWalk& walk, RtStats& stats);
  static uint64_t bytes_per_warp(const StackModel& model) {
    return StackLayout{0, model.rows()}.bytes_per_warp();
  }
  // Returns whether rays' stacks ever leave the chip under this model.
  static bool is_needed(const StackModel& model) { return model.rows() != 0 || model.keeps_path(); }

  // Moves rows between the chip and shared memory in a cycle.
  void move_shared(Cycle now);
  bool has_shared() const { return shared_.has_value(); }
  // Returns whether a ray waits for entries in shared memory.
  bool has_shared_loads() const { return shared_ && shared_->has_loads(); }

  void entered(uint32_t slot, int lane, Cycle now) override;
  bool detour(uint32_t slot, int lane, Cycle now) override;
  void errand_started(uint32_t slot, int lane) override;
  void visited(const Visit& visit) override;

  bool has_request(Cycle now) const override;
  bool send(Cycle now) override;
  bool has_reads_waiting() const override { return !moves_.empty(); }
  Cycle next_event(Cycle now) const override;

 private:
  // Describes a sector of a lane's stack that is to be written or read.
  struct Move {
    uint32_t slot = 0;
    uint16_t row = 0;
    uint8_t lane = 0;
    bool is_fill = false;
  };
  using Shared = SharedStackPort;
  void ask_shared(Shared::Kind kind, uint32_t slot, int lane, uint16_t row, Cycle now);
  void leave_chip(uint32_t slot, int lane, Cycle now);
  StackWork& work_of(uint32_t slot, int lane) { return work_[slot][size_t(lane)]; }

  const std::unique_ptr<StackModel> model_;
  const StackLayout layout_;
  mem::L1Port& l1_;
  WarpBuffer& buffer_;
  FetchQueue& fetches_;
  RayWalk& walk_;
  RtStats& stats_;
  std::optional<SharedStackPort> shared_;
  std::vector<std::array<StackWork, kLanes>> work_;  // work left before the lane's next node, by slot
  mem::Ring<Move> moves_;
};

}  // namespace glint::rt
