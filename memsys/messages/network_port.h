// Models one end of the network, at which a core or a slice sends messages and takes those that have come.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/types.h"
#include "memsys/messages/fan_in.h"
#include "memsys/messages/link.h"
#include "memsys/messages/packet.h"
#include "memsys/network.h"

namespace glint::mem {

// Says where a port hands a message to.
template <class Message>
struct Route {
  FanIn<Message>* inbox = nullptr;
  Cycle latency = 0;       // cycles from the end of the message's time in the port to its arrival
  uint16_t allowance = 0;  // number of the sender's count of credits that pays for the message
};

// Holds what a network connects a port to.
template <class Sent, class Received>
struct PortWiring {
  uint16_t index = 0;                 // the port's number as a producer in the inboxes that it sends to
  uint32_t send_bytes = 0;            // bytes per cycle that the port sends
  uint32_t receive_bytes = 0;         // bytes per cycle that the port receives
  uint32_t incoming_bytes = 0;        // bytes per cycle of the link by which messages come
  std::vector<Route<Sent>> routes{};  // by destination
  FanIn<Received>* inbox = nullptr;   // messages to this port
  std::vector<uint32_t> credits{};  // credits at the start, by Route::allowance; empty: there is always room
  FanIn<Credit>* credit_inbox = nullptr;  // credits to this port; null when `credits` is empty
  std::vector<Route<Credit>>
      returns{};  // where the credit of a taken message goes, by source; empty: nowhere
};

// Messages leave in the order in which they are sent, one after another, each when the network has given a
// credit for it. Messages to this port are received one after another, in order of (arrival, producer).
template <class Sent, class Received>
class NetworkPort {
 public:
  explicit NetworkPort(PortWiring<Sent, Received> wiring)
      : wiring_(std::move(wiring)),
        credits_(wiring_.credits),
        send_link_(wiring_.send_bytes),
        receive_link_(wiring_.receive_bytes),
        incoming_link_(wiring_.incoming_bytes) {}

  // Returns the first cycle, not before `ready`, in which a message to `destination` can start to leave. It
  // is kNever when the message needs a credit that has not come.
  Cycle departure(Cycle ready, uint16_t destination) const {
    if (!credits_.empty()) [[unlikely]]
      if (credits_[wiring_.routes[destination].allowance] == 0) return kNever;
    return std::max({ready, send_link_.free_at(), last_credit_});
  }
  // Sends a message for which there is a credit. The message starts to leave at `now` or, behind others, when
  // the port is free. Returns the cycle in which it starts.
  Cycle send(Cycle now, const Sent& message) {
    const Route<Sent>& route = wiring_.routes[destination_of(message)];
    const Cycle start = std::max(now, send_link_.free_at());
    const Cycle tail = send_link_.leave(now, bytes_of(message));
    route.inbox->send(wiring_.index, tail + route.latency, message);
    if (!credits_.empty()) --credits_[route.allowance];
    return start;
  }
  // Takes the credits that have come. It is called at each next_credit(), before departure().
  void take_credits(Cycle now) {
    for (; next_credit() <= now; wiring_.credit_inbox->pop()) {
      last_credit_ = next_credit();
      ++credits_[wiring_.credit_inbox->front().allowance];
    }
  }
  bool has_credits() const { return wiring_.credit_inbox != nullptr; }
  Cycle next_credit() const {
    if (wiring_.credit_inbox) [[unlikely]]
      return wiring_.credit_inbox->arrival();
    return kNever;
  }

  // Return, of the oldest message, the cycle in which its tail arrived, and the cycle in which the port has
  // received all of it. Both are kNever when there is no message.
  const Cycle& arrival() const { return wiring_.inbox->arrival(); }
  Cycle received() const {
    if (arrival() == kNever) return kNever;
    const uint32_t bytes = bytes_of(front());
    return receive_link_.received_at(arrival(), incoming_link_.cycles(bytes), bytes);
  }
  const Received& front() const { return wiring_.inbox->front(); }
  // Calls `visit` with the next messages that come to this port, as far as they have been delivered.
  template <class Visit>
  void each_coming(size_t most, Visit&& visit) const {
    wiring_.inbox->each_delivered(most, visit);
  }
  // Takes the oldest message, which has been received, and returns its credit to the network.
  void take(Cycle now) {
    receive_link_.occupy_until(received());
    if (!wiring_.returns.empty()) {
      const Route<Credit>& route = wiring_.returns[source_of(front())];
      // A credit takes a cycle of a port as any message does: a window may be as long as the shortest way.
      route.inbox->send(wiring_.index, now + 1 + route.latency, {route.allowance});
    }
    wiring_.inbox->pop();
  }
  // Returns the number of messages on their way to this port, as far as its inbox knows them.
  size_t waiting() const { return wiring_.inbox->waiting(); }

 private:
  PortWiring<Sent, Received> wiring_;
  std::vector<uint32_t> credits_;
  Link send_link_, receive_link_;
  Link incoming_link_;  // tells only how long a message took on the link before
  Cycle last_credit_ = 0;
};

}  // namespace glint::mem
