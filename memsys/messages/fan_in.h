// Models a channel that carries timestamped messages from several cells to one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/check.h"
#include "engine/engine.h"

namespace glint::mem {

// Each producer has an outbox of its own. The consumer sees all messages in order of (arrival, producer,
// sending order). This order depends only on the messages, so neither windows nor threads change it.
template <class Message>
class FanIn final : public ChannelBase {
 public:
  explicit FanIn(size_t producers) : outboxes_{Outboxes(producers), Outboxes(producers)} {}

  // Sends a message. `arrival` may not decrease from one message of a producer to its next.
  void send(size_t producer, Cycle arrival, const Message& message) {
    std::vector<Timed>& sent = outboxes_[*windows_ % 2][producer].sent;
    GLINT_DCHECK(sent.empty() || sent.back().arrival <= arrival, "messages must be sent in order");
    sent.push_back({arrival, uint32_t(producer), message});
  }

  bool ready(Cycle now) const { return arrival() <= now; }
  // Returns when the first message comes, or kNever. The reference stays valid as long as the channel.
  const Cycle& arrival() const { return arrival_; }
  const Message& front() const { return inbox_[head_].message; }
  void pop() {
    ++head_;
    find_arrival();
  }
  // Calls `visit` with the messages that have been delivered and not been taken, at most `most` of them.
  template <class Visit>
  void each_delivered(size_t most, Visit&& visit) const {
    const size_t end = std::min(inbox_.size(), head_ + most);
    for (size_t i = head_; i < end; ++i) visit(inbox_[i].message);
  }
  size_t waiting() const {
    size_t n = inbox_.size() - head_;
    for (const Outboxes& side : outboxes_)
      for (const Outbox& box : side) n += box.sent.size();
    return n;
  }

  void deliver() override {
    if (head_ == inbox_.size()) {
      inbox_.clear();
      head_ = 0;
    } else if (head_ > kCompact && head_ > inbox_.size() / 2) {  // a busy inbox may never become empty
      inbox_.erase(inbox_.begin(), inbox_.begin() + ptrdiff_t(head_));
      head_ = 0;
    }
    for (Outbox& box : outboxes_[(*windows_ + lag_) % 2]) {
      if (box.sent.empty()) continue;
      for (const Timed& timed : box.sent) insert(timed);
      box.sent.clear();
    }
    find_arrival();
  }
  Cycle next_arrival() const override {
    Cycle next = arrival();
    for (const Outboxes& side : outboxes_)
      for (const Outbox& box : side)
        if (!box.sent.empty()) next = std::min(next, box.sent.front().arrival);
    return next;
  }
  bool follow(const uint64_t* windows) override {
    windows_ = windows;
    lag_ = 1;
    return true;
  }

 private:
  static constexpr size_t kCompact = 256;
  struct Timed {
    Cycle arrival;
    uint32_t producer;
    Message message;
    bool before(const Timed& o) const {
      return arrival != o.arrival ? arrival < o.arrival : producer < o.producer;
    }
  };
  // Has a cache line of its own, because producers run on different threads.
  struct alignas(64) Outbox {
    std::vector<Timed> sent;
  };
  using Outboxes = std::vector<Outbox>;
  static constexpr uint64_t kNoWindow = 0;

  void find_arrival() { arrival_ = head_ < inbox_.size() ? inbox_[head_].arrival : kNever; }
  // Inserts a message from the back, because the messages of one window lie close together in time.
  void insert(const Timed& timed) {
    inbox_.push_back(timed);
    size_t i = inbox_.size() - 1;
    for (; i > head_ && timed.before(inbox_[i - 1]); --i) inbox_[i] = inbox_[i - 1];
    inbox_[i] = timed;
  }

  // Producers fill one side in even windows and the other one in odd windows. A consumer that follows the
  // windows takes what lies in the other side, which nobody fills meanwhile.
  Outboxes outboxes_[2];
  const uint64_t* windows_ = &kNoWindow;
  uint64_t lag_ = 0;  // 1 when the consumer takes the messages of the window before
  std::vector<Timed> inbox_;
  size_t head_ = 0;
  Cycle arrival_ = kNever;  // of the first message in the inbox
};

}  // namespace glint::mem
