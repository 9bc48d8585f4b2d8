// Declares the interface of the policies by which the diverged paths of a warp take turns while one of them
// waits for memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "base/params.h"
#include "base/registry.h"
#include "base/stats.h"
#include "base/types.h"

namespace glint::core {

// Holds how many paths of a warp take turns and what a turn costs, whatever the policy. Choice: the abstract
// of Damani et al., HPCA 2022, gives no such numbers. Four paths are more than most branches make, and a
// change takes as long as a branch of the presets.
struct SubwarpParams {
  uint32_t paths = 4, latency = 4;
  static ParamList params() {
    return {param(&SubwarpParams::paths, "paths", "path",
                  "Number of paths of a warp that may have begun and not ended.", 2, 32),
            param(&SubwarpParams::latency, "latency", "cycle",
                  "Cycles from the change to another path to the first instruction of that path.", 1, 1000)};
  }
};

// Contract (tests/contract/interleaving_test.cpp):
//  - is_used() never changes. Without it a path runs until it ends or its lanes meet those of other paths.
//  - leaves() is asked when the running path of a warp waits for memory, and another path of the same call
//    could issue. yields() is asked when the running path has sent a load, and another path could issue. Both
//    are functions of the view and of the policy's parameters.
//  - A policy changes cycles, and no result, except those of operations across the lanes of a warp.
class Interleaving {
 public:
  static constexpr PolicyKind kKind{"core.interleaving", "core/interleavings"};
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
  };
  // Says what a scheduler's warps do when one of them could change its path.
  struct View {
    uint32_t lanes = 0;    // lanes of the running path
    uint32_t others = 0;   // lanes of the path that could issue
    uint32_t warps = 0;    // warps of the scheduler, with this one
    uint32_t waiting = 0;  // of these, warps whose running paths wait for memory
  };
  virtual ~Interleaving() = default;
  virtual bool is_used() const { return true; }
  virtual bool leaves(const View&) const = 0;
  virtual bool yields(const View&) const { return false; }
};

}  // namespace glint::core
