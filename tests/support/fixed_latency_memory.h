// Models a memory for tests of other parts: every read is answered after the same number of cycles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "memsys/l1_port.h"

namespace glint::mem {

// Refuses nothing except beyond `accesses_per_cycle`, and remembers every accepted request. It meets the
// contract of L1Port.
class FixedLatencyMemory final : public L1Port {
 public:
  explicit FixedLatencyMemory(Cycle latency, uint32_t accesses_per_cycle = ~0u, uint32_t line_bytes = 128)
      : latency_(latency), accesses_per_cycle_(accesses_per_cycle), line_bytes_(line_bytes) {}

  bool access(Cycle now, Client client, const Request& request) override {
    if (now != cycle_) cycle_ = now, accesses_ = 0;
    if (accesses_ == accesses_per_cycle_) {
      ++refused_;
      return false;
    }
    ++accesses_;
    log_.push_back(request);
    const bool is_answered = !request.write && request.traffic != Traffic::RtPrefetch;
    if (is_answered && swallows_)
      ++swallowed_;
    else if (is_answered)
      ready_[size_t(client)].push_back({now + latency_, request.token});
    note_first(client);
    return true;
  }
  Token take_answer(Client client) override {
    std::deque<Answer>& queue = ready_[size_t(client)];
    const Token token = queue.front().token;
    queue.pop_front();
    note_first(client);
    return token;
  }
  void tick(Cycle) override {}
  Cycle next_event(Cycle now) const override {
    Cycle next = kNever;
    for (const std::deque<Answer>& queue : ready_)
      if (!queue.empty() && queue.front().at < next) next = queue.front().at;
    return next < now ? now : next;
  }
  uint32_t line_bytes() const override { return line_bytes_; }
  Cycle hit_latency() const override { return 1; }

  // Takes reads from now on and never answers them.
  void swallow() { swallows_ = true; }
  std::string describe() const override {
    return fmt::format("  memory: {} reads never answered\n", swallowed_);
  }

  const std::vector<Request>& log() const { return log_; }  // accepted requests, in order
  uint64_t refused() const { return refused_; }

 private:
  struct Answer {
    Cycle at;
    Token token;
  };
  void note_first(Client client) {
    const std::deque<Answer>& queue = ready_[size_t(client)];
    set_answer_at(client, queue.empty() ? kNever : queue.front().at);
  }

  Cycle latency_;
  uint32_t accesses_per_cycle_, line_bytes_;
  Cycle cycle_ = kNever;
  uint32_t accesses_ = 0;
  uint64_t refused_ = 0, swallowed_ = 0;
  bool swallows_ = false;
  std::array<std::deque<Answer>, size_t(Client::Count)> ready_;
  std::vector<Request> log_;
};

}  // namespace glint::mem
