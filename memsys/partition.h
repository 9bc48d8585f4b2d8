// A memory partition: one slice of the L2 and the DRAM channel behind it, a cell of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/engine.h"
#include "base/interval_sampler.h"
#include "base/stats.h"
#include "memsys/address_map.h"
#include "memsys/cache_stats.h"
#include "memsys/dram_model.h"
#include "memsys/fan_in.h"
#include "memsys/mshr.h"
#include "memsys/packet.h"
#include "memsys/params.h"
#include "memsys/ring.h"
#include "memsys/tag_array.h"

namespace glint::mem {

// What a cycle of a partition went into: each cycle has exactly one.
enum class PartitionCycle : uint8_t { Service, MshrFull, MergeLimit, QueueFull, DramWait, Pipeline, Idle, Count };
constexpr std::string_view name_of(PartitionCycle cycle) {
  constexpr std::string_view kNames[] = {"service", "mshr_full", "merge_limit", "queue_full", "dram_wait", "pipeline", "idle"};
  return kNames[size_t(cycle)];
}

struct L2Stats : CacheStats {
  explicit L2Stats(stats::Group* parent) : CacheStats(parent, "l2") {}
  stats::Breakdown<PartitionCycle> cycles{&group, "cycles", "cycle", "What each cycle of the slice went into."};
  stats::Counter request_bytes{&group, "request_bytes", "byte", "Received from the network, headers included."};
  stats::Counter reply_bytes{&group, "reply_bytes", "byte", "Sent into the network, headers included."};
  stats::Counter request_wait{&group, "request_wait", "cycle", "Sum over packets of the cycles between arrival and service."};
  stats::Counter reply_wait{&group, "reply_wait", "cycle", "Sum over replies of the cycles they waited for the reply port."};
};

// Packets are served in order of arrival, `sectors_per_cycle` of data a cycle. The head waits while an MSHR, a merge or a
// place on the way to DRAM is missing, and all behind it wait too. Writes are validated whole sectors, kept dirty until
// eviction. Sectors found are answered in one reply, sectors from DRAM one by one as they arrive.
// Model: the queue of packets before the slice is unbounded; what bounds the traffic is the L1s' MSHRs and ports.
// Model: a fill always finds a place for its victim's write-back, which then counts against the way to DRAM.
// Model: dirty sectors left at the end of a run are not written back.
class Partition final : public Cell {
 public:
  // `requests` is this partition's inbound side, replies[c] core c's. All outlive the partition.
  Partition(const Params& params, uint32_t index, const PartitionMap& map, double core_mhz, FanIn<Packet>* requests,
            std::vector<FanIn<Reply>*> replies, stats::Group* parent);

  void advance(Cycle from, Cycle until) override;
  Cycle next_event(Cycle from) const override;
  bool finished() const override;
  uint64_t progress() const override { return packets_received_ + replies_sent_ + dram_->stats().picks.value(); }
  std::string describe_stall() const override;

  void finish(Cycle end);  // attributes the cycles up to the end of the run
  const L2Stats& stats() const { return stats_; }
  IntervalSampler& sampler() { return sampler_; }
  const DramModel& dram() const { return *dram_; }
  uint64_t packets_received() const { return packets_received_; }
  uint64_t sectors_requested() const { return sectors_requested_; }
  uint64_t sectors_replied() const { return sectors_replied_; }
  bool drained() const;

 private:
  static constexpr uint32_t kNone = TagArray::kNone;
  struct Waiter {
    Packet packet;
    uint8_t missing = 0;
  };
  struct HitReply {
    Cycle ready = 0;
    Reply reply;
    uint16_t core = 0;
  };
  struct ToDram {
    Cycle ready = 0;
    Address line = 0;
    uint8_t sectors = 0;
    bool write = false;
  };

  Cycle next_work() const;
  void step(Cycle now);
  void feed_dram(Cycle now);
  void receive_from_dram(Cycle now);
  void fill(Cycle now, const DramReturn& data);
  void serve(Cycle now);
  bool read(Cycle now, const Packet& packet);
  bool write(Cycle now, const Packet& packet);
  void answer_present(Cycle now, const Packet& packet, uint8_t missing);
  Reply reply_to(const Packet& packet, uint8_t sectors) const;
  Cycle service_cycles(const Packet& packet) const;
  void queue_for_dram(Cycle ready, Address line, uint8_t sectors, bool write);
  void evict(Cycle now, const TagArray::Line& victim);
  void send_reply(Cycle now, uint16_t core, const Reply& reply);
  Cycle head_received() const;
  uint8_t whole_atoms(uint8_t sectors) const;
  bool dram_room(uint32_t requests) const { return to_dram_.size() + requests <= params_.dram_queue; }
  PartitionCycle reason() const;
  void account(Cycle until);

  stats::Group group_;
  const L2Params params_;
  const uint32_t line_bytes_, atom_sectors_;
  const uint32_t index_;
  const Cycle dram_latency_, reply_latency_;
  const PartitionMap map_;
  FanIn<Packet>* requests_;
  std::vector<FanIn<Reply>*> replies_;
  L2Stats stats_;
  const std::unique_ptr<DramModel> dram_;
  TagArray tags_;
  Mshr<Waiter> mshr_;
  LineTable seen_;
  Port request_port_, reply_port_, core_request_port_;
  Ring<HitReply> hit_replies_;
  Ring<ToDram> to_dram_;
  Cycle busy_until_ = 0;
  Cycle accounted_ = 0;
  PartitionCycle blocked_ = PartitionCycle::Count;  // why the head could not be served; Count: it was not tried
  IntervalSampler sampler_;
  uint64_t packets_received_ = 0, sectors_requested_ = 0, sectors_replied_ = 0, replies_sent_ = 0;
};

}  // namespace glint::mem
