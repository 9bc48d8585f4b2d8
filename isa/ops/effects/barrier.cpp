// Defines waiting for the other warps of the block, and ordering of memory accesses. The machine does all the
// work.
// SPDX-License-Identifier: Apache-2.0
#include "isa/barrier.h"

#include "isa/op_makers.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

constexpr OpRow barrier(std::string_view name, BarrierKind kind, Operands operands, std::string_view doc) {
  OpRow row = effect_op(name, Class::Ctrl, Unit::Barrier, Effect::Barrier, operands, doc);
  row.detail = uint16_t(kind);
  return row;
}
constexpr OpRow fence(std::string_view name, FenceScope scope, Operands operands, std::string_view doc) {
  OpRow row = effect_op(name, Class::Ctrl, Unit::Barrier, Effect::Fence, operands, doc);
  row.detail = uint16_t(scope);
  return row;
}

// The operands are the barrier (0 to 15) and how many threads it waits for: a multiple of 32, or 0 for all
// threads of the block that have not ended. A warp counts as 32 threads.
constexpr OpRow kRows[] = {
    barrier("bar.sync", BarrierKind::Sync, {Src32, Src32},
            "Waits at a barrier until that many threads have arrived (0: all threads that have not ended)."),
    barrier("bar.arrive", BarrierKind::Arrive, {Src32, Src32},
            "Arrives at a barrier for that many threads, and continues."),
    barrier("bar.red.popc.u32", BarrierKind::Count, {Dst32, Src32, Src32, SrcPred},
            "Waits as bar.sync does, and counts the threads whose predicate is true."),
    barrier("bar.red.and.pred", BarrierKind::And, {DstPred, Src32, Src32, SrcPred},
            "Waits as bar.sync does, and tells whether the predicates of all threads are true."),
    barrier("bar.red.or.pred", BarrierKind::Or, {DstPred, Src32, Src32, SrcPred},
            "Waits as bar.sync does, and tells whether the predicate of any thread is true."),
    fence("bar.warp.sync", FenceScope::Warp, {Src32},
          "Orders the memory accesses of the lanes of a mask, which have met already where their paths "
          "joined."),
    fence("membar.cta", FenceScope::Block, {},
          "Orders memory accesses as the threads of the block see them."),
    fence("membar.gl", FenceScope::Gpu, {}, "Orders memory accesses as all threads see them."),
    fence("membar.sys", FenceScope::System, {},
          "Orders memory accesses as all threads and the host see them."),
};

}  // namespace

RowList barrier_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
