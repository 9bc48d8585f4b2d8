// Writes the results of a warp's rays to memory before the warp leaves the RT unit (rt.result_store).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "memsys/l1_port.h"
#include "memsys/ring.h"
#include "rtunit/unit/request_source.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

// Model: results are written as node traffic, 32 B per ray, one request per line. The warp is given back when
// the L1 has taken them.
class ResultWriter final : public RequestSource, public WarpExit {
 public:
  // `results` is the physical, line-aligned address of bytes() for all slots of the warp buffer.
  ResultWriter(mem::L1Port& l1, WarpBuffer& buffer, RtStats& stats, Address results);
  static uint64_t bytes(const Params& params);

  bool holds(uint32_t slot, Cycle now) override;
  bool has_request(Cycle) const override { return !waiting_.empty(); }
  bool send(Cycle now) override;

 private:
  mem::L1Port& l1_;
  WarpBuffer& buffer_;
  RtStats& stats_;
  const Address results_;
  mem::Ring<uint32_t> waiting_;      // slots with results to write
  std::vector<LaneMask> unwritten_;  // by slot
};

}  // namespace glint::rt
