// Declares the interface of the policies that decide candidates without a shader.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/registry.h"
#include "base/stats.h"
#include "memsys/address_space.h"
#include "rtunit/structure/micromaps.h"
#include "rtunit/traversal/ray.h"

namespace glint::rt {

// Says what a filter makes of a candidate.
enum class Opacity : uint8_t {
  Unknown,      // Its any-hit shader decides.
  Opaque,       // It is a hit.
  Transparent,  // The ray passes.
};

// Asks about a triangle that would need an any-hit shader.
struct LeafQuestion {
  const TriangleLeaf& leaf;
  uint32_t number = 0;      // which of the leaf's triangles it is, 0 or 1
  const Hit& candidate;     // with the weights of the corners
  Address structure = 0;    // virtual address of the header of the bottom level
  bool two_states = false;  // The ray wants no shader where a map has an opinion (kForceMicromaps2State).
};

struct LeafAnswer {
  Opacity opacity = Opacity::Unknown;
  // virtual address of the bytes that the unit reads for it, within one sector; 0: the leaf says enough
  Address from = 0;
  bool operator==(const LeafAnswer&) const = default;
};

// The traversal asks the filter about each triangle that is met within the ray's interval, is nearer than the
// hit so far, and is not opaque by its geometry, its instance and the ray. What is forced to be opaque stays
// so. Where the ray or the instance forces triangles not to be opaque, an opaque answer counts as unknown.
// Where the maps of a structure come first (Micromaps::come_first), it asks about all triangles, and
// instances and rays override the answers but for transparent ones. Instances can disable all of this.
//
// Contract (tests/contract/rt_leaf_filter_test.cpp):
//  - look_up() depends on the question and on memory alone: one object serves all cores.
//  - Without micromaps in the structure every answer is Unknown, and nothing is read.
//  - Unless the structure's maps or the question have two states, an answer that is not Unknown is what the
//    any-hit shader would say.
//  - The RT unit calls looked_up() for each look_up() that it makes, and then reads what the answer names.
class LeafFilter {
 public:
  static constexpr PolicyKind kKind{"rt.leaf_filter", "rtunit/leaf_filters"};
  static constexpr std::string_view kNone = "none";       // Under this name the traversal asks nobody.
  static constexpr const char* kMicromaps = "micromaps";  // The filter of this name reads opacity micromaps.
  struct Context {
    stats::Group* stats = nullptr;  // parent for a policy's own statistics; may be null
    const mem::AddressSpace& memory;
  };
  virtual ~LeafFilter() = default;
  // Returns the micromaps that the structures of an alpha-tested scene should have.
  virtual std::optional<MicromapFormat> micromaps() const { return std::nullopt; }
  virtual LeafAnswer look_up(const LeafQuestion&) const { return {}; }
  // Tells of an answer that a ray in the unit has got.
  virtual void looked_up(const LeafAnswer&) {}
};

}  // namespace glint::rt
