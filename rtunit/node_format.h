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

namespace glint::rt {

// The largest number of children of a node in any format.
inline constexpr uint32_t kMaxWidth = 16;

// Holds a tree as the builder hands it over. Node 0 is the root and always internal. Leaves point to their
// bytes in `leaf_bytes`.
struct BuildTree {
  struct Node {
    Bounds bounds;
    uint32_t first_child = 0;  // first index in `children`, for internal nodes
    uint32_t leaf_block = 0;   // blocks from the start of leaf_bytes, for leaves
    NodeKind kind = NodeKind::Internal;
    uint8_t num_children = 0;
  };
  mem::HostArray<Node> nodes;
  mem::HostArray<uint32_t> children;  // indices into nodes
  mem::HostBlock leaf_bytes;
};

// Describes a child as it was found in encoded bytes. Validation and tools use it, the traversal does not.
struct DecodedChild {
  NodeRef node = 0;
  Bounds bounds;  // as the traversal sees it
};

// Contract (tests/contract/rt_node_format_test.cpp):
//  - encode() returns the whole structure from the header on. The root lies at block kRootBlock; the header
//    is left zero.
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
  virtual mem::HostBlock encode(const BuildTree& tree, uint32_t threads) const = 0;
  // Writes the children of the internal node whose bytes start at `node` to `out`, which has room for width()
  // of them. Returns their number.
  virtual uint32_t decode(const std::byte* node, std::span<DecodedChild> out) const = 0;
};

std::unique_ptr<NodeFormat> make_format(std::string_view name);
std::unique_ptr<NodeFormat> make_format(FormatId id);

}  // namespace glint::rt
