// Interface: takes the requests of a core's units to the L1 data cache and gives their answers back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
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
//  - The tokens of one client come back in the order in which they are ready; of tokens ready in the same
//    cycle, the one that was accepted first comes first.
class L1Port {
 public:
  virtual ~L1Port() = default;
  virtual bool access(Cycle now, Client client, const Request& request) = 0;
  virtual std::optional<Token> pop(Cycle now, Client client) = 0;
  // Returns whether pop() has a token to give back.
  virtual bool has_answer(Cycle now, Client client) const = 0;
  virtual void tick(Cycle now) = 0;
  virtual Cycle next_event(Cycle now) const = 0;  // is kNever when nothing is in flight
  virtual uint32_t line_bytes() const = 0;
  // Returns lines of text that say what is in flight and what waits for it, to explain a machine that is
  // stuck. The text is empty when nothing is in flight.
  virtual std::string describe() const { return {}; }
};

}  // namespace glint::mem
