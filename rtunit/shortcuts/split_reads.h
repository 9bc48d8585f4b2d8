// Makes rays read structure headers and leaf descriptors on their own (rt.shortcuts.fetch_headers,
// fetch_descriptors).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "memsys/address_space.h"
#include "rtunit/shortcuts/shortcuts.h"
#include "rtunit/unit/test_pipelines.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

class SplitReads final : public WalkHook {
 public:
  // Adds pipelines for the latency from the arrival of a header or a descriptor to the next fetch.
  SplitReads(const Shortcuts& shortcuts, const mem::AddressSpace& memory, WarpBuffer& buffer,
             TestPipelines& pipelines, RtStats& stats);

  void entered(uint32_t slot, int lane, Cycle now) override;
  bool detour(uint32_t slot, int lane, Cycle now) override;
  void errand_started(uint32_t slot, int lane) override;
  void visited(const Visit& visit) override;

 private:
  // Holds the lanes of a slot whose next read is a header, and the lanes whose leaf has had its descriptor
  // read.
  struct Lanes {
    LaneMask header = 0, described = 0;
  };

  const Shortcuts shortcuts_;
  const mem::AddressSpace& memory_;
  WarpBuffer& buffer_;
  RtStats& stats_;
  const Pipe header_pipe_, descriptor_pipe_;
  std::vector<Lanes> lanes_;  // by slot
};

}  // namespace glint::rt
