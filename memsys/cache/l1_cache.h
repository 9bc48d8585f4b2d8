// The L1 data cache of a core: sectored, streaming, write-through for global and write-back for local memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/probe.h"
#include "base/stats.h"
#include "memsys/address_map.h"
#include "memsys/cache/cache_stats.h"
#include "memsys/cache/mshr.h"
#include "memsys/cache/tag_array.h"
#include "memsys/l1_port.h"
#include "memsys/latency.h"
#include "memsys/messages/network_port.h"
#include "memsys/messages/packet.h"
#include "memsys/params.h"
#include "memsys/ring.h"

namespace glint::mem {

struct L1Stats : CacheStats {
  explicit L1Stats(stats::Group* parent) : CacheStats(parent, "l1") {}
  stats::Breakdown<Refusal> refusals{&group, "refusals", "attempt",
                                     "Requests turned away; the unit tries again in a later cycle."};
  stats::Counter fills{&group, "fills", "reply", "Replies written into the cache; at most one a cycle."};
  stats::Counter request_bytes{&group, "request_bytes", "byte", "Sent into the network, headers included."};
  stats::Counter reply_bytes{&group, "reply_bytes", "byte", "Received from the network, headers included."};
  stats::Counter request_wait{&group, "request_wait", "cycle",
                              "Sum over packets of the cycles they waited for the request port."};
  stats::Counter reply_wait{&group, "reply_wait", "cycle",
                            "Sum over replies of the cycles between arrival and fill."};
  stats::Histogram miss_latency{&group, "miss_latency", "cycle", stats::linear(0, 2048, 32),
                                "From a read that did not hit to its last sector."};
  stats::Histogram l2_latency{&group, "l2_latency", "cycle", stats::linear(0, 2048, 32),
                              "The same, of those whose last sector the L2 had."};
  stats::Histogram dram_latency{&group, "dram_latency", "cycle", stats::linear(0, 2048, 32),
                                "The same, of those whose last sector came from DRAM."};
  stats::Counter timed_misses{&group, "timed_misses", "request",
                              "Reads in them: all that did not hit, but atomics."};
  stats::Counter miss_cycles{&group, "miss_cycles", "cycle", "Sum of their latencies."};
  stats::Ratio mean_miss_latency{&group,       "mean_miss_latency",
                                 "cycle",      miss_cycles,
                                 timed_misses, "Mean latency of a read that did not hit."};
  stats::Breakdown<Stage> miss_stages{&group, "miss_stages", "cycle",
                                      "The sum of their latencies, by stage."};
};

// A read that was counted as a miss, told when the L1 takes it.
struct ReadMissed {
  Client client = Client::Lsu;
  const Request& request;
};

// An accepted miss or write becomes one packet in the bounded miss queue and leaves over the core's port of
// the network, when the network has room for it. Lines are allocated when data arrives (streaming), so that
// only MSHRs and the miss queue limit the misses in flight; or (`allocate`) when the miss is accepted, and
// held until then. Lines of instructions and constants pass through MSHRs and miss queue for caches of the
// core that keep them. Atomics go past the cache to the L2, which executes them; what the cache holds of
// their sectors is dropped. Model: a write covers whole sectors; a write to a line on its way does not
// disturb it. Model: a read that waits for a sector already on its way is ready when the sector is, even
// within the hit latency. Model: local memory that is dirty at the end of a run is not written back: its
// thread is gone.
class L1Cache final : public L1Port {
 public:
  L1Cache(const Params& params, uint16_t core, const PartitionMap& map, CorePort port, stats::Group* parent);

  bool access(Cycle now, Client client, const Request& request) override;
  std::optional<Token> pop(Cycle now, Client client) override;
  void tick(Cycle now) override;
  Cycle next_event(Cycle now) const override;
  uint32_t line_bytes() const override { return line_bytes_; }
  std::string describe() const override;

  const L1Stats& stats() const { return stats_; }
  Probe<ReadMissed>& read_missed() { return read_missed_; }
  // Of every read, from its acceptance until it can be popped.
  const Latencies& latencies() const { return latencies_; }
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
    Traffic traffic = Traffic::ShaderGlobal;
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
  bool write_back(Cycle now, const Request& request);
  uint64_t bank_of(Address line) const {
    return uint64_t{1} << (params_.banks == 1 ? 0 : line / line_bytes_ % params_.banks);
  }
  bool pass_atomic(Cycle now, Client client, const Request& request);
  bool queue_room(uint32_t packets) const { return miss_queue_.size() + packets <= params_.miss_queue; }
  bool queue_full() const { return !queue_room(1); }
  void queue_packet(Cycle ready, const Packet& packet);
  void evict(Cycle now, const TagArray::Line& victim);
  Cycle next_departure() const;
  Cycle next_fill() const;
  void send_front(Cycle now);
  bool fill(Cycle now);
  void hold(Cycle now, Address line, uint32_t slot);
  bool install(Cycle now, const Reply& reply);
  void answer_waiters(Cycle now, const Reply& reply);
  void count_miss(const Waiter& waiter, Cycle now, const Stamps& stamps);

  const L1Params params_;
  const uint32_t line_bytes_;
  const uint16_t core_;
  const bool allocate_on_miss_;
  const PartitionMap map_;
  CorePort port_;
  L1Stats stats_;
  Probe<ReadMissed> read_missed_;
  Latencies latencies_;
  TagArray tags_;
  Mshr<Waiter> mshr_;
  std::vector<uint8_t> passing_;  // an MSHR: its line is of instructions or constants, and is not kept
  LineTable seen_;
  Ring<Outgoing> miss_queue_;
  std::array<Answers, size_t(Client::Count)> answers_;
  Cycle port_cycle_ = kNever;  // accesses_ and busy_banks_ are of this cycle
  uint32_t accesses_ = 0;
  uint64_t busy_banks_ = 0;
  Cycle filled_cycle_ = kNever;  // of the last fill, and its bank
  uint64_t filled_bank_ = 0;
  Cycle fill_not_before_ = 0;  // one fill a cycle
  bool fill_blocked_ = false;  // a dirty victim found the miss queue full: until a packet leaves
  uint64_t order_ = 0;
  uint64_t packets_sent_ = 0, sectors_requested_ = 0, sectors_received_ = 0, reads_accepted_ = 0,
           tokens_returned_ = 0;
};

}  // namespace glint::mem
