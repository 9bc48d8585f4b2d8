// Declares the interface of the policies that choose how internal nodes are written.
//
// A format is one file in rtunit/formats/. Its class says how nodes are written and tested, and
// rtunit/traversal/format_of.h compiles the traversal for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "base/registry.h"
#include "memsys/host_block.h"
#include "rtunit/structure/structure.h"
#include "rtunit/structure/tree.h"
#include "rtunit/tree_layout.h"

namespace glint::mem {
class AddressSpace;
}

namespace glint::rt {

struct RayState;

// The largest number of children of a node in any format.
inline constexpr uint32_t kMaxWidth = 16;

// Describes a child as it was found in encoded bytes. Validation and tools use it, the traversal does not.
struct DecodedChild {
  NodeRef node = 0;
  Bounds bounds;  // as the traversal sees it
};

// Holds the traversal as it is compiled for a format (rtunit/traversal/format_of.h).
struct NodeWalk {
  FormatId format;
  uint32_t node_bytes;
  void (*step)(RayState&, const std::byte*);         // rtunit/traversal/traversal.h, step()
  void (*run)(RayState&, const mem::AddressSpace&);  // the same, run()
};

// Contract (tests/contract/rt_node_format_test.cpp):
//  - arrange() may only exchange the children of a node among themselves. The layout, place() and encode()
//    come afterwards.
//  - place() gives each node bytes of its own, behind the header. The root lies at block kRootBlock. Where
//    the format leaves a choice, nodes lie in the given order.
//  - encode() returns the whole structure from the header on, as long as the placement says. The header is
//    left zero, and so is what lies behind the last node.
//  - Every decoded box contains the box that was encoded; children keep their order.
//  - Leaves lie at multiples of kBlockBytes, as BuildTree has them.
//  - The same tree gives the same bytes, on any number of threads.
class NodeFormat {
 public:
  static constexpr PolicyKind kKind{"bvh.format", "rtunit/formats"};
  struct Context {};
  virtual ~NodeFormat() = default;
  // Returns the largest number of children of a node, 2 to kMaxWidth.
  virtual uint32_t width() const = 0;
  // Returns the bytes of an internal node, which a ray fetches whole. They are a multiple of kBlockBytes.
  virtual uint32_t node_bytes() const = 0;
  virtual const NodeWalk& walk() const = 0;
  // Returns whether bit a of a child's number in its node says on which side of axis a the child lies
  // (rtunit/formats/octant_slots.h).
  virtual bool has_octant_slots() const { return false; }
  // Brings the children of each node into the order in which the format writes them, on up to `threads`
  // threads.
  virtual void arrange(BuildTree& tree, uint32_t threads) const {
    static_cast<void>(tree), static_cast<void>(threads);
  }
  virtual Placement place(const BuildTree& tree, const NodeOrder& order) const = 0;
  virtual mem::HostBlock encode(const BuildTree& tree, const Placement& placement,
                                uint32_t threads) const = 0;
  // Writes the children of the internal node whose bytes start at `node` to `out`, which has room for width()
  // of them. Returns their number.
  virtual uint32_t decode(const std::byte* node, std::span<DecodedChild> out) const = 0;
};

std::unique_ptr<NodeFormat> make_format(std::string_view name);

// Returns the format with an id, with its default parameters, or null when there is none. The formats are
// those that are registered at the first call: plugins come before the first ray. It throws UserError when
// two of them have the same id.
const NodeFormat* find_format(FormatId id);

}  // namespace glint::rt
