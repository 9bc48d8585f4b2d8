// Construction, and conservation at the end of a run.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/memory_system.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

#include "base/check.h"

namespace glint::mem {

namespace {

// Between a core and a slice, one way, beyond the latency of the network: they may lie on different sides.
Cycle far_latency(const Params& params, uint32_t num_cores, uint32_t core, uint32_t slice) {
  const uint64_t sides = params.noc.sides;
  return core * sides / num_cores == slice * sides / params.num_slices() ? 0 : params.noc.far_latency;
}

}  // namespace

MemorySystem::MemorySystem(const Params& params, uint32_t num_cores, double core_mhz, stats::Group* parent)
    : group_(parent, "memory"),
      map_(params.dram.channels, params.l2.slices, params.interleave, params.hash == "mixed"),
      // A port needs at least one cycle for any packet, on top of the way.
      shortest_latency_(1 + std::min(params.noc.request_latency, params.noc.reply_latency)) {
  SliceLinks from_slice;
  std::vector<FanIn<Packet>*> requests;
  for (uint32_t s = 0; s < params.num_slices(); ++s)
    requests.push_back(requests_.emplace_back(std::make_unique<FanIn<Packet>>(num_cores)).get());
  for (uint32_t c = 0; c < num_cores; ++c) {
    from_slice.replies.push_back(
        replies_.emplace_back(std::make_unique<FanIn<Reply>>(params.num_slices())).get());
    if (params.noc.credits > 0)
      from_slice.credits.push_back(
          credits_.emplace_back(std::make_unique<FanIn<Credit>>(params.num_slices())).get());
    core_groups_.push_back(std::make_unique<stats::Group>(&group_, fmt::format("core[{}]", c)));
    L1Links links{requests, {}, replies_[c].get(), credits_.empty() ? nullptr : credits_[c].get()};
    for (uint32_t s = 0; s < params.num_slices(); ++s)
      links.request_latency.push_back(params.noc.request_latency + far_latency(params, num_cores, c, s));
    l1s_.push_back(
        std::make_unique<L1Cache>(params, uint16_t(c), map_, std::move(links), core_groups_[c].get()));
    load_latency_.add(l1s_.back()->latencies());
  }
  for (uint32_t p = 0; p < params.dram.channels; ++p) {
    std::vector<SliceLinks> links;
    for (uint32_t s = p * params.l2.slices; s < (p + 1) * params.l2.slices; ++s) {
      links.push_back(from_slice);
      links.back().requests = requests[s];
      for (uint32_t c = 0; c < num_cores; ++c)
        links.back().reply_latency.push_back(params.noc.reply_latency + far_latency(params, num_cores, c, s));
    }
    partitions_.push_back(std::make_unique<Partition>(params, p, map_, core_mhz, std::move(links), &group_));
  }
}

std::vector<Cell*> MemorySystem::cells() {
  std::vector<Cell*> out;
  for (const auto& partition : partitions_) out.push_back(partition.get());
  return out;
}

std::vector<ChannelBase*> MemorySystem::channels() {
  std::vector<ChannelBase*> out;
  for (const auto& channel : requests_) out.push_back(channel.get());
  for (const auto& channel : replies_) out.push_back(channel.get());
  for (const auto& channel : credits_) out.push_back(channel.get());
  return out;
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
  for (const auto& channel : replies_) GLINT_CHECK_EQ(channel->waiting(), size_t{0});
  for (const auto& channel : credits_) GLINT_CHECK_EQ(channel->waiting(), size_t{0});
  check_conserved();
}

// What went down came through: nothing is counted twice or lost between two levels.
void MemorySystem::check_conserved() const {
  uint64_t sent = 0, received = 0;         // bytes
  uint64_t timed = load_latency_.total();  // reads
  for (const auto& l1 : l1s_) {
    const L1Stats& s = l1->stats();
    GLINT_CHECK_EQ(s.reads.total(), s.hits.total() + s.pending_hits.total() + s.misses.total());
    sent += s.request_bytes.value();
    received += s.reply_bytes.value();
    timed -= s.reads.total();
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
