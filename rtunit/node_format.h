// Declares the interface of the policies that choose how internal nodes are written.
//
// A format is a pair of files in rtunit/formats/. `<name>.cpp` encodes nodes and registers the format.
// `<name>.h` holds a struct with kWidth, kNodeBytes and the static test() that the traversal is compiled for
// (traversal.cpp lists it by FormatId).
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

namespace glint::rt {

// The largest number of children of a node in any format.
inline constexpr uint32_t kMaxWidth = 16;

// Describes a child as it was found in encoded bytes. Validation and tools use it, the traversal does not.
struct DecodedChild {
  NodeRef node = 0;
  Bounds bounds;  // as the traversal sees it
};

// Contract (tests/contract/rt_node_format_test.cpp):
//  - place() gives each node bytes of its own, behind the header. The root lies at block kRootBlock. Where
//  the
//    format leaves a choice, nodes lie in the order that it is given.
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
  virtual FormatId id() const = 0;
  // Returns the largest number of children of a node, 2 to kMaxWidth.
  virtual uint32_t width() const = 0;
  // Returns the bytes of an internal node, which a ray fetches whole. They are a multiple of kBlockBytes.
  virtual uint32_t node_bytes() const = 0;
  virtual Placement place(const BuildTree& tree, const NodeOrder& order) const = 0;
  virtual mem::HostBlock encode(const BuildTree& tree, const Placement& placement,
                                uint32_t threads) const = 0;
  // Writes the children of the internal node whose bytes start at `node` to `out`, which has room for width()
  // of them. Returns their number.
  virtual uint32_t decode(const std::byte* node, std::span<DecodedChild> out) const = 0;
};

std::unique_ptr<NodeFormat> make_format(std::string_view name);
std::unique_ptr<NodeFormat> make_format(FormatId id);

}  // namespace glint::rt
