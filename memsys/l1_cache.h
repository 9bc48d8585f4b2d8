// The L1 data cache of a core: sectored, streaming, write-through for global and write-back for local memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <vector>

#include "base/stats.h"
#include "memsys/address_map.h"
#include "memsys/cache_stats.h"
#include "memsys/fan_in.h"
#include "memsys/l1_port.h"
#include "memsys/mshr.h"
#include "memsys/packet.h"
#include "memsys/params.h"
#include "memsys/ring.h"
#include "memsys/tag_array.h"

namespace glint::mem {

struct L1Stats : CacheStats {
  explicit L1Stats(stats::Group* parent) : CacheStats(parent, "l1") {}
  stats::Breakdown<Refusal> refusals{&group, "refusals", "attempt", "Requests turned away; the unit tries again in a later cycle."};
  stats::Counter fills{&group, "fills", "reply", "Replies written into the cache; at most one a cycle."};
  stats::Counter request_bytes{&group, "request_bytes", "byte", "Sent into the network, headers included."};
  stats::Counter reply_bytes{&group, "reply_bytes", "byte", "Received from the network, headers included."};
  stats::Counter request_wait{&group, "request_wait", "cycle", "Sum over packets of the cycles they waited for the request port."};
  stats::Counter reply_wait{&group, "reply_wait", "cycle", "Sum over replies of the cycles between arrival and fill."};
  stats::Histogram miss_latency{&group, "miss_latency", "cycle", stats::linear(0, 2048, 32), "From a read that did not hit to its last sector."};
  stats::Histogram l2_latency{&group, "l2_latency", "cycle", stats::linear(0, 2048, 32), "The same, of those whose last sector the L2 had."};
  stats::Histogram dram_latency{&group, "dram_latency", "cycle", stats::linear(0, 2048, 32), "The same, of those whose last sector came from DRAM."};
  stats::Counter timed_misses{&group, "timed_misses", "request", "Reads in them: all that did not hit, but atomics."};
  stats::Counter miss_cycles{&group, "miss_cycles", "cycle", "Sum of their latencies."};
  stats::Ratio mean_miss_latency{&group, "mean_miss_latency", "cycle", miss_cycles, timed_misses, "Mean latency of a read that did not hit."};
  stats::Breakdown<Stage> miss_stages{&group, "miss_stages", "cycle", "The sum of their latencies, by stage."};
};

// An accepted miss or write becomes one packet in the bounded miss queue and leaves over the core's request port. Lines
// are allocated when data arrives (streaming): only MSHRs and the miss queue limit the misses in flight.
// Lines of instructions and constants pass through MSHRs and miss queue for caches of the core that keep them.
// Atomics go past the cache to the L2, which executes them; what the cache holds of their sectors is dropped.
// Model: a write covers whole sectors; a write to a line on its way does not disturb it.
// Model: a read that waits for a sector already on its way is ready when the sector is, even within the hit latency.
// Model: local memory that is dirty at the end of a run is not written back: its thread is gone.
class L1Cache final : public L1Port {
 public:
  // requests[p] is partition p's inbound side, `replies` this core's own. Both outlive the cache.
  L1Cache(const Params& params, uint16_t core, const PartitionMap& map, std::vector<FanIn<Packet>*> requests,
          FanIn<Reply>* replies, stats::Group* parent);

  bool access(Cycle now, Client client, const Request& request) override;
  std::optional<Token> pop(Cycle now, Client client) override;
  void tick(Cycle now) override;
  Cycle next_event(Cycle now) const override;
  uint32_t line_bytes() const override { return line_bytes_; }
  std::string describe() const override;

  const L1Stats& stats() const { return stats_; }
  // Holds nothing and waits for nothing; popped tokens equal accepted reads.
  bool drained() const;
  uint64_t packets_sent() const { return packets_sent_; }
  uint64_t sectors_requested() const { return sectors_requested_; }
  uint64_t sectors_received() const { return sectors_received_; }
  uint64_t reads_accepted() const { return reads_accepted_; }
  uint64_t tokens_returned() const { return tokens_returned_; }

 private:
  static constexpr uint32_t kNone = TagArray::kNone;
  struct Waiter {
    Cycle accepted = 0;
    uint64_t order = 0;
    Token token = 0;
    uint8_t missing = 0;
    Client client = Client::Lsu;
  };
  struct Completion {
    Cycle ready = 0;
    uint64_t order = 0;  // of acceptance
    Token token = 0;
  };
  struct Outgoing {
    Cycle ready = 0;
    Packet packet;
  };
  struct Answers {  // of one client; each ring is in order of readiness
    Ring<Completion> hits, fills;
  };

  bool refuse(Refusal reason);
  bool read(Cycle now, Client client, const Request& request);
  bool write_through(Cycle now, const Request& request);
  bool write_local(Cycle now, const Request& request);
  bool pass_atomic(Cycle now, Client client, const Request& request);
  bool queue_full() const { return miss_queue_.size() >= params_.miss_queue; }
  void queue_packet(Cycle ready, Address line, uint8_t sectors, bool write, Traffic traffic, Token token = 0,
                    Client client = Client::Lsu);
  void evict(Cycle now, const TagArray::Line& victim);
  Cycle next_departure() const;
  Cycle next_fill() const;
  void send_front(Cycle now);
  bool fill(Cycle now);
  bool place(Cycle now, const Reply& reply);
  void answer_waiters(Cycle now, const Reply& reply);
  void count_miss(Cycle accepted, Cycle now, const Stamps& stamps);

  const L1Params params_;
  const uint32_t line_bytes_;
  const uint16_t core_;
  const PartitionMap map_;
  std::vector<FanIn<Packet>*> requests_;
  FanIn<Reply>* replies_;
  L1Stats stats_;
  TagArray tags_;
  Mshr<Waiter> mshr_;
  std::vector<uint8_t> passing_;  // an MSHR: its line is of instructions or constants, and is not kept
  LineTable seen_;
  Ring<Outgoing> miss_queue_;
  std::array<Answers, size_t(Client::Count)> answers_;
  Port request_port_, reply_port_;
  Port partition_reply_port_;  // only to know how long a reply took to be sent
  const Cycle request_latency_;
  Cycle port_cycle_ = kNever;  // accesses_ and busy_banks_ are of this cycle
  uint32_t accesses_ = 0;
  uint64_t busy_banks_ = 0;
  Cycle fill_not_before_ = 0;  // one fill a cycle; later when a dirty victim found the miss queue full
  uint64_t order_ = 0;
  uint64_t packets_sent_ = 0, sectors_requested_ = 0, sectors_received_ = 0, reads_accepted_ = 0, tokens_returned_ = 0;
};

}  // namespace glint::mem
