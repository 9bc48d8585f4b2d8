// Feeds a core with instructions and constants through its code caches, when these are not perfect.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/code_cache.h"
#include "core/code_stats.h"
#include "core/constant_cache.h"
#include "core/instruction_fetch.h"
#include "core/params.h"
#include "exec/image.h"

namespace glint::core {

class ConstantPort;
class WarpSlots;

// Says where the image's instructions and the constant bank lie in physical memory.
struct CodePlaces {
  Address code = 0, constants = 0;
};

class CodeSupply {
 public:
  // Returns null when instructions and constants are both perfect.
  static std::unique_ptr<CodeSupply> make(const Params& params, const exec::World& world,
                                          const CodePlaces& places, mem::L1Port& l1, stats::Group* parent);
  CodeSupply(const Params& params, const exec::World& world, const CodePlaces& places, mem::L1Port& l1,
             stats::Group* parent);

  // Advances to `now` and hands out the lines that come in this cycle.
  void tick(Cycle now, WarpSlots& warps, ConstantPort& constants);
  Cycle next_event(Cycle now) const { return cache_.next_event(now); }
  bool idle() const { return cache_.idle(); }

  InstructionFetch* fetch() { return fetch_.get(); }       // null when instructions are perfect
  ConstantCache* constants() { return constants_.get(); }  // null when constants are perfect

 private:
  CodeStats stats_;
  CodeCache cache_;
  std::unique_ptr<InstructionFetch> fetch_;
  std::unique_ptr<ConstantCache> constants_;
};

}  // namespace glint::core
