// Reaches global memory for the executor of one of several cores, through the core's view.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/access_rows.h"
#include "exec/memory_view.h"

namespace glint::exec {

// Reaches global memory. Without a view, effects on it happen at once, and only is_used() and is_late() may
// be called.
class SeenMemory {
 public:
  void use(MemoryView* view) { view_ = view; }
  bool is_used() const { return view_ != nullptr; }
  MemoryView& view() { return *view_; }

  // Notes that another access begins.
  void begin_access() { is_late_ = false; }
  // Returns whether the last load or atomic writes its registers only when the view is committed.
  bool is_late() const { return is_late_; }
  void be_late(bool is_late) { is_late_ = is_late; }

  // `at` says where the data of each of the lanes lies. `shape` may have fewer parts than the instruction.
  void load(WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape, LaneMask lanes,
            const LanePlaces& at);
  void store(const WarpContext& warp, const isa::Inst& inst, const isa::Memory& shape, LaneMask lanes,
             const LanePlaces& at);
  void modify(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes,
              const LanePlaces& at);

 private:
  MemoryView* view_ = nullptr;
  bool is_late_ = false;
};

}  // namespace glint::exec
