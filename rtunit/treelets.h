// Says which treelet a node belongs to, and which nodes a treelet has.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "memsys/address_space.h"
#include "rtunit/structure/structure.h"
#include "rtunit/traversal/ray_path.h"

namespace glint::rt {

// Names a treelet of any structure in memory. It means nothing else than that.
using TreeletId = uint64_t;
inline constexpr TreeletId kNoTreelet = 0;

// Describes the table of treelets that lies behind the nodes of a structure whose layout forms treelets
// (StructureHeader::treelets). These words follow it:
//   num_treelets + 1  of each treelet: the number of its first node in the list of nodes; at last the end
//   num_nodes         the list of nodes: references, treelet by treelet, its root first
//   num_blocks        of each block of the structure: its treelet's number, or kNone
struct TreeletTable {
  static constexpr uint32_t kNone = ~0u;
  uint32_t num_treelets = 0, num_nodes = 0, num_blocks = 0;
  uint32_t node_bytes = 0;  // of internal nodes
  uint64_t bytes() const { return sizeof *this + 4 * (uint64_t{num_treelets} + 1 + num_nodes + num_blocks); }
};
static_assert(sizeof(TreeletTable) == kBlockBytes);

// Answers from the tables in memory. Model: an answer takes no time, and moves no bytes.
class Treelets {
 public:
  explicit Treelets(const mem::AddressSpace& memory) : memory_(memory) {}

  // Returns the treelet that the byte at a virtual address belongs to. kNoTreelet: it is not of a node, or
  // its structure has no treelets.
  TreeletId of(Address address) const {
    const Address structure = address & ~kWithin;
    const Table table = table_of(structure);
    const uint64_t block = (address & kWithin) / kBlockBytes;
    if (block >= table.about.num_blocks) return kNoTreelet;
    const auto number = table.word(uint64_t{table.about.num_treelets} + 1 + table.about.num_nodes + block);
    return number < table.about.num_treelets ? structure + 1 + number : kNoTreelet;
  }
  // Calls each(fetch) for every node of a treelet, the root first. The fetch reads the whole node.
  template <class Each>
  void for_each_node(TreeletId treelet, Each&& each) const {
    if (treelet == kNoTreelet) return;
    const Address structure = (treelet - 1) & ~kWithin;
    const uint64_t number = (treelet - 1) & kWithin;
    const Table table = table_of(structure);
    if (number >= table.about.num_treelets) return;
    const uint64_t nodes = uint64_t{table.about.num_treelets} + 1, end = table.word(number + 1);
    for (uint64_t i = table.word(number); i < end && i < table.about.num_nodes; ++i) {
      const NodeRef ref = table.word(nodes + i);
      const NodeKind kind = kind_of(ref);
      each(Fetch{structure + Address{block_of(ref)} * kBlockBytes,
                 kind == NodeKind::Internal ? table.about.node_bytes : leaf_bytes(kind), kind});
    }
  }

 private:
  // A structure begins where its allocation does, and one with treelets fits into 4 GiB.
  static constexpr Address kWithin = (Address{1} << mem::AddressSpace::kShift) - 1;

  struct Table {
    TreeletTable about;
    const std::byte* words = nullptr;
    uint32_t word(uint64_t i) const { return load<uint32_t>(words + 4 * i); }
  };
  // Bytes that a shader has overwritten may say anything.
  Table table_of(Address structure) const {
    const std::byte* header = memory_.find(structure, sizeof(StructureHeader));
    if (!header || load<uint32_t>(header) != StructureHeader::kMagic) return {};
    const auto block = load<uint32_t>(header + offsetof(StructureHeader, treelets));
    const Address at = structure + Address{block} * kBlockBytes;
    const std::byte* bytes = block ? memory_.find(at, sizeof(TreeletTable)) : nullptr;
    if (!bytes) return {};
    const auto about = load<TreeletTable>(bytes);
    if (!memory_.find(at, about.bytes())) return {};
    return {about, bytes + sizeof(TreeletTable)};
  }

  const mem::AddressSpace& memory_;
};

}  // namespace glint::rt
