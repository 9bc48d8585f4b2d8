// Declares the interface of the policies that regroup the threads of a core's warps where these wait for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <string_view>

#include "base/params.h"
#include "base/registry.h"
#include "base/stats.h"
#include "base/types.h"
#include "exec/reorder_calls.h"

namespace glint::core {

// Holds what regrouping costs and how long warps wait for it, whatever the policy. Choice: no vendor
// publishes these. A batch of 8 warps is a quarter of a Turing core's, 64 bytes a cycle is what its L1 gives,
// and the time is that of the slower of the traces after which warps come.
struct ReorderParams {
  uint32_t batch = 8, timeout = 8000;
  uint32_t latency = 50, bytes_per_cycle = 64;
  bool compact = true;
  static ParamList params() {
    return {param(&ReorderParams::batch, "batch", "warp",
                  "Number of warps at the same call whose threads are regrouped together.", 1, 64),
            param(&ReorderParams::timeout, "timeout", "cycle",
                  "Cycles from the first warp at a call to the regrouping of those that have come, although "
                  "the batch is not full.",
                  1, 10'000'000),
            param(&ReorderParams::latency, "latency", "cycle",
                  "Cycles from the last warp of a batch to the next instruction of its warps, without the "
                  "time in which threads move.",
                  1, 100'000),
            param(&ReorderParams::bytes_per_cycle, "bytes_per_cycle", "byte",
                  "Bytes of registers and stack that a core moves between its warps per cycle.", 1, 4096),
            flag(&ReorderParams::compact, "compact",
                 "True: threads also take the places of threads that have ended or wait elsewhere, which "
                 "fills warps. False: each warp keeps its number of running threads.")};
  }
};

// Contract (tests/contract/reorder_test.cpp):
//  - where() never changes. The compiler asks it, and it decides at which instructions warps come.
//  - key() depends on the call and on the policy's parameters only. Threads with equal keys end up side by
//    side, and smaller keys come first.
//  - goes() is asked once for each warp that has come, and depends on its argument only. A batch also goes
//    when its time is over, and when all warps of the core wait.
//  - A policy changes which threads form a warp, and so cycles, but no result, except those of operations
//    across the lanes of a warp.
class Reorder {
 public:
  static constexpr PolicyKind kKind{"core.reorder", "core/reorders"};
  // Says where warps come: nowhere, at the shader's own calls of reorderThread, or behind each trace.
  enum class Where : uint8_t { Nowhere, Calls, Traces };
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
  };
  // Holds the warps that wait at one place.
  struct Waiting {
    uint32_t warps = 0, threads = 0;  // the threads are those that run
    uint32_t batch = 1;               // ReorderParams::batch
  };
  virtual ~Reorder() = default;
  virtual Where where() const = 0;
  // Returns what threads are sorted by.
  virtual uint64_t key(const exec::ReorderCall&) const { return 0; }
  // Returns whether the warps that wait are regrouped now.
  virtual bool goes(const Waiting& waiting) const { return waiting.warps >= waiting.batch; }

 protected:
  // Returns a number below 2^32 that is the same for calls of the same shader record, and only for these.
  static uint64_t record_key(const exec::ReorderCall& call) {
    return uint64_t(call.found) << 30 | std::min(call.record, (uint32_t{1} << 30) - 1);
  }
};

}  // namespace glint::core
