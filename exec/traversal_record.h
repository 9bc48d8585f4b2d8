// Names the program that walks rays by code, and the record that it works on in each lane's local memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::exec {

// Number the words of a record, as shaders/traversal/traversal.rcall does. The stack's entries, of two words,
// follow.
namespace traversal_word {
inline constexpr uint32_t kOrigin = 0, kTmin = 3, kDirection = 4, kTmax = 7, kFlags = 8, kMask = 9,
                          kStructure = 10, kStatus = 12, kStackSize = 13, kTopLevelEntries = 14,
                          kStackRoom = 15, kInstanceBlock = 16, kEndsAtFirstHit = 17, kHit = 20,
                          kCandidate = 28, kStack = 36;
}

// Says how a walk ends (traversal_word::kStatus).
enum class WalkStatus : uint32_t { Done, NeedsAnyHit, NeedsIntersection, NeedsIntersectionOpaque, Broken };

// Says how a launch's rays are walked without an RT unit. Each level of rt.trace, and each ray query of each
// level, has a record. The records lie behind the stack of the lane's shaders.
struct TraversalCode {
  uint32_t shader = 0xffff'ffff;  // index in the image; kNoShader: the RT unit walks rays
  uint32_t first_record = 0;      // byte of local memory, a multiple of 16
  uint32_t stack_entries = 0;     // stack entries of a record
  uint32_t queries = 0;           // ray queries of a level
  uint32_t record_bytes() const { return (traversal_word::kStack * 4 + stack_entries * 8 + 15) / 16 * 16; }
};

}  // namespace glint::exec
