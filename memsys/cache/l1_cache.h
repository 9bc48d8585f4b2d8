// Models the sectored L1 data cache of a core. By default it streams, writes global memory through, and
// writes local memory back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
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
#include "memsys/cache/prefetch_marks.h"
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
  stats::Breakdown<Refusal> refusals{
      &group, "refusals", "attempt",
      "Number of refused attempts, by reason; the unit tries again in a later cycle."};
  stats::Counter fills{&group, "fills", "reply",
                       "Number of replies that the cache took, at most one per cycle."};
  stats::Counter request_bytes{&group, "request_bytes", "byte",
                               "Bytes that the cache sent into the network, headers included."};
  stats::Counter reply_bytes{&group, "reply_bytes", "byte",
                             "Bytes that the cache received from the network, headers included."};
  stats::Counter request_wait{&group, "request_wait", "cycle",
                              "Cycles that packets waited for the request port, summed over packets."};
  stats::Counter reply_wait{&group, "reply_wait", "cycle",
                            "Cycles from a reply's arrival to its fill, summed over replies."};
  stats::Histogram miss_latency{&group, "miss_latency", "cycle", stats::linear(0, 2048, 32),
                                "Cycles from a read that did not hit to its last sector."};
  stats::Histogram l2_latency{
      &group, "l2_latency", "cycle", stats::linear(0, 2048, 32),
      "Cycles from a read that did not hit to its last sector, where the L2 had that sector."};
  stats::Histogram dram_latency{
      &group, "dram_latency", "cycle", stats::linear(0, 2048, 32),
      "Cycles from a read that did not hit to its last sector, where that sector came from DRAM."};
  stats::Counter timed_misses{
      &group, "timed_misses", "request",
      "Number of reads that `miss_latency` counts: those that did not hit, without atomics."};
  stats::Counter miss_cycles{&group, "miss_cycles", "cycle",
                             "Sum of the latencies that `miss_latency` counts."};
  stats::Ratio mean_miss_latency{
      &group,      "mean_miss_latency", "cycle",
      miss_cycles, timed_misses,        "Mean cycles from a read that did not hit to its last sector."};
  stats::Breakdown<Stage> miss_stages{&group, "miss_stages", "cycle",
                                      "Sum of the latencies that `miss_latency` counts, by stage."};
  PrefetchStats prefetch{&group};
};

// Tells that the L1 has taken a read that counts as a miss.
struct ReadMissed {
  Client client = Client::Lsu;
  const Request& request;
};

struct Requester {
  Client client = Client::RtUnit;
  Token token = 0;  // as in its request
};

// Tells that a line has taken a place of the L1.
struct LineReplaced {
  uint32_t place = 0;
  Requester by;                   // who has asked for the line first; the RT unit where it is read ahead
  std::optional<Address> victim;  // the line that made way
};

// An accepted miss or write becomes one packet in the bounded miss queue. The packet leaves through the
// core's port when the network has room for it. Usually a line is allocated when its data arrive (streaming),
// so that only MSHRs and the miss queue limit the misses in flight. With `allocate = "on_miss"` a line is
// allocated when its miss is accepted, and held until the data arrive. Lines of instructions and constants
// pass through MSHRs and miss queue to caches of the core, which keep them. Atomics pass the cache and are
// executed by the L2; the cache drops their sectors. Model: a write covers whole sectors, and a write to a
// line on its way does not disturb the line. Model: a read that waits for a sector on its way is ready when
// the sector is, even within the hit latency. Model: local memory that is dirty at the end of a run is not
// written back, because its thread has ended.
class L1Cache final : public L1Port {
 public:
  L1Cache(const Params& params, uint16_t core, const PartitionMap& map, CorePort port, stats::Group* parent);

  bool access(Cycle now, Client client, const Request& request) override;
  Token take_answer(Client client) override;
  void tick(Cycle now) override {
    if (has_work(now)) run(now);
  }
  Cycle next_event(Cycle now) const override;
  uint32_t line_bytes() const override { return line_bytes_; }
  Cycle hit_latency() const override { return params_.hit_latency; }
  std::string describe() const override;

  const L1Stats& stats() const { return stats_; }
  Probe<ReadMissed>& read_missed() { return read_missed_; }
  Probe<LineReplaced>& line_replaced() { return line_replaced_; }
  uint32_t num_lines() const { return tags_.num_lines(); }
  // Returns the latencies of all reads, from acceptance until the token can be popped.
  const Latencies& latencies() const { return latencies_; }
  // Returns whether the cache holds no miss and no packet, and has given back the token of every accepted
  // read.
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
    uint64_t order = 0;  // number in the order of acceptance
    Token token = 0;
  };
  struct Outgoing {
    Cycle ready = 0;
    Packet packet;
  };
  // Holds the completed reads of one client; each ring is in the order in which they are ready.
  struct Answers {
    Ring<Completion> hits, fills;

    Cycle first() const {
      return std::min(hits.empty() ? kNever : hits.front().ready,
                      fills.empty() ? kNever : fills.front().ready);
    }
    Token pop();
  };

  // Returns whether a credit has come, or whether a packet may leave or a reply may be taken.
  bool has_work(Cycle now) const {
    return std::min(port_.arrival(), port_.next_credit()) <= now ||
           (!miss_queue_.empty() && miss_queue_.front().ready <= now);
  }
  void find_due();
  void run(Cycle now);
  void answer(Client client, bool is_hit, const Completion& completion);
  bool refuse(Refusal reason);
  bool take(Cycle now, Client client, const Request& request);
  bool read(Cycle now, Client client, const Request& request);
  bool miss(Cycle now, Client client, const Request& request, uint32_t slot, uint8_t missing);
  void count_read(const Request& request, uint32_t slot, uint8_t missing, uint8_t fetched);
  bool write_through(Cycle now, Client client, const Request& request);
  bool write_back(Cycle now, Client client, const Request& request);
  uint64_t bank_of(Address line) const {
    if (params_.banks == 1) [[likely]]
      return 1;
    return uint64_t{1} << uint32_t(line >> line_shift_) % params_.banks;
  }
  bool pass_atomic(Cycle now, Client client, const Request& request);
  bool queue_room(uint32_t packets) const { return miss_queue_.size() + packets <= params_.miss_queue; }
  bool queue_full() const { return !queue_room(1); }
  void queue_packet(Cycle ready, const Packet& packet);
  void evict(Cycle now, const TagArray::Line& victim);
  TagArray::Line& replace(Cycle now, Address line, Requester by);
  Cycle next_departure() const;
  Cycle next_fill() const;
  void send_front(Cycle now);
  bool fill(Cycle now);
  void hold(Cycle now, Client client, const Request& request, uint32_t slot);
  Requester first_requester(Address line) const;
  bool install(Cycle now, const Reply& reply);
  void answer_waiters(Cycle now, const Reply& reply);
  void count_miss(const Waiter& waiter, Cycle now, const Stamps& stamps);

  const L1Params params_;
  const uint32_t line_bytes_, line_shift_;  // a line has 1 << line_shift_ bytes
  const uint16_t core_;
  const bool allocate_on_miss_;
  const PartitionMap map_;
  CorePort port_;
  L1Stats stats_;
  Probe<ReadMissed> read_missed_;
  Probe<LineReplaced> line_replaced_;
  Latencies latencies_;
  TagArray tags_;
  Mshr<Waiter> mshr_;
  // Tells for each MSHR whether its line passes the cache and is not kept (instructions, constants).
  std::vector<uint8_t> passing_;
  PrefetchMarks prefetched_;
  LineSet seen_;
  Ring<Outgoing> miss_queue_;
  std::array<Answers, size_t(Client::Count)> answers_;
  Cycle port_cycle_ = kNever;  // cycle to which accesses_ and busy_banks_ belong
  uint32_t accesses_ = 0;
  uint64_t busy_banks_ = 0;
  Cycle filled_cycle_ = kNever;  // cycle of the last fill; filled_bank_ is its bank
  uint64_t filled_bank_ = 0;
  Cycle fill_not_before_ = 0;  // earliest cycle of the next fill: there is one per cycle
  // Says whether a dirty victim found the miss queue full. Fills then wait until a packet leaves.
  bool fill_blocked_ = false;
  uint64_t order_ = 0;
  uint64_t packets_sent_ = 0, sectors_requested_ = 0, sectors_received_ = 0, reads_accepted_ = 0,
           tokens_returned_ = 0;
};

}  // namespace glint::mem
