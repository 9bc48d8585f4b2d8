// Reaches global memory for an executor: at once, through the view of one of several cores, or through the
// copies of a block that runs before its turn.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "exec/access_rows.h"
#include "exec/block_memory.h"
#include "exec/memory_view.h"

namespace glint::exec {

// Reaches global memory. Without a view, effects on it happen at once, and the functions that need one may
// not be called.
class SeenMemory {
 public:
  void use(MemoryView* view) { view_ = view; }
  bool is_used() const { return view_ != nullptr; }
  MemoryView& view() { return *view_; }

  // With `block`, which may be null, accesses go where it says.
  void use(BlockMemory* block) { block_ = block; }
  bool is_apart() const { return block_ != nullptr; }
  // Returns where an access goes whose place in memory is `at`.
  std::byte* place(Address address, std::byte* at, uint32_t bytes, isa::Effect effect) {
    return block_ ? block_->place(address, at, bytes, effect) : at;
  }
  // Notes a read from the allocation of an address, which is going to be read from memory itself.
  void read_as_it_is(Address address) {
    if (block_) block_->read_as_it_is(address);
  }

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
  BlockMemory* block_ = nullptr;
  bool is_late_ = false;
};

}  // namespace glint::exec
