// The door between a core's units and its L1 data cache.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "base/types.h"
#include "memsys/request.h"

namespace glint::mem {

enum class Client : uint8_t { Lsu, RtUnit, Code, Count };  // each has its own queue of completions

// Contract (tests/contract/l1_port_test.cpp):
//  - access() takes a request or refuses it (port, bank, MSHR or queue full this cycle); a refused request
//  has
//    changed nothing and may be tried again in a later cycle.
//  - every accepted read gives its token back exactly once: after exactly the hit latency on a hit, when its
//  last
//    sector has arrived otherwise. Writes give nothing back.
//  - reads of instructions and constants take none of its ports and banks, and it keeps none of their lines.
//  - tokens of one client come back in order of readiness, ties in order of acceptance.
class L1Port {
 public:
  virtual ~L1Port() = default;
  virtual bool access(Cycle now, Client client, const Request& request) = 0;
  virtual std::optional<Token> pop(Cycle now, Client client) = 0;
  virtual void tick(Cycle now) = 0;
  virtual Cycle next_event(Cycle now) const = 0;  // kNever when nothing is in flight here
  virtual uint32_t line_bytes() const = 0;
  // Lines on what is on the way and for whom it waits, for a machine that is stuck; "" when there is nothing
  // to say.
  virtual std::string describe() const { return {}; }
};

}  // namespace glint::mem
