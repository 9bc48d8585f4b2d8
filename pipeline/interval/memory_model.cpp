// Passes accesses through tags, bandwidths and banks.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/interval/memory_model.h"

#include <bit>

#include "memsys/messages/packet.h"

namespace glint::pipeline {
namespace {

uint32_t count(uint8_t sectors) {
  return uint32_t(std::popcount(sectors));
}
double packet_cycles(uint32_t sectors, uint32_t bytes_per_cycle) {
  return double(mem::kHeaderBytes + sectors * mem::kSectorBytes) / bytes_per_cycle;
}

void empty(mem::TagArray& tags) {
  for (uint32_t slot = 0; slot < tags.num_lines(); ++slot)
    if (tags.line(slot).used()) tags.drop(slot, 0xff);
}

template <class List, class Work>
double most(const List& list, Work work) {
  double out = 0;
  for (const auto& one : list) out = std::max(out, work(one));
  return out;
}

}  // namespace

MemoryModel::Cache::Cache(const mem::CacheShape& shape, const PolicyChoice<mem::Replacement>& replacement)
    : tags(shape, replacement), fills(size_t{shape.sets} * shape.ways) {
}

MemoryModel::MemoryModel(const mem::Params& params, uint32_t num_cores, double core_mhz)
    : params_(params),
      timing_(params.dram),
      core_per_dram_(core_mhz / params.dram.clock_mhz),
      partitions_(params.dram.channels, params.l2.slices, params.interleave, mem::slice_hash(params.hash)),
      dram_map_(params.dram.banks, params.dram.bank_groups, params.dram.row_bytes, params.interleave) {
  for (uint32_t i = 0; i < num_cores; ++i)
    cores_.push_back(
        {Cache(mem::cache_shape(params.l1.size, params.l1.ways, params.line), params.l1.replacement),
         {},
         {},
         {}});
  for (uint32_t i = 0; i < params.num_slices(); ++i)
    slices_.push_back(
        {Cache(mem::cache_shape(params.l2.slice_size, params.l2.ways, params.line), params.l2.replacement),
         {},
         {}});
  for (uint32_t i = 0; i < params.dram.channels; ++i)
    channels_.push_back({std::vector<Bank>(params.dram.banks), {}});
}

// Returns the line, and makes it when it is absent. A line that it displaces is written to the level below if
// it is dirty.
mem::TagArray::Line& MemoryModel::line_of(Core& core, Address line, Cycle at) {
  mem::TagArray& tags = core.l1.tags;
  if (const uint32_t slot = tags.find(line); slot != mem::TagArray::kNone) {
    tags.touch(slot);
    return tags.line(slot);
  }
  if (const mem::TagArray::Line& victim = tags.victim(line); victim.dirty)
    write_below(core, victim.address(), victim.dirty, at);
  return tags.insert(line);
}

mem::TagArray::Line& MemoryModel::line_of(Slice& slice, uint32_t index, Address line, Cycle at) {
  mem::TagArray& tags = slice.l2.tags;
  if (const uint32_t slot = tags.find(line); slot != mem::TagArray::kNone) {
    tags.touch(slot);
    return tags.line(slot);
  }
  if (const mem::TagArray::Line& victim = tags.victim(line); victim.dirty) {
    dram_sectors_ += count(victim.dirty);
    channels_[partitions_.partition_of(index)].bus.take(
        at, count(victim.dirty) * double(timing_.data) * core_per_dram_);
  }
  return tags.insert(line);
}

Cycle MemoryModel::read(uint32_t core_index, Address line, uint8_t sectors, Cycle at, Asker asker) {
  Core& core = cores_[core_index];
  CacheCounts& counts = l1_counts_[size_t(asker)];
  ++counts.reads;
  const Cycle begin = core.port.take(at, 1.0 / params_.l1.ports);
  mem::TagArray::Line& found = line_of(core, line, begin);
  Fill& fill = core.l1.fills[core.l1.tags.slot_of(found)];
  const uint8_t missing = uint8_t(sectors & ~found.valid);
  if (found.valid == 0) fill = {};
  if (!missing) return std::max(begin + params_.l1.hit_latency, fill.ready_for(begin));
  ++counts.misses;
  found.valid |= missing;
  fill = {begin,
          std::max(fetch(core, line, missing, begin + params_.l1.miss_latency), fill.ready_for(begin))};
  return fill.ready;
}

Cycle MemoryModel::read_bytes(uint32_t core, Address at, uint32_t bytes, Cycle when, Asker asker) {
  Cycle ready = when;
  for (Address line = at / params_.line * params_.line; line < at + bytes; line += params_.line) {
    uint8_t sectors = 0;
    for (uint32_t i = 0; i < params_.line / mem::kSectorBytes; ++i) {
      const Address sector = line + i * mem::kSectorBytes;
      if (sector < at + bytes && sector + mem::kSectorBytes > at) sectors |= uint8_t(1u << i);
    }
    ready = std::max(ready, read(core, line, sectors, when, asker));
  }
  return ready;
}

Cycle MemoryModel::write(uint32_t core_index, Address line, uint8_t sectors, Cycle at, bool is_local) {
  Core& core = cores_[core_index];
  const Cycle begin = core.port.take(at, 1.0 / params_.l1.ports);
  if (is_local ? params_.l1.local_write_back : params_.l1.global_write_back) {
    mem::TagArray::Line& found = line_of(core, line, begin);
    if (found.valid == 0) core.l1.fills[core.l1.tags.slot_of(found)] = {};
    found.valid |= sectors;
    found.dirty |= sectors;
    return begin;
  }
  const uint32_t slot = core.l1.tags.find(line);
  if (slot != mem::TagArray::kNone && params_.l1.write_evict) core.l1.tags.drop(slot, sectors);
  if (params_.l1.write_allocate) line_of(core, line, begin).valid |= sectors;
  return write_below(core, line, sectors, begin + params_.l1.miss_latency);
}

Cycle MemoryModel::change(uint32_t core_index, Address line, uint8_t sectors, uint32_t turns, Cycle at) {
  Core& core = cores_[core_index];
  const Cycle begin = core.port.take(at, 1.0 / params_.l1.ports);
  const uint32_t index = partitions_.slice(line);
  slices_[index].service.take(begin + params_.l1.miss_latency, double(turns) * params_.l2.atomic_interval);
  const Cycle done = fetch(core, line, sectors, begin + params_.l1.miss_latency);
  Slice& slice = slices_[index];
  if (const uint32_t slot = slice.l2.tags.find(line); slot != mem::TagArray::kNone)
    slice.l2.tags.line(slot).dirty |= sectors;
  return done + Cycle(double(turns) * params_.l2.atomic_interval);
}

void MemoryModel::begin_launch(bool cold) {
  for (Core& core : cores_) empty(core.l1.tags);
  if (!cold) return;
  for (Slice& slice : slices_) empty(slice.l2.tags);
  for (Channel& channel : channels_)
    for (Bank& bank : channel.banks) bank.row = -1;
}

Cycle MemoryModel::fetch(Core& core, Address line, uint8_t sectors, Cycle at) {
  const uint32_t index = partitions_.slice(line), n = count(sectors);
  Slice& slice = slices_[index];
  ++l2_counts_.reads;
  const Cycle sent = core.request.take(at, packet_cycles(0, params_.noc.core_request_bytes));
  const Cycle served =
      slice.service.take(sent + params_.noc.request_latency, double(n) / params_.l2.sectors_per_cycle);
  mem::TagArray::Line& found = line_of(slice, index, line, served);
  Fill& fill = slice.l2.fills[slice.l2.tags.slot_of(found)];
  if (found.valid == 0) fill = {};
  const uint8_t missing = uint8_t(sectors & ~found.valid);
  Cycle ready = std::max(served + params_.l2.latency, fill.ready_for(served));
  if (missing) {
    ++l2_counts_.misses;
    found.valid |= missing;
    ready = from_dram(index, line, count(missing), served + params_.l2.latency);
    fill = {served, ready};
  }
  const double partition = packet_cycles(n, params_.noc.partition_reply_bytes),
               own = packet_cycles(n, params_.noc.core_reply_bytes);
  const Cycle replied = slice.reply.take(ready, partition) + params_.noc.reply_latency;
  return core.reply.take(replied, own) + Cycle(own) + 1;
}

Cycle MemoryModel::write_below(Core& core, Address line, uint8_t sectors, Cycle at) {
  const uint32_t index = partitions_.slice(line), n = count(sectors);
  const Cycle sent = core.request.take(at, packet_cycles(n, params_.noc.core_request_bytes));
  const Cycle served = slices_[index].service.take(sent + params_.noc.request_latency,
                                                   double(n) / params_.l2.sectors_per_cycle);
  mem::TagArray::Line& found = line_of(slices_[index], index, line, served);
  if (found.valid == 0) slices_[index].l2.fills[slices_[index].l2.tags.slot_of(found)] = {};
  found.valid |= sectors;
  found.dirty |= sectors;
  return sent;
}

Cycle MemoryModel::from_dram(uint32_t slice, Address line, uint32_t num_sectors, Cycle at) {
  Channel& channel = channels_[partitions_.partition_of(slice)];
  const mem::DramLocation where = dram_map_.locate(partitions_.local(line, slice));
  Bank& bank = channel.banks[where.bank];
  dram_sectors_ += num_sectors;
  const bool opens = bank.row != int64_t{where.row};
  const double row = opens ? double(bank.row < 0 ? timing_.rcd : timing_.rp + timing_.rcd) : 0;
  bank.row = where.row;
  const double columns = double(timing_.ccd_l) * num_sectors,
               data = core_per_dram_ * double(timing_.data) * num_sectors;
  // A bank does not open a second row within tRC.
  const double busy = opens ? std::max(row + columns, double(timing_.rc)) : columns;
  const Cycle begin = bank.busy.take(at + params_.dram.latency, core_per_dram_ * busy);
  return channel.bus.take(begin + Cycle(core_per_dram_ * (row + double(timing_.cl))), data) + Cycle(data) + 1;
}

double MemoryModel::l1_work() const {
  return most(cores_, [](const Core& core) { return core.port.total(); });
}
double MemoryModel::l2_work() const {
  return most(slices_, [](const Slice& slice) { return slice.service.total(); });
}
double MemoryModel::dram_work() const {
  return most(channels_, [](const Channel& channel) { return channel.bus.total(); });
}

}  // namespace glint::pipeline
