// Declares the interface of the policies that say how long a node keeps its test pipeline busy.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "base/registry.h"
#include "memsys/address_space.h"
#include "rtunit/traversal/ray_path.h"

namespace glint::rt {

// The kind of a node chooses the pipeline: boxes and AABBs, triangles or transforms (unit/read.h). A pipeline
// begins `units` starts in each `interval`, and the result comes `latency` after the last start of the test.
//
// Contract (tests/contract/rt_node_test_test.cpp):
//  - starts() is at least 1, and depends on the node alone.
//  - A test changes cycles, never hits.
class NodeTest {
 public:
  static constexpr PolicyKind kKind{"rt.node_test", "rtunit/node_tests"};
  struct Context {
    const mem::AddressSpace& memory;
  };
  virtual ~NodeTest() = default;
  // Returns how many starts of its pipeline the test of a node takes. The node's bytes are in memory.
  virtual uint8_t starts(const Fetch& node) const = 0;
};

}  // namespace glint::rt
