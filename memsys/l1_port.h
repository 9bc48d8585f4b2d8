// Interface: takes the requests of a core's units to the L1 data cache and gives their answers back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "base/types.h"
#include "memsys/request.h"

namespace glint::mem {

// Names who asks the L1. Each client has its own queue of completed reads.
enum class Client : uint8_t { Lsu, RtUnit, Code, Count };

// Contract (tests/contract/memsys/l1_port_test.cpp):
//  - access() takes a request or refuses it, because a port, a bank, the MSHRs or a queue are full in this
//    cycle. A refused request changes nothing and may be tried again in a later cycle.
//  - Every accepted read gives its token back exactly once: a hit after exactly the hit latency, any other
//    read when its last sector has arrived. Writes and prefetches give nothing back.
//  - Reads of instructions and constants take no port and no bank, and their lines are not kept.
//  - A port that calls neither set_due() nor set_input() is due in every cycle.
//  - The tokens of one client come back in the order in which they are ready; of tokens ready in the same
//    cycle, the one that was accepted first comes first.
class L1Port {
 public:
  virtual ~L1Port() = default;
  virtual bool access(Cycle now, Client client, const Request& request) = 0;
  // Returns whether pop() has a token to give back. It is no virtual call, because units ask in every cycle.
  bool has_answer(Cycle now, Client client) const { return answer_at(client) <= now; }
  // Takes the client's first answer and returns its token, or none when no answer has come by `now`.
  std::optional<Token> pop(Cycle now, Client client) {
    if (!has_answer(now, client)) return std::nullopt;
    return take_answer(client);
  }
  // Does the same for an answer that has come.
  virtual Token take_answer(Client client) = 0;
  // Returns whether tick() may have something to do. It is no virtual call, because the core asks in every
  // cycle.
  bool is_due(Cycle now) const { return std::min(due_, *input_at_) <= now; }
  // Advances to `now`. The core calls it in every cycle in which is_due() holds.
  virtual void tick(Cycle now) = 0;
  virtual Cycle next_event(Cycle now) const = 0;  // is kNever when nothing is in flight
  virtual uint32_t line_bytes() const = 0;
  // Returns the cycles from a read that hits to its answer.
  virtual Cycle hit_latency() const = 0;
  // Returns lines of text that say what is in flight and what waits for it, to explain a machine that is
  // stuck. The text is empty when nothing is in flight.
  virtual std::string describe() const { return {}; }

 protected:
  L1Port() { own_answers_at_.fill(kNever); }
  L1Port(const L1Port&) = delete;
  L1Port& operator=(const L1Port&) = delete;
  // Return and note when the client's first answer comes. With kNever, none is known.
  Cycle answer_at(Client client) const { return (*answers_at_)[size_t(client)]; }
  void set_answer_at(Client client, Cycle at) { own_answers_at_[size_t(client)] = at; }
  // Sets the first cycle with work of the port's own, and the place that tells when input comes. The latter
  // outlives the port.
  void set_due(Cycle due) { due_ = due; }
  void set_input(const Cycle& at) { input_at_ = &at; }
  // Lets the answers of `other`, which outlives this port, be those of this port.
  void share_answers(const L1Port& other) { answers_at_ = other.answers_at_; }

 private:
  using Times = std::array<Cycle, size_t(Client::Count)>;  // by client
  Times own_answers_at_;
  const Times* answers_at_ = &own_answers_at_;
  Cycle due_ = 0;
  static constexpr Cycle kNoInput = kNever;
  const Cycle* input_at_ = &kNoInput;
};

}  // namespace glint::mem
