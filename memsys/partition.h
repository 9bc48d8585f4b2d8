// Models a memory partition as one cell: a DRAM channel with the L2 slices in front of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/interval_sampler.h"
#include "base/probe.h"
#include "base/stats.h"
#include "engine/engine.h"
#include "memsys/cache/l2_slice.h"
#include "memsys/dram_model.h"
#include "memsys/params.h"

namespace glint::mem {

// Tells that a memory channel began to work or stopped. It begins with a request, and stops when it has
// answered all requests.
struct DramTurn {
  Cycle cycle = 0;
  bool works = false;     // whether the channel works from this cycle on
  uint64_t requests = 0;  // number of requests that the channel has taken since the launch
};

// Holds what a partition keeps from one launch to the next.
struct PartitionContents {
  std::vector<L2Contents> slices;
  std::vector<uint32_t> rows;  // the rows of DRAM that are open, by bank
};

// Slices take turns to hand requests to DRAM; the requests of one slice keep their order. Every cycle of a
// slice is counted under one reason.
class Partition final : public Cell {
 public:
  // `ports` has one port for each slice of this partition.
  Partition(const Params& params, uint32_t index, const PartitionMap& map, double core_mhz,
            std::vector<SlicePort> ports, stats::Group* parent);

  void advance(Cycle from, Cycle until) override;
  Cycle next_event(Cycle from) const override;
  bool finished() const override;
  uint64_t progress() const override;
  std::string describe_stall() const override;

  PartitionContents take_contents();
  void put_contents(PartitionContents&& contents);
  // Does MemorySystem::warm() for slice `slice` of the memory system, which is one of this partition.
  uint32_t warm(uint32_t slice, Address line, uint8_t sectors, Touch touch, Displaced displaced) {
    return slices_[slice % slices_.size()]->warm(line, sectors, touch, displaced);
  }

  // Does MemorySystem::share_with().
  void share_with(uint32_t others) {
    for (const auto& slice : slices_) slice->share_with(others);
  }

  void finish(Cycle end);  // counts the cycles up to the end of the run under their reasons
  IntervalSampler& sampler() { return sampler_; }
  const DramModel& dram() const { return *dram_; }
  Probe<DramTurn>& dram_turned() { return dram_turned_; }
  uint32_t num_slices() const { return uint32_t(slices_.size()); }
  const L2Slice& slice(uint32_t index) const { return *slices_[index]; }
  const L2Stats& stats() const { return slices_[0]->stats(); }  // are those of the first slice
  // Returns the sum of a count over the slices.
  uint64_t sum(uint64_t (*of)(const L2Slice&)) const;
  uint64_t packets_received() const {
    return sum([](const L2Slice& s) { return s.packets_received(); });
  }
  uint64_t sectors_requested() const {
    return sum([](const L2Slice& s) { return s.sectors_requested(); });
  }
  uint64_t sectors_replied() const {
    return sum([](const L2Slice& s) { return s.sectors_replied(); });
  }
  bool drained() const;

 private:
  Cycle next_work() const;
  void step(Cycle now);
  void feed_dram(Cycle now);
  void receive_from_dram(Cycle now);
  bool dram_works() const { return dram_->in_flight() > 0 || !dram_->returns().empty(); }
  void account(Cycle until);

  stats::Group group_;
  const uint32_t index_;
  const PartitionMap map_;
  const std::unique_ptr<DramModel> dram_;
  std::vector<std::unique_ptr<L2Slice>> slices_;
  size_t turn_ = 0;      // number of the slice that may hand over first
  bool worked_ = false;  // whether the channel worked at the end of the last step
  Probe<DramTurn> dram_turned_;
  IntervalSampler sampler_;
};

}  // namespace glint::mem
