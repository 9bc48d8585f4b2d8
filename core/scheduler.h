// Models one scheduler of a core: what each of its warps waits for, and which warps can issue.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "base/check.h"
#include "base/types.h"
#include "core/alarms.h"
#include "core/issue_scheduler.h"
#include "core/issue_table.h"
#include "core/lsu.h"
#include "core/operand_wheel.h"
#include "core/params.h"
#include "core/stall.h"
#include "rtunit/rt_port.h"

namespace glint::core {

// Says what the next instruction of a warp waits for, and where it goes.
struct NextIssue {
  Cycle ready_at = 0;            // cycle in which its operands are present; kNever: nobody knows it yet
  Stall wait = Stall::RawFixed;  // what the instruction waits for until then
  Pipe pipe = Pipe::Int;
  Door door = Door::None;
  const IssueRow* row = nullptr;  // null: it is the rest of a sequence
};

// Holds the units behind the doors, which say whether there is room.
struct Doors {
  const Lsu& lsu;
  const rt::RtPort& rt;
};

// Models the banks of a scheduler's registers, which have one read port each. An instruction reads its
// registers in a window of cycles that begins with its issue, one register per bank and cycle, after the
// instructions before it.
class RegisterBanks {
 public:
  using Reads = IssueTable::BankReads;
  // Returns the first cycle from `now` on in which an instruction that reads `reads` can issue.
  Cycle free_at(const Reads& reads, Cycle now, Cycle window) const {
    Cycle at = now;
    for (size_t bank = 0; bank < reads.size(); ++bank)
      if (reads[bank]) at = std::max(at, std::max<Cycle>(port_free_[bank] + reads[bank], window) - window);
    return at;
  }
  void read(const Reads& reads, Cycle now) {
    for (size_t bank = 0; bank < reads.size(); ++bank)
      if (reads[bank]) port_free_[bank] = std::max(port_free_[bank], now) + reads[bank];
  }

 private:
  std::array<Cycle, kMaxRegisterBanks> port_free_{};  // first cycle in which the bank's port is free
};

// Issues from its warps, which it numbers locally: warp slot w is warp w / schedulers of scheduler w mod
// schedulers. A scheduler sleeps while no warp can issue and its reason stays the same. Three things end the
// sleep: the cycle that it waits for comes, somebody tells of a change to one of its warps, or a door that it
// watches may have opened.
class Scheduler {
 public:
  // `slots` is the number of warp slots of the whole core. `alarms` outlives the scheduler.
  Scheduler(uint32_t index, uint32_t slots, const Params& params, Alarms& alarms);

  // These calls say what happens to warps. Each wakes the scheduler, except drain().
  void add(uint32_t warp, uint64_t age);
  void remove(uint32_t warp);
  void set_next(uint32_t warp, const NextIssue& next) {
    operands_.set(warp, next.ready_at);
    set_needs(warp, next);
    wake();
  }
  // Does the same for the warp that was picked last, whose next instruction cannot issue in this cycle.
  void go_on(uint32_t warp, const NextIssue& next) {
    operands_.put_back(warp, next.ready_at);
    set_needs(warp, next);
  }
  // Notes that the warp has ended and waits for its last accesses.
  void drain(uint32_t warp) {
    operands_.set(warp, kNever);
    set_wait(warp, Stall::Drain);
  }
  // Notes that the core has no warps. That is the reason of the scheduler's cycles from now on, and it
  // sleeps.
  void become_empty() {
    reason_ = Stall::NoWarp;
    alarms_.sleep(index_, kNever);
    watch_nothing();
  }

  // Returns whether a door that the scheduler watches may have opened.
  bool sees_open_door(const Doors& doors) const {
    return (watches_rt_ && doors.rt.can_accept()) ||
           (watches_lsu_ && lsu_vacated_ != doors.lsu.num_vacated());
  }
  // Returns the warps that can issue now, as bits. When no bit is set, reason() says why, and the scheduler
  // sleeps.
  uint64_t find_ready(Cycle now, const Doors& doors) {
    operands_.advance(now);
    const uint64_t operands = resident_ & ~operands_.missing();
    const uint64_t piped = leave_out_busy_pipes(operands, now);
    uint64_t ready = piped;
    if (alarms_.watching() >> index_ & 1) [[unlikely]]
      watch_nothing();
    if (ready & ~needs_door_[size_t(Door::None)]) ready = leave_out_full_doors(ready, doors);
    if (!ready || may_hold_back_)
      find_reason(resident_ & operands_.missing(), operands & ~piped, piped & ~ready);
    return ready;
  }
  // Holds back warps of `ready` whose register reads meet those of earlier instructions until `next`.
  void hold_for_banks(Cycle next) {
    reason_ = std::min(reason_, Stall::RegisterBanks);
    alarms_.sleep_less(index_, next);
  }
  // Returns whether hold_for_banks() or leave_out_held() may keep ready warps from issuing, or a SubwarpUnit
  // looks at the warps that are not.
  bool may_hold_back() const { return may_hold_back_; }
  // Returns those warps of `ready`, which is not 0, that the policy lets issue.
  uint64_t leave_out_held(uint64_t ready, Cycle now);
  // Chooses one warp of `ready`, which is not 0. The cycle is spent on issuing.
  uint32_t pick(uint64_t ready, Cycle now, const Doors& doors) {
    IssueView view{ready, {age_.data(), age_.size()}, now, {}};
    if (needs_rt_) [[unlikely]]
      view.rt = {resident_ & needs_door_[size_t(Door::RtUnit)], doors.rt.can_accept()};
    const uint32_t warp = policy_->pick(view);
    GLINT_DCHECK(ready >> warp & 1, "the issue policy chose warp {}, which is not ready", warp);
    reason_ = Stall::Issued;
    wake();
    return warp;
  }

  // Issues an instruction to a pipe. Returns by how many cycles it enters the pipe later. That is 0 without
  // latches. With latches the instruction enters when the pipe has finished the one before, and the next
  // instruction can issue as soon as this one has entered.
  Cycle occupy(Pipe at, Cycle now, Cycle parts) {
    constexpr Cycle kParts = OpTime::kParts;
    if (!has_latches_) return take(at, now, parts), 0;
    Cycle& busy = pipe_busy_[size_t(at)];
    const Cycle start = std::max(busy, now * kParts);
    busy = start + parts;
    pipe_free_[size_t(at)] = start / kParts + 1;
    return start / kParts - now;
  }
  // Sends an instruction to a pipe that is free. Intervals that are not a whole number of cycles are kept on
  // average: an interval begins where the last one ended, within the cycle, if the pipe has not been idle
  // since.
  void take(Pipe at, Cycle now, Cycle parts) {
    constexpr Cycle kParts = OpTime::kParts;
    Cycle& busy = pipe_busy_[size_t(at)];
    // There is no branch, because whether the pipe was busy until now cannot be foreseen.
    const Cycle idle = now * kParts, was_busy = Cycle{0} - Cycle{pipe_free_[size_t(at)] == now};
    busy = idle - ((idle - busy) & was_busy) + parts;
    pipe_free_[size_t(at)] = (busy + kParts - 1) / kParts;
  }

  uint32_t index() const { return index_; }
  uint64_t resident() const { return resident_; }
  // Returns the warps whose next instruction waits for a load or an atomic.
  uint64_t waiting_for_memory() const {
    uint64_t waiting = 0;
    for (size_t s = 0; s < waits_.size(); ++s)
      if (waits_for_memory(Stall(s))) waiting |= waits_[s];
    return waiting & resident_ & operands_.missing();
  }
  L1Listener* l1_listener() { return policy_->l1_listener(); }
  Stall reason() const { return reason_; }  // what the scheduler's cycles are spent on
  bool is_resident(uint32_t warp) const { return resident_ >> warp & 1; }
  // Returns the number of cycles before `until` that no call has returned yet. All of them have reason().
  Cycle take_unaccounted(Cycle until) { return until - std::exchange(accounted_until_, until); }
  NextIssue next_of(uint32_t warp) const;
  // Returns NextIssue::row of the warp.
  const IssueRow* row_of(uint32_t warp) const { return needs_[warp].row; }
  // Returns the warp whose wait gave the scheduler its reason: the one that can go on first, or the oldest of
  // several. Returns none when the scheduler has no warps.
  std::optional<uint32_t> to_blame(Cycle now, const Doors& doors) const;

  RegisterBanks banks;

 private:
  void wake() { alarms_.wake(index_); }
  void watch_nothing() {
    watches_rt_ = watches_lsu_ = false;
    alarms_.watch_nothing(index_);
  }
  void set_wait(uint32_t warp, Stall wait) {
    waits_[size_t(needs_[warp].wait)] &= ~(uint64_t{1} << warp);
    waits_[size_t(wait)] |= uint64_t{1} << warp;
    needs_[warp].wait = wait;
  }
  // Notes where the warp's next instruction goes, and what it waits for.
  void set_needs(uint32_t warp, const NextIssue& next) {
    const uint64_t bit = uint64_t{1} << warp;
    Needs& needs = needs_[warp];
    needs.row = next.row;
    set_wait(warp, next.wait);
    needs_pipe_[size_t(needs.pipe)] &= ~bit;
    needs_pipe_[size_t(next.pipe)] |= bit;
    needs.pipe = next.pipe;
    if (needs.door != next.door) [[unlikely]] {
      needs_door_[size_t(needs.door)] &= ~bit;
      needs_door_[size_t(next.door)] |= bit;
      needs.door = next.door;
    }
  }
  // There is no branch, because which pipes are busy cannot be foreseen.
  uint64_t leave_out_busy_pipes(uint64_t ready, Cycle now) const {
    uint64_t busy = 0;
    for (size_t pipe = 0; pipe < size_t(kNumTimedPipes); ++pipe)
      busy |= needs_pipe_[pipe] & (uint64_t{0} - uint64_t{pipe_free_[pipe] > now});
    return ready & ~busy;
  }
  uint64_t leave_out_full_doors(uint64_t ready, const Doors& doors);
  void find_reason(uint64_t waiting, uint64_t at_pipes, uint64_t at_doors);
  Stall reason_of(uint32_t warp, Cycle now, const Doors& doors) const;

  // Holds what the next instruction of a warp needs besides its operands (NextIssue).
  struct Needs {
    const IssueRow* row = nullptr;
    Stall wait = Stall::RawFixed;
    Pipe pipe = Pipe::Int;
    Door door = Door::None;
  };

  // find_ready() reads most of these members in almost every cycle of a core, so the smallest come first and
  // lie together. Some fields of the warps are bits of several words, where bit i stands for warp i.
  const uint32_t index_;
  // These are the doors that were full. The second stands for both queues of the load-store unit.
  bool watches_rt_ = false, watches_lsu_ = false;
  Stall reason_ = Stall::NoWarp;
  const bool has_latches_;      // Params::dispatch_latch
  bool may_hold_back_ = false;  // may_hold_back()
  Alarms& alarms_;
  std::unique_ptr<IssueScheduler> policy_;
  const bool needs_rt_;      // IssueScheduler::needs_rt()
  const bool policy_holds_;  // IssueScheduler::holds_back()
  uint64_t resident_ = 0;    // the warps that hold their slots
  Cycle accounted_until_ = 0;
  uint64_t lsu_vacated_ = 0;                      // Lsu::num_vacated() when the doors were looked at
  std::array<uint64_t, kNumDoors> needs_door_{};  // by door: the warps that enter it next
  std::array<uint64_t, kNumPipes> needs_pipe_{};  // by pipe: the warps that issue to it next
  std::array<Cycle, kNumPipes> pipe_free_{};  // first cycle in which another instruction can go to the pipe
  std::array<Cycle, kNumPipes> pipe_busy_{};  // end of the pipe's work, in parts of a cycle
  std::array<uint64_t, size_t(Stall::Count)> waits_{};  // by reason: the warps that wait for that
  OperandWheel operands_;                               // when the operands of each warp come
  std::array<Needs, kMaxWarpsPerScheduler> needs_{};
  std::array<uint64_t, kMaxWarpsPerScheduler> age_{};  // launch number of each warp
};

}  // namespace glint::core
