// Models a slice of the L2: a cache with a port of the network, in front of its partition's DRAM channel.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/stats.h"
#include "memsys/address_map.h"
#include "memsys/cache/cache_stats.h"
#include "memsys/cache/mshr.h"
#include "memsys/cache/tag_array.h"
#include "memsys/dram_model.h"
#include "memsys/messages/network_port.h"
#include "memsys/messages/packet.h"
#include "memsys/params.h"
#include "memsys/ring.h"

namespace glint::mem {

// Says what a cycle of a slice went into. Each cycle has exactly one reason.
enum class SliceCycle : uint8_t { Service, MshrFull, MergeLimit, QueueFull, DramWait, Pipeline, Idle, Count };
constexpr std::string_view name_of(SliceCycle cycle) {
  constexpr std::string_view kNames[] = {"service",   "mshr_full", "merge_limit", "queue_full",
                                         "dram_wait", "pipeline",  "idle"};
  static_assert(std::size(kNames) == size_t(SliceCycle::Count));
  return kNames[size_t(cycle)];
}

struct L2Stats : CacheStats {
  L2Stats(stats::Group* parent, const std::string& name) : CacheStats(parent, name) {}
  stats::Breakdown<SliceCycle> cycles{&group, "cycles", "cycle",
                                      "Number of cycles of the slice, by what they went into."};
  stats::Counter request_bytes{&group, "request_bytes", "byte",
                               "Bytes that the slice received from the network, headers included."};
  stats::Counter reply_bytes{&group, "reply_bytes", "byte",
                             "Bytes that the slice sent into the network, headers included."};
  stats::Counter request_wait{&group, "request_wait", "cycle",
                              "Cycles from a packet's arrival to its service, summed over packets."};
  stats::Counter reply_wait{&group, "reply_wait", "cycle",
                            "Cycles that replies waited for the reply port, summed over replies."};
  stats::Counter dram_reads{&group, "dram_reads", "request",
                            "Number of reads that went to the DRAM channel."};
  stats::Counter dram_writes{&group, "dram_writes", "request",
                             "Number of writes that went to the DRAM channel."};
  stats::Counter partial_writes{&group, "partial_writes", "sector",
                                "Number of sectors written in part that the slice did not hold."};
  stats::Counter completed_sectors{&group, "completed_sectors", "sector",
                                   "Number of sectors written in part whose other bytes came from DRAM."};
};

// Says what leaves a line in a cache that takes no time.
enum class Touch : uint8_t { Read, Write };

// Says what becomes of dirty lines that make way for such a line: DRAM never gets them, or they are written
// back one by one, each when the next line comes into the slice whose own victim is clean.
enum class Displaced : uint8_t { Lost, WrittenLater };

// Describes a request on its way from a slice to the DRAM scheduler.
struct ToDram {
  Cycle ready = 0;
  Address line = 0;
  uint8_t sectors = 0;
  bool write = false;
};

// Holds what a slice keeps from one launch to the next.
struct L2Contents {
  TagArray tags;
  std::vector<WordMask> words;  // words written in sectors that are dirty and not valid, by slot
  LineSet seen;
};

// Packets are served in order of arrival, with `sectors_per_cycle` sectors of data per cycle. The oldest
// packet waits while it needs an MSHR, a merge or an entry of the queue to DRAM and none is free. All packets
// behind it wait, too. Sectors that a write covers are valid at once. Of a sector that is written in part,
// the slice keeps the words that were written until eviction, and fetches the sector when it is read. One
// reply has all sectors that were found. Sectors from DRAM are answered as they arrive. Model: a fill always
// finds an entry in the queue to DRAM for the write-back of its victim. Model: a sector that is written in
// part takes as long in DRAM as a whole one (data mask, no read-modify-write). Model: dirty sectors left at
// the end of a run are not written back.
class L2Slice {
 public:
  L2Slice(const Params& params, uint32_t index, const PartitionMap& map, SlicePort port, stats::Group* parent,
          const std::string& name);

  // Brings what the next packets need near to the host's core. It is called at the start of each window,
  // since other cells have used the host's caches in the meantime.
  void prefetch() const;

  // The partition calls fill(), send_ready_replies() and serve() in this order in each cycle in which it has
  // work: the last stage comes first.
  void fill(Cycle now, const DramReturn& data);
  void send_ready_replies(Cycle now);
  void serve(Cycle now);
  // Returns the next cycle with a reply or a packet to handle. The partition knows when DRAM has work.
  Cycle next_work() const;
  void account(Cycle until, bool dram_works);

  // Takes what the slice holds after a launch, and gives it to the same slice of the machine of the next.
  L2Contents take_contents() { return {std::move(tags_), std::move(words_), std::move(seen_)}; }
  void put_contents(L2Contents&& contents) {
    tags_ = std::move(contents.tags), words_ = std::move(contents.words), seen_ = std::move(contents.seen);
  }

  // Does MemorySystem::warm().
  uint32_t warm(Address line, uint8_t sectors, Touch touch, Displaced displaced);
  // Does MemorySystem::share_with().
  void share_with(uint32_t others) { others_ = others; }
  uint64_t dirty_sectors() const;  // number of sectors that it holds and DRAM has not got yet

  Ring<ToDram>& to_dram() { return to_dram_; }
  const Ring<ToDram>& to_dram() const { return to_dram_; }
  Address local(Address address) const { return map_.local(address, index_); }

  const L2Stats& stats() const { return stats_; }
  uint64_t packets_received() const { return packets_received_; }
  uint64_t sectors_requested() const { return sectors_requested_; }
  uint64_t sectors_replied() const { return sectors_replied_; }
  uint64_t progress() const { return packets_received_ + replies_sent_; }
  bool finished() const;
  // Returns the end of the last write or atomic that has no answer.
  Cycle written_until() const { return written_until_; }
  std::string describe(bool dram_works) const;

 private:
  static constexpr uint32_t kNone = TagArray::kNone;
  struct Waiter {
    Packet packet;
    uint8_t missing = 0;
  };
  struct DirtyLine {
    Address line = 0;
    uint8_t sectors = 0;
  };
  struct HitReply {
    Cycle ready = 0;
    Reply reply;
  };

  bool read(Cycle now, const Packet& packet);
  bool write(Cycle now, const Packet& packet);
  uint8_t whole_sectors(const Packet& packet, uint32_t slot, uint8_t valid);
  void answer_present(Cycle now, const Packet& packet, uint8_t missing);
  Reply reply_to(const Packet& packet, uint8_t sectors) const;
  Cycle service_parts(const Packet& packet) const;
  Cycle read_parts(uint8_t sectors) const;
  Cycle write_parts(const Packet& packet) const;
  void occupy(Cycle now, const Packet& packet);
  Cycle sector_cycles(uint8_t sectors) const {
    return (num_sectors(sectors) + params_.sectors_per_cycle - 1) / params_.sectors_per_cycle;
  }
  void queue_for_dram(Cycle ready, Address line, uint8_t sectors, bool write);
  uint8_t sectors_leaving(const TagArray::Line& victim) const;
  void touch_others(const Packet& packet);
  void evict(Cycle now, const TagArray::Line& victim);
  void send_reply(Cycle now, const Reply& reply);
  Cycle head_received() const;
  uint8_t whole_atoms(uint8_t sectors) const;
  bool dram_room(uint32_t requests) const { return to_dram_.size() + requests <= params_.dram_queue; }
  SliceCycle reason(bool dram_works) const;

  static constexpr Cycle kParts = 16;  // number of parts of a cycle

  const L2Params params_;
  const Cycle read_parts_, read_visit_parts_, atomic_visit_parts_;
  const Cycle visit_parts_, partial_parts_, turn_parts_, whole_parts_, float_parts_, lane_parts_,
      answer_parts_;
  const uint32_t line_bytes_, atom_sectors_;
  const uint32_t index_;
  const Cycle dram_latency_;
  const PartitionMap map_;
  SlicePort port_;
  L2Stats stats_;
  TagArray tags_;
  std::vector<WordMask> words_;  // words written in sectors that are dirty and not valid, by slot
  Mshr<Waiter> mshr_;
  LineSet seen_;
  Ring<HitReply> hit_replies_;
  Ring<ToDram> to_dram_;
  Ring<DirtyLine> displaced_;  // by warm() or touch_others(); they are still to be written back
  uint32_t others_ = 0;        // see MemorySystem::share_with()
  Cycle busy_until_ = 0;
  Cycle busy_parts_ = 0;               // busy_until_ in parts of a cycle, before it was rounded up
  Address atomic_line_ = ~Address{0};  // line of the last atomic
  Cycle written_until_ = 0;
  Cycle accounted_ = 0;
  SliceCycle blocked_ = SliceCycle::Count;  // why the oldest packet was refused; Count: it was not tried
  uint64_t packets_received_ = 0, sectors_requested_ = 0, sectors_replied_ = 0, replies_sent_ = 0;
};

}  // namespace glint::mem
