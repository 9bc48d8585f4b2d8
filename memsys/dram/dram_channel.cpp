// Issues each command of a DRAM channel in the first clock that its timing allows, and notes what the command
// forbids.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/dram/dram_channel.h"

#include <algorithm>
#include <array>
#include <bit>

namespace glint::mem {
namespace {

DramClock first_refresh(DramClock interval, double phase) {
  if (interval == kNever) return kNever;
  return std::max<DramClock>(1, DramClock(double(interval) * phase));
}

}  // namespace

DramChannel::DramChannel(const Context& context)
    : DramModel(context, DramTiming(context.params).data),
      timing_(context.params),
      map_(context.params.banks, context.params.bank_groups, context.params.row_bytes, context.interleave),
      dual_command_bus_(context.params.dual_command_bus),
      scheduler_(context.params.scheduler.make({context.params.banks, context.params.queue})),
      slots_(context.params.queue),  // a request keeps its slot until its column command
      banks_(context.params.banks),
      group_gates_(context.params.bank_groups),
      group_turned_(context.params.bank_groups),
      refresh_due_(first_refresh(timing_.refresh_interval, context.refresh_phase)) {
  for (uint32_t bank = 0; bank < banks_.size(); ++bank)
    bank_group_.push_back(uint8_t(bank % group_gates_.size()));
  for (uint32_t slot = 0; slot < slots_.size(); ++slot) free_.push_back(uint32_t(slots_.size()) - 1 - slot);
}

void DramChannel::add(Cycle now, Address line, uint8_t sectors, Address local, bool write) {
  const uint32_t slot = free_.back();
  free_.pop_back();
  ++in_flight_;
  const DramLocation at = map_.locate(local);
  const DramClock arrival = clocks_.clock_at(now) + 1;
  slots_[slot] = {{at.bank, at.row, next_age_++, write}, arrival, line, sectors};
  scheduler_->add(slot, slots_[slot].request);
  ++banks_[at.bank].queued;
  waiting_banks_ |= uint64_t{1} << at.bank;
  ++stats_.requests;
  next_step_ = std::min(next_step_, arrival);
}

void DramChannel::advance(Cycle now) {
  const DramClock last = clocks_.clock_at(now);
  while (next_step_ <= last) step(next_step_);
}

void DramChannel::finish(Cycle end) {
  advance(end);
  refresh_up_to(clocks_.clock_at(end));
  account(clocks_.clock_at(end));
}

std::vector<uint32_t> DramChannel::open_rows() const {
  std::vector<uint32_t> rows;
  for (const Bank& bank : banks_) rows.push_back(bank.row);
  return rows;
}

void DramChannel::open_rows(const std::vector<uint32_t>& rows) {
  for (size_t bank = 0; bank < banks_.size(); ++bank) banks_[bank].row = rows[bank];
}

void DramChannel::step(DramClock now) {
  const bool refreshed = refresh_up_to(now);
  account(now);
  if (pick_all() || refreshed) plan_from(now);
  if (plan_.at == now) {
    const Plan plan = plan_;
    if (plan.column != kNone) issue_column(plan.column, now);
    if (plan.row != kNone && (plan.column == kNone || dual_command_bus_)) issue_row(plan.row, now);
    if (plan.column != kNone) pick_all();  // the bank is free for another request
    plan_from(now + 1);
  }
  // A channel without requests catches up on refreshes in its next step, because nothing can see them.
  next_step_ = busy_banks_ ? std::min(plan_.at, refresh_due_) : plan_.at;
}

// Gives requests to free banks. Returns whether any bank got one. Only a free bank or a new request changes
// the answers of pick().
bool DramChannel::pick_all() {
  bool any = false;
  for (bool again = true; again;) {  // a pick may allow one for a bank that was asked before (fcfs)
    again = false;
    for (uint64_t rest = waiting_banks_ & ~busy_banks_; rest; rest &= rest - 1)
      pick_for(uint32_t(std::countr_zero(rest)), again);
    any |= again;
    again = again && (waiting_banks_ & ~busy_banks_);
  }
  return any;
}

void DramChannel::pick_for(uint32_t index, bool& any) {
  Bank& bank = banks_[index];
  const uint32_t slot = scheduler_->pick(index, bank.row);
  if (slot == kNone) return;
  any = true;
  bank.current = slot;
  bank.age = slots_[slot].request.age;
  bank.next = next_command_of(bank);
  busy_banks_ |= uint64_t{1} << index;
  if (--bank.queued == 0) waiting_banks_ &= ~(uint64_t{1} << index);
  ++stats_.picks;
  if (bank.row == slots_[slot].request.row) ++stats_.row_hits;
}

DramChannel::Command DramChannel::next_command_of(const Bank& bank) const {
  const DramRequest& request = slots_[bank.current].request;
  if (bank.row == kClosed) return Activate;
  if (bank.row != request.row) return Precharge;
  return request.write ? Write : Read;
}

// Finds the first clock, not before `first`, in which a command can go out.
void DramChannel::plan_from(DramClock first) {
  plan_ = {};
  // Which bank comes first cannot be foreseen, so the first loops have no branch for it.
  std::array<DramClock, 64> at;
  for (uint64_t rest = busy_banks_; rest; rest &= rest - 1) {
    const uint32_t index = uint32_t(std::countr_zero(rest));
    const Bank& bank = banks_[index];
    const DramClock shared =
        std::max(group_gates_[bank_group_[index]].at[bank.next], channel_gates_.at[bank.next]);
    at[index] = std::max(std::max(bank.gates.at[bank.next], shared), first);
    plan_.at = std::min(plan_.at, at[index]);
  }
  uint64_t ready = 0;
  for (uint64_t rest = busy_banks_; rest; rest &= rest - 1) {
    const uint32_t index = uint32_t(std::countr_zero(rest));
    ready |= uint64_t{at[index] == plan_.at} << index;
  }
  for (; ready; ready &= ready - 1) {
    const uint32_t index = uint32_t(std::countr_zero(ready));
    uint32_t& best = banks_[index].next >= Read ? plan_.column : plan_.row;
    if (best == kNone || banks_[index].age < banks_[best].age) best = index;
  }
}

void DramChannel::issue_column(uint32_t index, DramClock now) {
  Bank& bank = banks_[index];
  Gates& group = group_gates_[bank_group_[index]];
  const Slot& slot = slots_[bank.current];
  const DramTiming& t = timing_;
  const bool write = slot.request.write;
  for (const Command column : {Read, Write}) {
    group.raise(column, now + t.ccd_l);
    channel_gates_.raise(column, now + t.ccd_s);
  }
  run_timers_until(now + t.ccd_s);
  if (write) {
    const DramClock data_end = now + t.wl + t.data;
    group.raise(Read, data_end + t.wtr_l);
    channel_gates_.raise(Read, data_end + t.wtr_s);
    group_turned_[bank_group_[index]] = data_end + t.wtr_l;
    turned_[0] = data_end + t.wtr_s;
    bank.gates.raise(Precharge, data_end + t.wr);
    run_timers_until(data_end + t.wtr_s);
    ++stats_.writes;
  } else {
    channel_gates_.raise(Write, now + t.rtw);
    turned_[1] = now + t.rtw;
    bank.gates.raise(Precharge, now + t.rtp);
    run_timers_until(now + t.rtw);
    returns_.push(
        {clocks_.cycle_after(now + t.cl + t.data), slot.line, slot.sectors, clocks_.cycle_after(now)});
    ++stats_.reads;
  }
  if (stats_.reads.value() + stats_.writes.value() > 1 && write != last_was_write_) ++stats_.turnarounds;
  last_was_write_ = write;
  // As in GPGPU-Sim, the transfer counts from its command on. That is CL or WL too early and changes no sum.
  data_until_ = now + t.data;
  stats_.busy_clocks += t.data;
  stats_.queue_clocks += now - slot.arrival;
  stats_.queue_latency.add(now - slot.arrival);
  free_.push_back(bank.current);
  --in_flight_;
  bank.current = kNone;
  busy_banks_ &= ~(uint64_t{1} << index);
}

void DramChannel::issue_row(uint32_t index, DramClock now) {
  Bank& bank = banks_[index];
  const DramTiming& t = timing_;
  if (bank.next == Precharge) {
    bank.row = kClosed;
    bank.next = Activate;
    bank.gates.raise(Activate, now + t.rp);
    run_timers_until(now + t.rp);
    ++stats_.precharges;
    return;
  }
  bank.row = slots_[bank.current].request.row;
  bank.next = next_command_of(bank);
  bank.gates.raise(Read, now + t.rcd);
  bank.gates.raise(Write, now + t.rcd_write);
  bank.gates.raise(Precharge, now + t.ras);
  bank.gates.raise(Activate, now + t.rc);
  group_gates_[bank_group_[index]].raise(Activate, now + t.rrd_l);
  channel_gates_.raise(Activate, now + t.rrd_s);
  if (t.activate > 1) {
    channel_gates_.raise(Activate, now + t.activate);
    channel_gates_.raise(Precharge, now + t.activate);
    if (!dual_command_bus_)
      channel_gates_.raise(Read, now + t.activate), channel_gates_.raise(Write, now + t.activate);
  }
  last_activates_[num_activates_++ % 4] = now;
  if (num_activates_ >= 4) channel_gates_.raise(Activate, last_activates_[num_activates_ % 4] + t.faw);
  run_timers_until(now + std::max({t.rc, t.ras, t.rcd}));
  ++stats_.activates;
}

// Counts the clocks [accounted_, until) by reason. After the first of them no command goes out, no bank takes
// or ends a request and no refresh falls due.
void DramChannel::account(DramClock until) {
  if (until <= accounted_) return;
  const DramClock length = until - accounted_;
  const DramClock data = std::clamp(data_until_, accounted_, until) - accounted_;
  stats_.use.add(DramUse::Data, data);
  stats_.clocks += length;
  if (busy_banks_) {
    account_waiting(accounted_ + data, until);
    stats_.active_clocks += length;
    stats_.any_bank_clocks += length;
    stats_.bank_clocks += length * uint64_t(std::popcount(busy_banks_));
  } else {
    stats_.use.add(DramUse::Idle, length - data);
    stats_.active_clocks += std::clamp(timers_until_, accounted_, until) - accounted_;
  }
  accounted_ = until;
}

// Counts the clocks [from, until), in which some bank has a request and the bus carries no data, by reason.
void DramChannel::account_waiting(DramClock from, DramClock until) {
  if (from == until) return;
  DramClock turned = kNever, refreshed = kNever;
  bool open = false;
  for (uint64_t rest = busy_banks_; rest; rest &= rest - 1) {
    const uint32_t index = uint32_t(std::countr_zero(rest));
    if (banks_[index].next >= Read) {
      open = true;
      turned = std::min(turned, turned_at(index));
      if (turned <= from) break;
    } else {
      refreshed = std::min(refreshed, banks_[index].refresh_until);
    }
  }
  const DramClock special = std::clamp(open ? turned : refreshed, from, until) - from;
  if (special) stats_.use.add(open ? DramUse::Turnaround : DramUse::Refresh, special);
  stats_.use.add(open ? DramUse::ColumnWait : DramUse::RowWait, until - from - special);
}

// Returns when the bus has turned for the column command of the bank's request.
DramClock DramChannel::turned_at(uint32_t index) const {
  if (banks_[index].next == Write) return turned_[1];
  return std::max(turned_[0], group_turned_[bank_group_[index]]);
}

// Does the refreshes that have fallen due. Returns whether there was one.
bool DramChannel::refresh_up_to(DramClock now) {
  if (refresh_due_ > now) return false;
  for (; refresh_due_ <= now; refresh_due_ += timing_.refresh_interval) {
    account(refresh_due_);
    refresh(refresh_due_);
  }
  return true;
}

void DramChannel::refresh(DramClock due) {
  ++stats_.refreshes;
  if (timing_.refresh_per_bank) {
    Bank& bank = banks_[refresh_next_];
    refresh_next_ = refresh_next_ + 1 == banks_.size() ? 0 : refresh_next_ + 1;
    refresh_bank(bank, closed_at(bank, due) + timing_.refresh_time);
    return;
  }
  // One command closes all rows, so the bank that may be closed last holds up the others.
  DramClock precharge = 0, start = due;
  for (const Bank& bank : banks_) {
    start = std::max(start, bank.gates.at[Activate]);
    if (bank.row != kClosed) precharge = std::max({precharge, due, bank.gates.at[Precharge]});
  }
  if (precharge) start = std::max(start, precharge + timing_.rp);
  for (Bank& bank : banks_) refresh_bank(bank, start + timing_.refresh_time);
}

// Returns the first clock, from `due` on, in which the bank can be refreshed: its row is closed, and a row
// could be opened as well.
DramClock DramChannel::closed_at(const Bank& bank, DramClock due) const {
  const DramClock closed = bank.row == kClosed ? due : std::max(due, bank.gates.at[Precharge]) + timing_.rp;
  return std::max(closed, bank.gates.at[Activate]);
}

void DramChannel::refresh_bank(Bank& bank, DramClock until) {
  bank.row = kClosed;
  bank.gates.raise(Activate, until);
  bank.refresh_until = until;
  if (bank.current == kNone) return;
  if (bank.next >= Read) ++stats_.reopened;
  bank.next = Activate;
}

}  // namespace glint::mem
