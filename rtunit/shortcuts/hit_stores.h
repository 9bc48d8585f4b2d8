// Stores every hit and candidate on its own as soon as its test has ended (rt.shortcuts.store_each_hit).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "memsys/l1_port.h"
#include "rtunit/unit/request_source.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

class HitStores final : public RequestSource, public WalkHook, public WarpExit {
 public:
  // `records` is the physical, line-aligned address of kBytes. With `has_tables`, candidates of the deferred
  // any-hit mode are stored too.
  HitStores(uint32_t latency, mem::L1Port& l1, WarpBuffer& buffer, RtStats& stats, Address records,
            bool has_tables);
  // Choice: the addresses begin again after so many records. Vulkan-Sim never reuses one.
  static constexpr uint32_t kRecords = 1 << 16, kRecordBytes = 256;
  static constexpr uint64_t kBytes = uint64_t{kRecords} * kRecordBytes;

  void visited(const Visit& visit) override;
  void test_ended(uint32_t slot, int lane) override;
  bool holds(uint32_t slot, Cycle now) override;
  bool has_request(Cycle) const override { return num_unsent_ != 0; }
  bool send(Cycle now) override;
  Cycle next_event(Cycle now) const override;
  // Lets the warps go whose last stores have been acknowledged.
  void acknowledge(Cycle now);

 private:
  struct Stores {
    std::array<uint8_t, kLanes> in_test{};  // stores of the lane's present test, sent when it ends
    uint32_t unsent = 0;
    Cycle last_sent = 0;
    bool is_waiting = false;  // The warp may leave when its last store is acknowledged.
  };

  const uint32_t latency_;  // cycles from a store to its acknowledgement
  mem::L1Port& l1_;
  WarpBuffer& buffer_;
  RtStats& stats_;
  const Address records_;
  const bool has_tables_;
  std::vector<Stores> stores_;  // by slot
  uint32_t num_unsent_ = 0, num_waiting_ = 0, next_record_ = 0;
};

}  // namespace glint::rt
