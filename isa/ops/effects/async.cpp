// Defines asynchronous copies from global to shared memory and barriers in shared memory. The machine does
// all the work.
// SPDX-License-Identifier: Apache-2.0
#include "isa/async_copy.h"
#include "isa/mbarrier.h"
#include "isa/op_makers.h"
#include "isa/ops/addresses.h"
#include "isa/ops/families.h"

namespace glint::isa::GLINT_ISA_PATH {
namespace {

// The operands are the shared address, the global address, and how many bytes come from there; zeros fill the
// rest.
constexpr OpRow copy(std::string_view name, uint8_t words, std::string_view doc) {
  OpRow row = effect_op(name, Class::Mem, Unit::Lsu, Effect::Copy, {Src32, Address64, Src32}, doc);
  row.memory = {Space::Global, 4, words, false};
  row.run = &form_addresses<uint64_t, 1>;
  return row;
}
constexpr OpRow group(std::string_view name, CopyGroupKind kind, Operands operands, std::string_view doc) {
  OpRow row = effect_op(name, Class::Ctrl, Unit::Barrier, Effect::CopyGroup, operands, doc);
  row.detail = uint16_t(kind);
  return row;
}
constexpr OpRow barrier(std::string_view name, MbarrierKind kind, Operands operands, std::string_view doc) {
  OpRow row = effect_op(name, Class::Mem, Unit::Lsu, Effect::Mbarrier, operands, doc);
  row.memory = {Space::Shared, 8, 1, false};
  row.detail = uint16_t(kind);
  row.run = is_destination(operands.kind[0]) ? &form_addresses<uint32_t, 1> : &form_addresses<uint32_t, 0>;
  return row;
}

constexpr OpRow kRows[] = {
    copy("cp.async.b32", 1, "Copies 4 bytes from global to shared memory while the warp goes on."),
    copy("cp.async.b64", 2, "Copies 8 bytes from global to shared memory while the warp goes on."),
    copy("cp.async.b128", 4, "Copies 16 bytes from global to shared memory while the warp goes on."),
    group("cp.async.commit_group", CopyGroupKind::Commit, {},
          "Makes one group of the copies that have begun since the last one."),
    group("cp.async.wait_group", CopyGroupKind::Wait, {Src32},
          "Waits until at most that many groups of copies are under way, the youngest ones."),
    barrier("mbarrier.init.shared.b64", MbarrierKind::Init, {Address32, Src32},
            "Makes a barrier of 8 bytes whose phases end with that many arrivals."),
    barrier("mbarrier.inval.shared.b64", MbarrierKind::Inval, {Address32},
            "Ends the use of 8 bytes as a barrier."),
    barrier("mbarrier.arrive.shared.b64", MbarrierKind::Arrive, {Dst64, Address32, Src32},
            "Arrives that many times at a barrier, and returns what it held before."),
    barrier(
        "mbarrier.arrive_drop.shared.b64", MbarrierKind::ArriveDrop, {Dst64, Address32, Src32},
        "Arrives that many times at a barrier, which expects as many fewer from then on, and returns what it "
        "held before."),
    barrier("mbarrier.test_wait.shared.b64", MbarrierKind::TestWait, {DstPred, Address32, Src64},
            "Tells whether the phase has ended in which an arrival returned the second operand."),
    barrier("mbarrier.test_wait.parity.shared.b64", MbarrierKind::TestWait, {DstPred, Address32, Src32},
            "Tells whether the phase with the parity of the second operand has ended."),
    barrier(
        "mbarrier.try_wait.shared.b64", MbarrierKind::TryWait, {DstPred, Address32, Src64},
        "Waits for some time until the phase has ended in which an arrival returned the second operand, and "
        "tells whether it has."),
    barrier("mbarrier.try_wait.parity.shared.b64", MbarrierKind::TryWait, {DstPred, Address32, Src32},
            "Waits for some time until the phase with the parity of the second operand has ended, and tells "
            "whether it has."),
    barrier(
        "cp.async.mbarrier.arrive.shared.b64", MbarrierKind::CopyArrive, {Address32},
        "Lets a barrier wait for one arrival more, which comes when the thread's earlier copies are done."),
    barrier("cp.async.mbarrier.arrive.noinc.shared.b64", MbarrierKind::CopyArriveNoInc, {Address32},
            "Arrives at a barrier when the thread's earlier copies are done."),
};

}  // namespace

RowList async_rows() {
  return {kRows, std::size(kRows)};
}

}  // namespace glint::isa::GLINT_ISA_PATH
