// Interface: brings the messages of cores and L2 slices to each other.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/registry.h"
#include "base/types.h"
#include "engine/engine.h"

namespace glint::mem {

struct NocParams;
struct Packet;
struct Reply;
template <class Sent, class Received>
class NetworkPort;
using CorePort = NetworkPort<Packet, Reply>;   // the end of a core (messages/network_port.h)
using SlicePort = NetworkPort<Reply, Packet>;  // the end of a slice of the L2

// A network makes one port for each core and each slice. The port belongs to the cell of its user, and the
// network keeps the channels between the ports, and routers in cells of their own where it has any.
//
// Contract (tests/contract/memsys/network_test.cpp):
//  - every message that a port has sent comes to the port of its destination once, with its contents;
//  - messages from one source to one destination come in the order in which they were sent;
//  - a core's port refuses packets (departure() is kNever) when too many of its packets are on their way, and
//    accepts one again after slices have taken some. A slice's port always accepts replies;
//  - packets make progress as long as slices take them, also while cores take no replies;
//  - cells share nothing but the channels, and no message arrives sooner than shortest_latency() after the
//    cycle in which it was sent: windows, threads and the order of cells change nothing;
//  - there is no heap traffic once the network is warm.
class Network {
 public:
  static constexpr PolicyKind kKind{"memory.noc.topology", "memsys/networks"};
  struct Context {
    const NocParams& params;  // need not outlive the construction
    uint32_t cores = 1, slices = 1;
  };

  virtual ~Network() = default;
  // Each port is made once. The network outlives it.
  virtual CorePort core_port(uint16_t core) = 0;
  virtual SlicePort slice_port(uint16_t slice) = 0;
  virtual std::vector<Cell*> cells() { return {}; }
  virtual std::vector<ChannelBase*> channels() = 0;
  // Returns those of the channels whose messages only a core, or a slice, receives: those of each core and
  // those of each slice. What is not there is delivered between windows.
  struct Inputs {
    std::vector<std::vector<ChannelBase*>> of_core, of_slice;
  };
  virtual Inputs inputs() { return {}; }
  virtual Cycle shortest_latency() const = 0;  // at least 1
};

}  // namespace glint::mem
