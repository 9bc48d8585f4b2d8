// Chooses which lanes read which node, sends the requests to the L1 and takes the answers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "memsys/address_space.h"
#include "memsys/l1_port.h"
#include "memsys/request.h"
#include "memsys/ring.h"
#include "rtunit/params.h"
#include "rtunit/unit/lane_treelets.h"
#include "rtunit/unit/request_source.h"
#include "rtunit/unit/warp_buffer.h"

namespace glint::rt {

// Describes a read on its way for some lanes of one warp. Its index in the queue is the token of its
// requests.
struct ReadInFlight {
  static constexpr uint32_t kNone = ~0u;
  uint32_t slot = 0;
  LaneMask lanes = 0;
  Read read;
  uint32_t sent = 0;        // bytes that requests have been sent for
  uint32_t unanswered = 0;  // requests that have not been answered
  uint32_t next = kNone;    // another warp's lanes that share it
  bool is_complete() const { return unanswered == 0 && sent >= read.what.bytes; }
};

// Is told of the requests that rays need, and knows what is read ahead of them.
class DemandListener {
 public:
  virtual ~DemandListener() = default;
  // Tells that the L1 has taken a request for `bytes` from the virtual address on.
  virtual void demanded(Address from, uint32_t bytes, Cycle now) = 0;
  virtual TreeletId treelet_ahead() const = 0;
};

class FetchQueue final : public RequestSource, private WantedNodes {
 public:
  FetchQueue(const Params& params, const mem::AddressSpace& memory, mem::L1Port& l1, WarpBuffer& buffer,
             RtStats& stats);

  // Sets who is told of each request. At most one part is.
  void set_listener(DemandListener& listener) { listener_ = &listener; }

  // Takes a node that some lane wants, for all lanes that share the read. Returns false when no lane wants
  // one or no entry is free.
  bool choose(Cycle now);
  // Returns whether the L1 has not taken all requests of the chosen node yet.
  bool has_request(Cycle) const override { return sending_ != ReadInFlight::kNone; }
  bool send(Cycle now) override;
  bool has_reads_waiting() const override { return buffer_.has_wanting_lanes(); }
  Cycle next_event(Cycle now) const override {
    if (has_request(now) || (!is_full() && has_reads_waiting())) return now + 1;
    return sure_hits_.empty() ? kNever : sure_hits_.front().ready;
  }

  // Makes an entry for a read of one request that another part of the unit sends. Returns the request's
  // token.
  mem::Token open(uint32_t slot, int lane);
  // Takes the entry back, because the L1 has refused the request.
  void cancel(mem::Token token);
  bool is_full() const {
    if (max_reads_ != 0) [[unlikely]]
      return num_reads_ >= max_reads_;
    return false;
  }
  uint32_t num_reads() const { return num_reads_; }

  // Takes the L1's answers and calls deliver(read, slot, lanes) for each warp whose read is complete.
  template <class Deliver>
  void receive(Cycle now, Deliver&& deliver) {
    for (uint32_t i = 0; i < responses_per_cycle_; ++i) {
      const std::optional<mem::Token> token = next_answer(now);
      if (!token) return;
      --reads_[*token].unanswered;
      if (!reads_[*token].is_complete()) continue;
      --num_reads_;
      for (uint32_t index = *token; index != ReadInFlight::kNone;) {
        const ReadInFlight& read = reads_[index];
        free_.push_back(index);
        index = read.next;
        deliver(reads_[*token].read, read.slot, read.lanes);
      }
    }
  }
  // Calls each(slot, lanes) for all lanes that the read is for.
  template <class Each>
  void for_each_reader(mem::Token token, Each&& each) const {
    for (auto i = uint32_t(token); i != ReadInFlight::kNone; i = reads_[i].next)
      each(reads_[i].slot, reads_[i].lanes);
  }

 private:
  struct SureHit {
    Cycle ready = 0;
    mem::Token token = 0;
  };
  std::optional<mem::Token> next_answer(Cycle now) {
    if (sure_hits_.empty() || sure_hits_.front().ready > now) [[likely]]
      return l1_.pop(now, mem::Client::RtUnit);
    const mem::Token token = sure_hits_.front().token;
    sure_hits_.pop();
    return token;
  }
  bool ask(Cycle now);
  LaneMask lanes(uint32_t warp) const override { return buffer_[warp].wanting; }
  const Fetch& node(uint32_t warp, int lane) const override { return buffer_[warp].read[size_t(lane)].what; }
  TreeletId treelet(uint32_t warp, int lane) const override {
    return treelets_.of(warp, lane, node(warp, lane).address);
  }
  TreeletId treelet_ahead() const override { return listener_ ? listener_->treelet_ahead() : kNoTreelet; }
  bool has_ready_warp(Cycle now);
  void prepare_request();
  uint32_t add(uint32_t slot, LaneMask lanes, const Read& read);
  static LaneMask lanes_wanting(const BufferSlot& slot, const Fetch& what);

  const uint32_t max_reads_, responses_per_cycle_, request_bytes_;  // max_reads_ 0: no limit
  const uint32_t line_bytes_;
  const bool always_hits_;        // rt.oracle.fetch_hits
  mem::Ring<SureHit> sure_hits_;  // answers of such reads, in order
  const std::string scheduler_name_;
  const mem::AddressSpace& memory_;
  mem::L1Port& l1_;
  WarpBuffer& buffer_;
  RtStats& stats_;
  DemandListener* listener_ = nullptr;
  mutable LaneTreelets treelets_;
  const std::unique_ptr<RayScheduler> scheduler_;
  const std::unique_ptr<Coalescer> coalescer_;
  std::vector<WarpView> views_;      // by slot; has_ready_warp() keeps them up to date
  uint64_t ready_ = 0;               // bit i: views_[i] is ready
  std::vector<ReadInFlight> reads_;  // at most one per lane
  std::vector<uint32_t> free_;
  uint32_t sending_ = ReadInFlight::kNone;
  mem::Request request_;                      // the next one of the read that is being sent
  uint32_t num_sectors_ = 0, num_bytes_ = 0;  // of request_
  uint32_t num_reads_ = 0;                    // A read that warps share counts as one.
};

}  // namespace glint::rt
