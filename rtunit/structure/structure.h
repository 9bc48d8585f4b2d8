// Defines the bytes of acceleration structures that all node formats share: header, leaves and references.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "base/types.h"

namespace glint::rt {

// Everything in a structure lies at a multiple of a block from its header. Block 0 is the header itself.
// Behind it lies the root, which is always an internal node.
inline constexpr uint32_t kBlockBytes = 16;
inline constexpr uint32_t kRootBlock = 4;
inline constexpr uint32_t kLeafBytes = 64;  // bytes of a leaf that is no instance

// Returns the object whose bytes begin at `from`.
template <class T>
T load(const std::byte* from) {
  T out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

// TriangleSecond occurs only on stacks: it is the second triangle of a leaf whose first one waited for an
// any-hit shader.
enum class NodeKind : uint8_t { Internal, Instance, Triangle, Procedural, TriangleSecond };

// Holds block number and kind in 32 bits, so a structure has at most 2^29 blocks = 8 GiB.
using NodeRef = uint32_t;
inline constexpr int kKindBits = 3;
constexpr NodeRef node_ref(uint32_t block, NodeKind kind) {
  return block << kKindBits | uint32_t(kind);
}
constexpr uint32_t block_of(NodeRef ref) {
  return ref >> kKindBits;
}
constexpr NodeKind kind_of(NodeRef ref) {
  return NodeKind(ref & ((1u << kKindBits) - 1));
}
constexpr uint64_t kMostBytes = (uint64_t{1} << (32 - kKindBits)) * kBlockBytes;
constexpr uint32_t leaf_bytes(NodeKind kind) {
  return kind == NodeKind::Instance ? 2 * kLeafBytes : kLeafBytes;
}

// Names a node format in a structure's header: the hash (FNV-1a) of the name that chooses the format. So it
// is the same in every build, and a format from a plugin needs no number from anybody. A bottom level has the
// format of the top level above it.
using FormatId = uint32_t;
constexpr FormatId format_id(std::string_view name) {
  FormatId hash = 0x811c'9dc5;
  for (const char c : name) hash = (hash ^ uint8_t(c)) * 0x0100'0193;
  return hash;
}

struct Bounds {
  std::array<float, 3> low{}, high{};
  bool operator==(const Bounds&) const = default;
};

// Says what a structure holds that may need a shader, as bits of StructureHeader::contents.
namespace contents {
inline constexpr uint8_t kNotOpaque = 1, kProcedural = 2;
}

struct StructureHeader {
  static constexpr uint32_t kMagic = 0x53424c47;  // "GLBS"
  uint32_t magic = kMagic;
  uint8_t level = 0;     // 0 bottom, 1 top
  uint8_t contents = 0;  // of the top level: of all its instances together
  uint8_t pad[2]{};
  Bounds bounds;                // in the level's own space; empty (low > high) without primitives
  uint32_t num_primitives = 0;  // active triangles and boxes, or active instances
  uint32_t stack_need = 0;      // entries that the worst ray needs in this structure
  uint64_t bytes = 0;
  uint32_t treelets = 0;   // block of the table of treelets (rtunit/treelets.h); 0: there is none
  uint32_t micromaps = 0;  // block of the opacity micromaps (rtunit/structure/micromaps.h); 0: there are none
  FormatId format = 0;
  uint32_t reserved = 0;
};
static_assert(sizeof(StructureHeader) == kRootBlock * kBlockBytes);

// Holds one or two triangles of one geometry. The second shares an edge with the first: its corners are
// picked from the four vertices. It is the geometry's next primitive.
struct TriangleLeaf {
  static constexpr uint32_t kNoOpacity = 0, kUniform = 1, kMapped = 5;  // values of opacity_of()
  std::array<std::array<float, 3>, 4> vertex;
  // The second number is that of the last triangle. In a leaf with a map it is the number of the first
  // triangle's map; that of the second triangle follows.
  std::array<uint32_t, 2> primitive;
  uint32_t geometry = 0;
  uint8_t count = 1;
  uint8_t opaque = 0;
  uint8_t second = 0;  // 2 bits per corner: the number of its vertex
  // 3 bits per triangle: opacity_of(). kMapsFirst says that they stand in place of `opaque`, as in Vulkan.
  uint8_t opacity = 0;
  static constexpr uint8_t kMapsFirst = 0x80;

  uint32_t primitive_of(uint32_t triangle) const { return primitive[0] + triangle; }
  // Says what is known of a triangle without a shader: kNoOpacity is nothing, kUniform and the three values
  // after it are a MicroState of the whole triangle, and with kMapped the triangle has a map.
  uint32_t opacity_of(uint32_t triangle) const { return opacity >> 3 * triangle & 7; }
  bool has_maps_first() const { return (opacity & kMapsFirst) != 0; }
  uint32_t map_of(uint32_t triangle) const { return primitive[1] + triangle; }
};
static_assert(sizeof(TriangleLeaf) == kLeafBytes);

// Holds one AABB in full precision: an intersection shader runs only for rays that enter it.
struct ProceduralLeaf {
  Bounds box;
  uint32_t geometry = 0, primitive = 0;
  uint32_t opaque = 0;
  uint32_t pad[7]{};
};
static_assert(sizeof(ProceduralLeaf) == kLeafBytes);

// Holds an instance. Transforms are row-major 3x4. What the traversal needs comes first; shaders read the
// rest.
struct InstanceLeaf {
  std::array<float, 12> world_to_object{};
  Address structure = 0;               // header of the bottom level
  uint32_t custom_index_and_mask = 0;  // low 24 bits index, high 8 mask
  uint32_t sbt_offset_and_flags = 0;   // low 24 bits offset, high 8 Vulkan instance flags
  std::array<float, 12> object_to_world{};
  uint32_t instance = 0;  // index in the build input (gl_InstanceID)
  uint32_t pad[3]{};

  uint32_t custom_index() const { return custom_index_and_mask & 0xff'ffff; }
  uint32_t mask() const { return custom_index_and_mask >> 24; }
  uint32_t sbt_offset() const { return sbt_offset_and_flags & 0xff'ffff; }
  uint32_t flags() const { return sbt_offset_and_flags >> 24; }
};
static_assert(sizeof(InstanceLeaf) == leaf_bytes(NodeKind::Instance));

// These are the bits of VkGeometryInstanceFlagBitsKHR.
namespace instance_flag {
inline constexpr uint32_t kFacingCullDisable = 0x1, kFlipFacing = 0x2, kForceOpaque = 0x4,
                          kForceNoOpaque = 0x8, kForceMicromaps2State = 0x10,
                          kDisableMicromaps = 0x20;  // VK_EXT_opacity_micromap
}

}  // namespace glint::rt
