// Models the latency of accesses without queues: tags of caches, open rows, and bandwidths of resources.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "memsys/address_map.h"
#include "memsys/cache/tag_array.h"
#include "memsys/dram/dram_timing.h"
#include "memsys/params.h"
#include "pipeline/interval/bandwidth.h"

namespace glint::pipeline {

// Names who asks. The askers are counted apart.
enum class Asker : uint8_t { Shader, RtUnit };

struct CacheCounts {
  uint64_t reads = 0, misses = 0;
};

// Model: there are no MSHRs, miss queues, credits or refresh, and the requests of a bank are served in order
// of arrival. A line takes its place in the cache when it is asked for, and reads of it wait until it has
// come.
class MemoryModel {
 public:
  MemoryModel(const mem::Params& params, uint32_t num_cores, double core_mhz);

  // Reads sectors of a line (a physical, line-aligned address) at `at`. Returns the cycle when all are there.
  Cycle read(uint32_t core, Address line, uint8_t sectors, Cycle at, Asker asker);
  // Does the same for bytes anywhere: reads every line that they touch.
  Cycle read_bytes(uint32_t core, Address at, uint32_t bytes, Cycle when, Asker asker);
  // Returns when the L1 can take an access.
  Cycle port_free(uint32_t core, Cycle at) const { return cores_[core].port.begin(at); }
  // Writes sectors of a line, and returns when the L1 has got rid of them. No warp waits for that, but what
  // comes behind it does when more packets wait than the L1 holds.
  Cycle write(uint32_t core, Address line, uint8_t sectors, Cycle at, bool is_local);
  // Changes sectors of a line in the L2, in so many turns. Returns when the old values are there.
  Cycle change(uint32_t core, Address line, uint8_t sectors, uint32_t turns, Cycle at);
  // Begins another launch, which finds the L1s empty, and the L2 and the rows of DRAM as they are, or `cold`.
  void begin_launch(bool cold);

  const std::array<CacheCounts, 2>& l1() const { return l1_counts_; }  // indexed by Asker
  const CacheCounts& l2() const { return l2_counts_; }
  uint64_t dram_sectors() const { return dram_sectors_; }
  // Return core cycles of work of the busiest resource of each kind. No run is shorter than these.
  double l1_work() const;
  double l2_work() const;
  double dram_work() const;

 private:
  // Holds when a line was last fetched. Warps run ahead of each other within an interval, so a line may have
  // been asked for at a later time than the time at which another warp wants it. Then the earlier request
  // fetches it, with the latency that the later one had.
  struct Fill {
    Cycle asked = 0, ready = 0;
    Cycle ready_for(Cycle at) {
      if (asked > at) *this = {at, at + ready - asked};
      return ready;
    }
  };
  struct Cache {
    Cache(const mem::CacheShape& shape, const PolicyChoice<mem::Replacement>& replacement);
    mem::TagArray tags;
    std::vector<Fill> fills;  // the last fetch of each line of the tag array
  };
  struct Core {
    Cache l1;
    Bandwidth port, request, reply;
  };
  struct Bank {
    int64_t row = -1;
    Bandwidth busy;
  };
  struct Slice {
    Cache l2;
    Bandwidth service, reply;
  };
  struct Channel {
    std::vector<Bank> banks;
    Bandwidth bus;
  };

  // Returns when the data of a miss reach the L1.
  Cycle fetch(Core& core, Address line, uint8_t sectors, Cycle at);
  Cycle write_below(Core& core, Address line, uint8_t sectors, Cycle at);
  Cycle from_dram(uint32_t slice, Address line, uint32_t num_sectors, Cycle at);
  mem::TagArray::Line& line_of(Slice& slice, uint32_t index, Address line, Cycle at);
  mem::TagArray::Line& line_of(Core& core, Address line, Cycle at);

  const mem::Params params_;
  const mem::DramTiming timing_;
  const double core_per_dram_;  // core cycles per DRAM clock
  mem::PartitionMap partitions_;
  mem::DramMap dram_map_;
  std::vector<Core> cores_;
  std::vector<Slice> slices_;
  std::vector<Channel> channels_;
  std::array<CacheCounts, 2> l1_counts_;
  CacheCounts l2_counts_;
  uint64_t dram_sectors_ = 0;
};

}  // namespace glint::pipeline
