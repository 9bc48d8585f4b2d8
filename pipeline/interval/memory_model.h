// Latency of accesses without simulating queues: tags of all caches, open rows, and bandwidth of each
// resource on the way.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "memsys/address_map.h"
#include "memsys/dram_timing.h"
#include "memsys/params.h"
#include "memsys/tag_array.h"
#include "pipeline/interval/bandwidth.h"

namespace glint::pipeline {

// Who asks: counted apart.
enum class Asker : uint8_t { Shader, RtUnit };

struct CacheCounts {
  uint64_t reads = 0, misses = 0;
};

// Model: no MSHRs, miss queues, credits or refresh, no order among requests of a bank but that of arrival; a
// line takes its place when it is asked for, and what is read of it before it has come waits for it.
class MemoryModel {
 public:
  MemoryModel(const mem::Params& params, uint32_t num_cores, double core_mhz);

  // Sectors of a line (physical address, line-aligned), at `at`: the cycle when all are there.
  Cycle read(uint32_t core, Address line, uint8_t sectors, Cycle at, Asker asker);
  // The same of bytes anywhere: every line that they touch.
  Cycle read_bytes(uint32_t core, Address at, uint32_t bytes, Cycle when, Asker asker);
  // When the L1 could take an access.
  Cycle port_free(uint32_t core, Cycle at) const { return cores_[core].port.begin(at); }
  // Nobody waits for a write.
  void write(uint32_t core, Address line, uint8_t sectors, Cycle at, bool is_local);

  const std::array<CacheCounts, 2>& l1() const { return l1_counts_; }  // by Asker
  const CacheCounts& l2() const { return l2_counts_; }
  uint64_t dram_sectors() const { return dram_sectors_; }
  // Work of the busiest of each kind, core cycles: no run is shorter.
  double l1_work() const;
  double l2_work() const;
  double dram_work() const;

 private:
  // Warps run ahead of each other within an interval: a line may have been asked for at a later time than it
  // is wanted. Then it is this wish that fetches it, and what it costs is what the later one has paid.
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
    std::vector<Fill> fills;  // by line of the tag array: what was fetched last
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

  // From a miss's departure to the data in the L1; a write of the L2; both of a slice's sectors.
  Cycle fetch(Core& core, Address line, uint8_t sectors, Cycle at);
  void write_below(Core& core, Address line, uint8_t sectors, Cycle at);
  Cycle from_dram(uint32_t slice, Address line, uint32_t num_sectors, Cycle at);
  mem::TagArray::Line& line_of(Slice& slice, uint32_t index, Address line, Cycle at);
  mem::TagArray::Line& line_of(Core& core, Address line, Cycle at);

  const mem::Params params_;
  const mem::DramTiming timing_;
  const double core_per_dram_;  // core cycles of a DRAM clock
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
