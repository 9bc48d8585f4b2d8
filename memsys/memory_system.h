// Models the whole memory system of a machine: the L1 of every core, the network, and every partition.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "base/stats.h"
#include "engine/engine.h"
#include "memsys/address_map.h"
#include "memsys/cache/l1_cache.h"
#include "memsys/latency.h"
#include "memsys/network.h"
#include "memsys/params.h"
#include "memsys/partition.h"

namespace glint::mem {

// Holds what stays in the memory system from one launch to the next. Model: that is what the L2 holds, and
// the open rows of DRAM. The L1s are emptied, as at the start of a kernel on hardware.
using MemoryContents = std::vector<PartitionContents>;

// Owns all parts and connects them. The engine advances cells() and delivers channels(); each core ticks its
// l1() as part of the core's own cell. `params` must have passed check().
class MemorySystem {
 public:
  MemorySystem(const Params& params, uint32_t num_cores, double core_mhz, stats::Group* parent);

  L1Cache& l1(uint32_t core) { return *l1s_[core]; }
  const L1Cache& l1(uint32_t core) const { return *l1s_[core]; }
  const Partition& partition(uint32_t index) const { return *partitions_[index]; }
  Partition& partition(uint32_t index) { return *partitions_[index]; }
  uint32_t num_cores() const { return uint32_t(l1s_.size()); }
  Cycle written_until() const;  // returns the end of the last write that reached a slice of the L2
  uint32_t num_partitions() const { return uint32_t(partitions_.size()); }
  const PartitionMap& map() const { return map_; }

  std::vector<Cell*> cells();  // returns the partitions, then the routers of the network
  std::vector<ChannelBase*> channels() { return network_->channels(); }
  // Returns which of them only one core or one slice receives from. A slice belongs to map().partition_of().
  Network::Inputs inputs() { return network_->inputs(); }
  // Returns the longest window that the engine may use, which is at least 1: no message arrives sooner.
  Cycle shortest_latency() const { return network_->shortest_latency(); }

  // Takes the contents after a launch that was run to its end, and gives them to the memory system of the
  // next launch before it begins. Both have the same parameters.
  MemoryContents take_contents();
  void put_contents(MemoryContents&& contents);
  // Lets the L2 hold sectors of a line (a physical, line-aligned address) as if they had just been read or
  // written. It takes no time and counts nothing. Returns how many sectors were lost: those of a line that
  // made way and that DRAM had not got yet.
  uint32_t warm(Address line, uint8_t sectors, Touch touch = Touch::Read,
                Displaced displaced = Displaced::Lost);
  // Lets the L2 hold lines of `others` further machines like this one, which would share it: for each access
  // to memory of one thread that the L2 serves, each of them touches a line of its own there. These take no
  // time and count nothing. Dirty lines that make way for them are written back as with
  // Displaced::WrittenLater.
  void share_with(uint32_t others);
  // Returns the number of sectors that the L2 holds and DRAM has not got yet.
  uint64_t dirty_sectors() const;

  // Counts the cycles up to the end of the run under their reasons. It is called once, before statistics are
  // read.
  void finish(Cycle end);
  // Aborts unless, at the end of a run, every request was answered and nothing is left.
  void check_drained() const;

 private:
  void check_conserved() const;
  double imbalance() const;

  stats::Group group_;
  stats::Value imbalance_{&group_, "dram_imbalance", "ratio", [this] { return imbalance(); },
                          "Data clocks of the busiest DRAM channel, divided by the mean of all channels. 1 "
                          "means that all channels are equally busy."};
  LatencyStats load_latency_{&group_, "load_latency",
                             "Number of reads that the L1s have answered, atomics included, by traffic "
                             "class. A latency is the time from acceptance to answer."};
  PartitionMap map_;
  std::unique_ptr<Network> network_;
  std::vector<std::unique_ptr<stats::Group>> core_groups_;
  std::vector<std::unique_ptr<L1Cache>> l1s_;
  std::vector<std::unique_ptr<Partition>> partitions_;
};

}  // namespace glint::mem
