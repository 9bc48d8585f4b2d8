// Construction, and conservation at the end of a run.
// SPDX-License-Identifier: Apache-2.0
#include "memsys/memory_system.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"

namespace glint::mem {

MemorySystem::MemorySystem(const Params& params, uint32_t num_cores, double core_mhz, stats::Group* parent)
    : group_(parent, "memory"),
      map_(params.dram.channels, params.interleave),
      // A port needs at least one cycle for any packet, on top of the way.
      shortest_latency_(1 + std::min(params.noc.request_latency, params.noc.reply_latency)) {
  std::vector<FanIn<Packet>*> requests;
  std::vector<FanIn<Reply>*> replies;
  for (uint32_t p = 0; p < params.dram.channels; ++p)
    requests.push_back(requests_.emplace_back(std::make_unique<FanIn<Packet>>(num_cores)).get());
  for (uint32_t c = 0; c < num_cores; ++c)
    replies.push_back(replies_.emplace_back(std::make_unique<FanIn<Reply>>(params.dram.channels)).get());
  for (uint32_t c = 0; c < num_cores; ++c) {
    core_groups_.push_back(std::make_unique<stats::Group>(&group_, fmt::format("core[{}]", c)));
    l1s_.push_back(std::make_unique<L1Cache>(params, uint16_t(c), map_, requests, replies[c], core_groups_[c].get()));
  }
  for (uint32_t p = 0; p < params.dram.channels; ++p)
    partitions_.push_back(std::make_unique<Partition>(params, p, map_, core_mhz, requests[p], replies, &group_));
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
  return out;
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
}

}  // namespace glint::mem
