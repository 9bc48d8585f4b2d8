// Declares the parts of simulated time: cells, which advance on their own for a window of cycles, and
// channels, which carry timestamped messages between cells.
//
// A window is no longer than the shortest latency of a channel, so every message that a cell needs in a
// window was sent before the window began. Cells may therefore advance in any order or in parallel, and the
// result is the same (docs/architecture.md, D6).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/check.h"
#include "base/types.h"

namespace glint {

// Shows the engine's side of a channel, which hands over the messages between two windows.
class ChannelBase {
 public:
  virtual ~ChannelBase() = default;
  // Makes the messages that were sent in the last window visible to the consumer.
  virtual void deliver() = 0;
  // Lets the consumer call deliver() while producers already send messages of the next window. `windows`
  // counts windows, and it changes between two windows only. Returns whether the channel can do that.
  virtual bool follow(const uint64_t* windows) { return static_cast<void>(windows), false; }
  // Returns the earliest arrival of all messages, delivered or not. Returns kNever when there are none.
  virtual Cycle next_arrival() const = 0;
};

// Carries messages from one cell to one other, in the order of their arrival times. The producer calls
// send(), and the consumer calls the other functions.
template <class Message>
class Channel final : public ChannelBase {
 public:
  // Sends a message. `arrival` may not decrease from one message to the next, and it is at least the latency
  // of the channel ahead of the present cycle.
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
  std::vector<Timed> inbox_, sent_;  // They keep their capacity, so that sending soon stops allocating.
  size_t head_ = 0;
};

// Simulates a part of the machine with its own state, such as a core with its L1 and RT unit, or a memory
// partition.
class Cell {
 public:
  virtual ~Cell() = default;
  // Simulates the cycles [from, until). It reads only the cell's own state and delivered messages.
  virtual void advance(Cycle from, Cycle until) = 0;
  // Returns the earliest cycle >= `from` in which the cell has work even if no new message comes. Returns
  // kNever when it has none.
  virtual Cycle next_event(Cycle from) const = 0;
  // Tells whether the cell holds no work at all.
  virtual bool finished() const = 0;
  // Returns a count that grows whenever anything in the cell has moved. The watchdog reads it.
  virtual uint64_t progress() const = 0;
  // Returns lines of text that say what the cell waits for.
  virtual std::string describe_stall() const = 0;
};

}  // namespace glint
