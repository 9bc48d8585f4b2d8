// Builds acceleration structures in simulated memory from geometry, as a driver would.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/registry.h"
#include "memsys/address_space.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/micromaps.h"

namespace glint::rt {

inline constexpr std::array<float, 12> kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  // row-major 3x4

// Holds triangles or AABBs. Without indices, each three positions are a triangle. The spans are read only
// during build_bottom(). Triangles with a corner that is not a number are inactive (Vulkan), and so are
// triangles without area, which no ray can hit. Inactive triangles keep their primitive index.
struct Geometry {
  std::span<const std::byte> positions;  // float3 at multiples of `stride` bytes
  uint32_t stride = 12;
  std::span<const uint32_t> indices;
  std::span<const Bounds> aabbs;                // An AABB geometry has some, a triangle geometry none.
  std::array<float, 12> transform = kIdentity;  // applied to the triangles at build
  bool opaque = true;
  bool no_duplicate_any_hit = false;  // It always holds here: every primitive lies in one leaf.
  // Says where the triangles are opaque. Null: any-hit shaders say it. The maps of all geometries of a bottom
  // level have the same format.
  const Micromaps* micromaps = nullptr;
};
struct BottomLevel {
  std::vector<Geometry> geometries;
};

struct Instance {
  std::array<float, 12> transform = kIdentity;  // object to world, row-major 3x4
  uint32_t custom_index = 0;                    // 24 bits
  uint32_t mask = 0xff;                         // 8 bits
  uint32_t sbt_offset = 0;                      // 24 bits
  uint32_t flags = 0;                           // instance_flag::*
  uint32_t bottom = 0;                          // index of its bottom level
};

// Holds the keys of [bvh] in a configuration.
struct BuildOptions {
  PolicyChoice<NodeFormat> format{"bvh6"};  // Vulkan-Sim 2.0
  bool pair_triangles = true;
  PolicyChoice<TreeLayout> layout{"depth_first"};
  static ParamList params() {
    return {policy(&BuildOptions::format, "format",
                   "Selects how internal nodes are written, and how many children they have."),
            flag(&BuildOptions::pair_triangles, "pair_triangles",
                 "True: two neighbouring triangles of a geometry share a leaf where that adds no "
                 "surface area. False: each triangle has a leaf of its own."),
            policy(&BuildOptions::layout, "layout",
                   "Selects the order of nodes in memory, and which of them form treelets.")};
  }
};

struct StructureInfo {
  Address address = 0;  // virtual address of the header, which descriptors and rays hold
  Bounds bounds{};
  uint64_t bytes = 0;
  FormatId format = 0;
  uint32_t nodes = 0;  // internal nodes
  uint32_t leaves = 0;
  uint32_t depth = 0;       // number of internal nodes from the root to the deepest leaf
  uint64_t primitives = 0;  // active triangles and AABBs, or active instances
  uint32_t stack_need = 0;  // stack entries that the worst ray needs, instances' bottom levels included
  uint8_t contents = 0;     // as StructureHeader::contents
};

// Holds a structure as bytes that may lie anywhere, at a multiple of kLeafBytes. Its geometry is no longer
// needed. `info.address` is not set.
struct EncodedStructure {
  StructureInfo info;
  mem::HostBlock bytes;
};
struct KeptTree;  // rtunit/structure/refit.h

// Encodes a bottom level on up to `threads` threads, which do not show in the bytes. A tree that is too deep
// for the ray stack is built anew, balanced. `kept` gets what it takes to fit the structure to geometry that
// moves. Throws UserError when an index is out of range.
EncodedStructure encode_bottom(const std::string& name, const BottomLevel& input,
                               const BuildOptions& options = {}, uint32_t threads = 1,
                               KeptTree* kept = nullptr);
StructureInfo place(mem::AddressSpace& memory, const std::string& name, EncodedStructure structure);
// Returns a size that no structure of so many triangles or boxes (level 0) or instances (level 1) exceeds.
// Micromaps come on top of it.
uint64_t most_bytes(uint8_t level, uint64_t primitives, const BuildOptions& options = {});

// Encodes a bottom level, as encode_bottom() does, and places it in memory.
StructureInfo build_bottom(mem::AddressSpace& memory, const std::string& name, const BottomLevel& input,
                           const BuildOptions& options = {}, uint32_t threads = 1);

// Returns why no ray can be taken into the space of `instance`, which stands for `bottom`, as a clause like
// "its transform ...", or "".
std::string why_unreachable(const Instance& instance, const StructureInfo& bottom);

// Encodes a top level. Instances of empty bottom levels are inactive and keep their index. With `notes`,
// instances that no ray can be taken into are inactive, too, and are noted there. Throws UserError when there
// are such instances and no notes, an index is out of range, a bottom level has another node format or the
// trees are too deep for the ray stack. `kept` is that of encode_bottom().
EncodedStructure encode_top(const std::string& name, std::span<const Instance> instances,
                            std::span<const StructureInfo> bottoms, const BuildOptions& options = {},
                            std::vector<std::string>* notes = nullptr, KeptTree* kept = nullptr);
// Encodes a top level and places it in memory. It has no notes.
StructureInfo build_top(mem::AddressSpace& memory, const std::string& name,
                        std::span<const Instance> instances, std::span<const StructureInfo> bottoms,
                        const BuildOptions& options = {});

}  // namespace glint::rt
