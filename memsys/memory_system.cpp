// Builds the memory system, and checks at the end of a run that nothing was lost.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/memory_system.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

#include "base/check.h"
#include "memsys/messages/network_port.h"

namespace glint::mem {

MemorySystem::MemorySystem(const Params& params, uint32_t num_cores, double core_mhz, stats::Group* parent)
    : group_(parent, "memory"),
      map_(params.dram.channels, params.l2.slices, params.interleave, slice_hash(params.hash)),
      network_(params.noc.topology.make({params.noc, num_cores, params.num_slices()})) {
  for (uint32_t c = 0; c < num_cores; ++c) {
    core_groups_.push_back(std::make_unique<stats::Group>(&group_, fmt::format("core[{}]", c)));
    l1s_.push_back(std::make_unique<L1Cache>(params, uint16_t(c), map_, network_->core_port(uint16_t(c)),
                                             core_groups_[c].get()));
    load_latency_.add(l1s_.back()->latencies());
  }
  for (uint32_t p = 0; p < params.dram.channels; ++p) {
    std::vector<SlicePort> ports;
    for (uint32_t s = p * params.l2.slices; s < (p + 1) * params.l2.slices; ++s)
      ports.push_back(network_->slice_port(uint16_t(s)));
    partitions_.push_back(std::make_unique<Partition>(params, p, map_, core_mhz, std::move(ports), &group_));
  }
}

std::vector<Cell*> MemorySystem::cells() {
  std::vector<Cell*> out;
  for (const auto& partition : partitions_) out.push_back(partition.get());
  for (Cell* cell : network_->cells()) out.push_back(cell);
  return out;
}

MemoryContents MemorySystem::take_contents() {
  MemoryContents out;
  for (const auto& partition : partitions_) out.push_back(partition->take_contents());
  return out;
}

uint32_t MemorySystem::warm(Address line, uint8_t sectors, Touch touch, Displaced displaced) {
  const uint32_t slice = map_.slice(line);
  return partitions_[map_.partition_of(slice)]->warm(slice, line, sectors, touch, displaced);
}

void MemorySystem::share_with(uint32_t others) {
  for (const auto& partition : partitions_) partition->share_with(others);
}

uint64_t MemorySystem::dirty_sectors() const {
  uint64_t sum = 0;
  for (const auto& partition : partitions_)
    sum += partition->sum([](const L2Slice& slice) { return slice.dirty_sectors(); });
  return sum;
}

void MemorySystem::put_contents(MemoryContents&& contents) {
  for (size_t i = 0; i < partitions_.size(); ++i) partitions_[i]->put_contents(std::move(contents[i]));
}

double MemorySystem::imbalance() const {
  uint64_t most = 0, sum = 0;
  for (const auto& partition : partitions_) {
    const uint64_t busy = partition->dram().stats().busy_clocks.value();
    most = std::max(most, busy);
    sum += busy;
  }
  return sum ? double(most) * double(partitions_.size()) / double(sum) : 0.0;
}

void MemorySystem::finish(Cycle end) {
  for (const auto& partition : partitions_) partition->finish(end);
}

void MemorySystem::check_drained() const {
  uint64_t sent = 0, requested = 0, received = 0, replied = 0;
  for (const auto& l1 : l1s_) {
    GLINT_CHECK_EQ(l1->reads_accepted(), l1->tokens_returned());
    GLINT_CHECK_EQ(l1->sectors_requested(), l1->sectors_received());
    GLINT_CHECK_EQ(l1->stats().miss_stages.total(), l1->stats().miss_cycles.value());
    GLINT_CHECK(l1->drained(), "an L1 still holds misses or packets");
    sent += l1->packets_sent();
    requested += l1->sectors_requested();
  }
  for (const auto& partition : partitions_) {
    GLINT_CHECK_EQ(partition->sectors_requested(), partition->sectors_replied());
    GLINT_CHECK(partition->drained(), "{}", partition->describe_stall());
    received += partition->packets_received();
    replied += partition->sectors_replied();
  }
  GLINT_CHECK_EQ(sent, received);
  GLINT_CHECK_EQ(requested, replied);
  for (const Cell* cell : network_->cells()) GLINT_CHECK(cell->finished(), "{}", cell->describe_stall());
  for (const ChannelBase* channel : network_->channels())
    GLINT_CHECK(channel->next_arrival() == kNever, "the network still holds messages");
  check_conserved();
}

// Checks that what left one level arrived at the next, and that nothing was counted twice or lost.
void MemorySystem::check_conserved() const {
  uint64_t sent = 0, received = 0;         // bytes that L1s have counted, less those that slices have
  uint64_t timed = load_latency_.total();  // reads that were timed, less those that L1s owed an answer
  for (const auto& l1 : l1s_) {
    const L1Stats& s = l1->stats();
    GLINT_CHECK_EQ(s.reads.total(), s.hits.total() + s.pending_hits.total() + s.misses.total());
    sent += s.request_bytes.value();
    received += s.reply_bytes.value();
    timed -= s.reads.total() - s.reads.count(Traffic::RtPrefetch);
  }
  for (const auto& partition : partitions_) {
    uint64_t fetched = 0, written = 0;
    for (uint32_t i = 0; i < partition->num_slices(); ++i) {
      const L2Stats& s = partition->slice(i).stats();
      GLINT_CHECK_EQ(s.reads.total(), s.hits.total() + s.pending_hits.total() + s.misses.total());
      sent -= s.request_bytes.value();
      received -= s.reply_bytes.value();
      fetched += s.dram_reads.value();
      written += s.dram_writes.value();
    }
    const DramStats& dram = partition->dram().stats();
    GLINT_CHECK_EQ(fetched, dram.reads.value());
    GLINT_CHECK_EQ(written, dram.writes.value());
    GLINT_CHECK_EQ(dram.requests.value(), dram.reads.value() + dram.writes.value());
  }
  GLINT_CHECK_EQ(timed, uint64_t{0});
  GLINT_CHECK_EQ(sent, uint64_t{0});
  GLINT_CHECK_EQ(received, uint64_t{0});
}

Cycle MemorySystem::written_until() const {
  Cycle end = 0;
  for (const auto& partition : partitions_)
    for (uint32_t i = 0; i < partition->num_slices(); ++i)
      end = std::max(end, partition->slice(i).written_until());
  return end;
}

}  // namespace glint::mem
