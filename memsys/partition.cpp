// Advances the DRAM channel and the slices of a partition, cycle by cycle.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/partition.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

namespace glint::mem {
namespace {

// Choice: the channels refresh one after another, in even steps. On an H100, loads of all cores at once never
// waited for a refresh together.
double refresh_phase(uint32_t channel, const Params& params) {
  return double(channel + 1) / double(params.dram.channels);
}

}  // namespace

Partition::Partition(const Params& params, uint32_t index, const PartitionMap& map, double core_mhz,
                     std::vector<SlicePort> ports, stats::Group* parent)
    : group_(parent, fmt::format("partition[{}]", index)),
      index_(index),
      map_(map),
      dram_(params.dram.model.make(
          {params.dram, params.interleave, core_mhz, &group_, refresh_phase(index, params)})) {
  for (uint32_t i = 0; i < ports.size(); ++i) {
    const std::string name = ports.size() == 1 ? "l2" : fmt::format("l2[{}]", i);
    slices_.push_back(std::make_unique<L2Slice>(params, index * uint32_t(ports.size()) + i, map,
                                                std::move(ports[i]), &group_, name));
  }
}

PartitionContents Partition::take_contents() {
  PartitionContents out;
  for (const auto& slice : slices_) out.slices.push_back(slice->take_contents());
  out.rows = dram_->open_rows();
  return out;
}

void Partition::put_contents(PartitionContents&& contents) {
  for (size_t i = 0; i < slices_.size(); ++i) slices_[i]->put_contents(std::move(contents.slices[i]));
  dram_->open_rows(contents.rows);
}

void Partition::advance(Cycle from, Cycle until) {
  account(from);
  for (const auto& slice : slices_) slice->prefetch();
  for (;;) {
    const Cycle now = std::max(next_work(), from);
    if (now >= until) break;
    account(now);
    step(now);
    from = now + 1;
  }
  account(until);
}

// The stages run from back to front, so that what leaves makes room for what enters in the same cycle.
void Partition::step(Cycle now) {
  sampler_.reach(now);
  dram_->advance(now);
  receive_from_dram(now);
  feed_dram(now);
  for (const auto& slice : slices_) {
    slice->send_ready_replies(now);
    slice->serve(now);
  }
  if (dram_works() != worked_) {
    worked_ = !worked_;
    dram_turned_.fire([&] { return DramTurn{now, worked_, dram_->stats().requests.value()}; });
  }
}

Cycle Partition::next_work() const {
  Cycle next = dram_->next_command();
  if (!dram_->returns().empty()) next = std::min(next, dram_->returns().front().ready);
  const bool full = dram_->full();
  for (const auto& slice : slices_) {
    next = std::min(next, slice->next_work());
    // A full DRAM model frees an entry only at its own next command.
    if (!full && !slice->to_dram().empty()) next = std::min(next, slice->to_dram().front().ready);
  }
  return next;
}

Cycle Partition::next_event(Cycle from) const {
  const Cycle next = next_work();
  return next == kNever ? kNever : std::max(next, from);
}

void Partition::feed_dram(Cycle now) {
  for (size_t idle = 0; idle < slices_.size() && !dram_->full();) {
    L2Slice& slice = *slices_[turn_];
    turn_ = turn_ + 1 == slices_.size() ? 0 : turn_ + 1;
    Ring<ToDram>& queue = slice.to_dram();
    if (queue.empty() || queue.front().ready > now) {
      ++idle;
      continue;
    }
    const ToDram& out = queue.front();
    const Address first = out.line + uint64_t(std::countr_zero(out.sectors)) * kSectorBytes;
    dram_->add(now, out.line, out.sectors, slice.local(first), out.write);
    queue.pop();
    idle = 0;
  }
}

void Partition::receive_from_dram(Cycle now) {
  Ring<DramReturn>& returns = dram_->returns();
  for (; !returns.empty() && returns.front().ready <= now; returns.pop()) {
    const size_t slice = slices_.size() == 1 ? 0 : map_.slice(returns.front().line) % slices_.size();
    slices_[slice]->fill(now, returns.front());
  }
}

void Partition::account(Cycle until) {
  const bool works = dram_works();
  for (const auto& slice : slices_) slice->account(until, works);
}

void Partition::finish(Cycle end) {
  sampler_.finish(end);
  account(end);
  dram_->finish(end);
}

uint64_t Partition::sum(uint64_t (*of)(const L2Slice&)) const {
  uint64_t out = 0;
  for (const auto& slice : slices_) out += of(*slice);
  return out;
}

uint64_t Partition::progress() const {
  return dram_->stats().picks.value() + sum([](const L2Slice& s) { return s.progress(); });
}

bool Partition::finished() const {
  return dram_->finished() &&
         std::all_of(slices_.begin(), slices_.end(), [](const auto& slice) { return slice->finished(); });
}

bool Partition::drained() const {
  return finished() && sectors_requested() == sectors_replied();
}

std::string Partition::describe_stall() const {
  std::string out;
  for (size_t i = 0; i < slices_.size(); ++i)
    out += fmt::format("partition {}{}: {}, {} in DRAM\n", index_,
                       slices_.size() == 1 ? "" : fmt::format(" slice {}", i),
                       slices_[i]->describe(dram_works()), dram_->in_flight());
  return out;
}

}  // namespace glint::mem
