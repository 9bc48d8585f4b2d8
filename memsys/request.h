// Declares what a core asks of the memory system: one request for sectors of one line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "base/types.h"

namespace glint::mem {

// Says what an access is for. Hits, misses and latencies are counted by it; memsys knows no more of an
// access.
enum class Traffic : uint8_t {
  ShaderGlobal,
  ShaderLocal,
  ShaderTexture,
  ShaderSurface,
  ShaderBinding,
  ShaderAtomic,  // is a read-modify-write at the L2
  Instruction,
  Constant,  // goes to a cache of the core, as an instruction does; the L1 does not keep the line
  RtNode,
  RtInstance,
  RtTriangle,
  RtProcedural,
  RtTable,     // is for tables of candidates that wait for their shaders
  RtStack,     // is for the stacks of rays
  RtPrefetch,  // reads ahead of the rays; nobody waits for the answer, and none comes back
  Count
};
constexpr std::string_view name_of(Traffic t) {
  constexpr std::string_view kNames[] = {
      "shader_global", "shader_local",  "shader_texture", "shader_surface", "shader_binding",
      "shader_atomic", "instruction",   "constant",       "rt_node",        "rt_instance",
      "rt_triangle",   "rt_procedural", "rt_table",       "rt_stack",       "rt_prefetch"};
  static_assert(std::size(kNames) == size_t(Traffic::Count));
  return kNames[size_t(t)];
}
constexpr bool is_rt(Traffic t) {
  return t >= Traffic::RtNode;
}
constexpr bool is_local(Traffic t) {
  return t == Traffic::ShaderLocal || t == Traffic::RtStack;  // this memory belongs to one thread
}
constexpr bool passes_l1(Traffic t) {
  return t == Traffic::Instruction || t == Traffic::Constant;
}

inline constexpr uint32_t kSectorBytes = 32;  // unit of transfer between all levels (Volta and later)

// Caches know a line by the number of its first sector, which has 32 bits. It bounds physical memory
// (AddressSpace::reserve()).
inline constexpr uint32_t kNoLine = ~0u;
inline constexpr Address kMaxPhysicalBytes = Address{kSectorBytes} << 32;
constexpr uint32_t line_key(Address line) {
  return uint32_t(line / kSectorBytes);
}

// Returns the number of sectors in a mask. std::popcount is a call of a library where the compiler may not
// assume the instruction.
constexpr uint32_t num_sectors(uint8_t mask) {
  constexpr uint64_t kBits = 0x4332'3221'3221'2110;  // the number of bits of each hexadecimal digit
  return uint32_t((kBits >> 4 * (mask & 15) & 15) + (kBits >> 4 * (mask >> 4) & 15));
}
static_assert(num_sectors(0) == 0 && num_sectors(0xff) == 8 && num_sectors(0x96) == 4);

using Token = uint32_t;  // name that the requester gives a request, which comes back unchanged

// Bit i stands for the i-th of 32 equal parts of a line; in a line of 128 bytes the parts are words of 4
// bytes. Model: a part counts as written only when a store covers it whole.
using WordMask = uint32_t;
inline constexpr WordMask kAllWords = ~WordMask{0};
// Returns the mask of one sector of a line of `line_bytes`.
constexpr WordMask words_of_sector(uint32_t sector, uint32_t line_bytes) {
  const uint32_t words = 32 * kSectorBytes / line_bytes;
  return (kAllWords >> (32 - words)) << (sector * words);
}

// Holds what an atomic adds to a request. Lanes of a warp that meet in a word of a sector take turns, and
// each turn moves the data of a whole sector.
struct AtomicLanes {
  uint8_t lanes = 0;
  uint8_t turns = 0;  // turns of all its sectors together; 0 stands for one turn in each sector
  bool adds_floats = false;
};

struct Request {
  Address line = 0;     // physical address, aligned to the size of an L1 line
  uint8_t sectors = 0;  // bit i says that sector i of the line is wanted or written
  bool write = false;
  Traffic traffic = Traffic::ShaderGlobal;
  // It comes back once when a read has all sectors. Writes and prefetches (Traffic::RtPrefetch) have no
  // answer.
  Token token = 0;
  WordMask words = kAllWords;  // words of the line that a write covers
  // An atomic (Traffic::ShaderAtomic) is a "read" whose token comes back when the L2 has changed the sectors,
  // or a "write" that has no answer.
  AtomicLanes atomic{};
};

// Returns the sectors that a write covers whole. `Write` is a Request or a Packet.
template <class Write>
constexpr uint8_t covered_sectors(const Write& request, uint32_t line_bytes) {
  if (request.words == kAllWords) return request.sectors;
  uint8_t out = 0;
  for (uint32_t i = 0; i < line_bytes / kSectorBytes; ++i)
    if (const WordMask whole = words_of_sector(i, line_bytes); (request.words & whole) == whole)
      out |= uint8_t(request.sectors & 1u << i);
  return out;
}

}  // namespace glint::mem
