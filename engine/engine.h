// Simulated time: cells that advance on their own for a window, and channels of timestamped messages between
// them.
//
// The window is no longer than the shortest channel latency, so what a cell needs in a window was sent before
// it: cells may advance in any order or in parallel and the result is the same (docs/architecture.md, D6).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/check.h"
#include "base/types.h"

namespace glint {

// Handed over between windows by the engine.
class ChannelBase {
 public:
  virtual ~ChannelBase() = default;
  virtual void deliver() = 0;              // what was sent in the last window becomes visible
  virtual Cycle next_arrival() const = 0;  // of delivered and undelivered messages; kNever when empty
};

// Messages from one cell to one other, in order of arrival time. send() is the producer's, the rest the
// consumer's.
template <class Message>
class Channel final : public ChannelBase {
 public:
  // `arrival` may not decrease from one send to the next, and is at least the channel's latency ahead.
  void send(Cycle arrival, const Message& message) {
    GLINT_DCHECK(sent_.empty() || sent_.back().arrival <= arrival, "messages must be sent in order");
    sent_.push_back({arrival, message});
  }
  bool ready(Cycle now) const { return head_ < inbox_.size() && inbox_[head_].arrival <= now; }
  Cycle arrival() const { return head_ < inbox_.size() ? inbox_[head_].arrival : kNever; }
  const Message& front() const { return inbox_[head_].message; }
  void pop() { ++head_; }
  size_t waiting() const { return inbox_.size() - head_ + sent_.size(); }

  void deliver() override {
    if (head_ == inbox_.size()) {
      inbox_.clear();
      head_ = 0;
    }
    inbox_.insert(inbox_.end(), sent_.begin(), sent_.end());
    sent_.clear();
  }
  Cycle next_arrival() const override {
    if (head_ < inbox_.size()) return inbox_[head_].arrival;
    return sent_.empty() ? kNever : sent_.front().arrival;
  }

 private:
  struct Timed {
    Cycle arrival;
    Message message;
  };
  std::vector<Timed> inbox_, sent_;  // capacity is kept: no heap once warm
  size_t head_ = 0;
};

// A part of the machine with its own state: a core with its L1 and RT unit, a memory partition.
class Cell {
 public:
  virtual ~Cell() = default;
  // Simulates cycles [from, until). Reads only its own state and delivered messages.
  virtual void advance(Cycle from, Cycle until) = 0;
  // Earliest cycle >= `from` at which it has work without new messages; kNever when idle.
  virtual Cycle next_event(Cycle from) const = 0;
  virtual bool finished() const = 0;      // holds no work at all
  virtual uint64_t progress() const = 0;  // grows whenever anything moved: the watchdog reads it
  virtual std::string describe_stall() const = 0;
};

}  // namespace glint
