// DRAM commands: which one goes out at which clock, and what that forbids afterwards.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/dram_channel.h"

#include <algorithm>
#include <bit>

namespace glint::mem {

DramStats::DramStats(stats::Group* parent) : group(parent, "dram") {}

DramChannel::DramChannel(const DramParams& params, uint32_t interleave, double core_mhz, stats::Group* parent)
    : timing_(params),
      clocks_(core_mhz, params.clock_mhz),
      map_(params.banks, params.bank_groups, params.row_bytes, interleave),
      groups_(params.bank_groups),
      dual_command_bus_(params.dual_command_bus),
      stats_(parent),
      scheduler_(params.scheduler.make({params.banks, params.queue})),
      slots_(params.queue),  // a request keeps its place until its column command
      banks_(params.banks),
      group_gates_(params.bank_groups) {
  for (uint32_t slot = 0; slot < slots_.size(); ++slot) free_.push_back(uint32_t(slots_.size()) - 1 - slot);
}

void DramChannel::add(Cycle now, Address line, uint8_t sectors, Address local, bool write) {
  const uint32_t slot = free_.back();
  free_.pop_back();
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
  account(clocks_.clock_at(end));
}

void DramChannel::step(DramClock now) {
  account(now);
  pick_all();

  uint32_t column = kNone, row = kNone;  // the oldest ready command of each kind
  for (uint64_t rest = busy_banks_; rest; rest &= rest - 1) {
    const uint32_t bank = uint32_t(std::countr_zero(rest));
    if (earliest(bank) > now) continue;
    uint32_t& best = row_open(banks_[bank]) ? column : row;
    if (best == kNone || slots_[banks_[bank].current].request.age < slots_[banks_[best].current].request.age) best = bank;
  }
  if (column != kNone) issue_column(column, now);
  const bool bus_free = column == kNone || dual_command_bus_;
  if (row != kNone && bus_free) issue_row(row, now);

  // Only a bank set free by a column command, or an answer to another bank, changes what pick() says.
  if (column != kNone) pick_all();
  next_step_ = kNever;
  for (uint64_t rest = busy_banks_; rest; rest &= rest - 1)
    next_step_ = std::min(next_step_, earliest(uint32_t(std::countr_zero(rest))));
  if (next_step_ != kNever) next_step_ = std::max(next_step_, now + 1);
}

bool DramChannel::pick_for(uint32_t index) {
  Bank& bank = banks_[index];
  const uint32_t slot = scheduler_->pick(index, bank.row);
  if (slot == kNone) return false;
  bank.current = slot;
  busy_banks_ |= uint64_t{1} << index;
  if (--bank.queued == 0) waiting_banks_ &= ~(uint64_t{1} << index);
  ++stats_.picks;
  if (bank.row == slots_[slot].request.row) ++stats_.row_hits;
  return true;
}

void DramChannel::pick_all() {
  for (bool again = true; again;) {  // an answer may make way for a bank that was asked before (fcfs)
    again = false;
    for (uint64_t rest = waiting_banks_ & ~busy_banks_; rest; rest &= rest - 1)
      again |= pick_for(uint32_t(std::countr_zero(rest)));
    again = again && (waiting_banks_ & ~busy_banks_);
  }
}

// When the next command of the bank's request may go out: a column command, an activate or a precharge.
DramClock DramChannel::earliest(uint32_t index) const {
  const Bank& bank = banks_[index];
  const Gates& group = group_gates_[index % groups_];
  if (row_open(bank)) {
    if (slots_[bank.current].request.write)
      return std::max({bank.gates.write, group.write, channel_gates_.write});
    return std::max({bank.gates.read, group.read, channel_gates_.read});
  }
  if (bank.row != kClosed) return bank.gates.precharge;
  const DramClock faw = num_activates_ < 4 ? 0 : last_activates_[num_activates_ % 4] + timing_.faw;
  return std::max({bank.gates.activate, group.activate, channel_gates_.activate, faw});
}

void DramChannel::issue_column(uint32_t index, DramClock now) {
  Bank& bank = banks_[index];
  Gates& group = group_gates_[index % groups_];
  const Slot& slot = slots_[bank.current];
  const bool write = slot.request.write;
  const DramTiming& t = timing_;
  const auto raise = [](DramClock& gate, DramClock to) { gate = std::max(gate, to); };
  raise(group.read, now + t.ccd_l), raise(channel_gates_.read, now + t.ccd_s);
  raise(group.write, now + t.ccd_l), raise(channel_gates_.write, now + t.ccd_s);
  if (write) {
    const DramClock data_end = now + t.wl + t.data;
    raise(group.read, data_end + t.wtr_l), raise(channel_gates_.read, data_end + t.wtr_s);
    raise(bank.gates.precharge, data_end + t.wr);
    run_timers_until(data_end + t.wtr_s);
    ++stats_.writes;
  } else {
    raise(channel_gates_.write, now + t.rtw);
    raise(bank.gates.precharge, now + t.rtp);
    run_timers_until(now + t.rtw);
    returns_.push({clocks_.cycle_after(now + t.cl + t.data), slot.line, slot.sectors});
    ++stats_.reads;
  }
  if (stats_.reads.value() + stats_.writes.value() > 1 && write != last_was_write_) ++stats_.turnarounds;
  last_was_write_ = write;
  run_timers_until(now + t.ccd_s);
  // Like GPGPU-Sim, the transfer counts from its command on; that is CL or WL early and changes no sum.
  data_until_ = now + t.data;
  stats_.busy_clocks += t.data;
  stats_.queue_clocks += now - slot.arrival;
  stats_.queue_latency.add(now - slot.arrival);
  free_.push_back(bank.current);
  bank.current = kNone;
  busy_banks_ &= ~(uint64_t{1} << index);
}

void DramChannel::issue_row(uint32_t index, DramClock now) {
  Bank& bank = banks_[index];
  const DramTiming& t = timing_;
  const auto raise = [](DramClock& gate, DramClock to) { gate = std::max(gate, to); };
  if (bank.row != kClosed) {
    bank.row = kClosed;
    raise(bank.gates.activate, now + t.rp);
    run_timers_until(now + t.rp);
    ++stats_.precharges;
    return;
  }
  bank.row = slots_[bank.current].request.row;
  bank.gates.read = now + t.rcd;
  bank.gates.write = now + t.rcd_write;
  raise(bank.gates.precharge, now + t.ras);
  raise(bank.gates.activate, now + t.rc);
  raise(group_gates_[index % groups_].activate, now + t.rrd_l);
  raise(channel_gates_.activate, now + t.rrd_s);
  last_activates_[num_activates_++ % 4] = now;
  run_timers_until(now + std::max({t.rc, t.ras, t.rcd}));
  ++stats_.activates;
}

// Attributes the clocks [accounted_, until), in which no command went out after the first and no bank changed hands.
void DramChannel::account(DramClock until) {
  if (until <= accounted_) return;
  const DramClock length = until - accounted_;
  const DramClock data = std::clamp(data_until_, accounted_, until) - accounted_;
  bool open = false;
  for (uint64_t rest = busy_banks_; rest; rest &= rest - 1) open |= row_open(banks_[std::countr_zero(rest)]);
  const DramUse waiting = open ? DramUse::ColumnWait : busy_banks_ ? DramUse::RowWait : DramUse::Idle;
  stats_.use.add(DramUse::Data, data);
  stats_.use.add(waiting, length - data);
  stats_.clocks += length;
  if (busy_banks_) {
    stats_.active_clocks += length;
    stats_.any_bank_clocks += length;
    stats_.bank_clocks += length * uint64_t(std::popcount(busy_banks_));
  } else {
    stats_.active_clocks += std::clamp(timers_until_, accounted_, until) - accounted_;
  }
  accounted_ = until;
}

}  // namespace glint::mem
