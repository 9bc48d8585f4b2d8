// Writes the entries of candidate tables to memory (deferred any-hit mode).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "memsys/l1_port.h"
#include "memsys/ring.h"
#include "rtunit/unit/request_source.h"
#include "rtunit/unit/walk_hook.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

// Lanes that have filled the same row share a request, if their entries lie in one line and have not been
// sent.
class TableWriter final : public RequestSource, public WalkHook {
 public:
  TableWriter(mem::L1Port& l1, WarpBuffer& buffer, RtStats& stats, const TableLayout& tables);

  void visited(const Visit& visit) override;
  bool has_request(Cycle) const override { return !waiting_.empty(); }
  bool send(Cycle now) override;

 private:
  struct Unsent {
    uint32_t rows = 0;                            // rows of the table with entries to write
    std::array<LaneMask, kMaxTableRows> lanes{};  // lanes of each of these rows
  };

  mem::L1Port& l1_;
  WarpBuffer& buffer_;
  RtStats& stats_;
  const TableLayout tables_;
  mem::Ring<uint32_t> waiting_;  // slots with entries to write
  std::vector<Unsent> unsent_;   // by slot
};

}  // namespace glint::rt
