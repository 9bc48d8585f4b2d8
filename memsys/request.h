// What travels between a core and the memory system: one request for sectors of one line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

#include "base/types.h"

namespace glint::mem {

// Why the traffic exists; every hit, miss and byte is counted under it. memsys knows nothing else of it.
enum class Traffic : uint8_t {
  ShaderGlobal,
  ShaderLocal,
  ShaderTexture,
  ShaderSurface,
  ShaderBinding,
  ShaderAtomic,  // read-modify-write at the L2
  Instruction,
  Constant,  // lines for a core's caches of them: an L1 keeps none
  RtNode,
  RtInstance,
  RtTriangle,
  RtProcedural,
  RtTable,  // candidates that wait for their shaders
  RtStack,  // of rays
  Count
};
constexpr std::string_view name_of(Traffic t) {
  constexpr std::string_view kNames[] = {
      "shader_global", "shader_local",  "shader_texture", "shader_surface", "shader_binding",
      "shader_atomic", "instruction",   "constant",       "rt_node",        "rt_instance",
      "rt_triangle",   "rt_procedural", "rt_table",       "rt_stack"};
  static_assert(std::size(kNames) == size_t(Traffic::Count));
  return kNames[size_t(t)];
}
constexpr bool is_rt(Traffic t) {
  return t >= Traffic::RtNode;
}
constexpr bool is_local(Traffic t) {
  return t == Traffic::ShaderLocal || t == Traffic::RtStack;
}  // one thread's own
constexpr bool passes_l1(Traffic t) {
  return t == Traffic::Instruction || t == Traffic::Constant;
}

inline constexpr uint32_t kSectorBytes = 32;  // the unit of transfer between all levels (Volta and later)

using Token = uint32_t;  // the requester's own name for a request; returned untouched

// Bit i: the i-th of 32 equal parts of a line, words of 4 bytes where it has 128. Model: such a part is
// written whole or not at all; a store of less counts as if it left it open.
using WordMask = uint32_t;
inline constexpr WordMask kAllWords = ~WordMask{0};
// Of one sector, in a line of `line_bytes`.
constexpr WordMask words_of_sector(uint32_t sector, uint32_t line_bytes) {
  const uint32_t words = 32 * kSectorBytes / line_bytes;
  return (kAllWords >> (32 - words)) << (sector * words);
}

// Of an atomic: lanes of a warp that meet in a word of a sector take turns, each with the sector's worth of
// data.
struct AtomicLanes {
  uint8_t lanes = 0;
  uint8_t turns = 0;  // of all its sectors together; 0: one each
};

struct Request {
  Address line = 0;     // physical, aligned to the L1 line size
  uint8_t sectors = 0;  // bit i: sector i of the line is wanted or written
  bool write = false;
  Traffic traffic = Traffic::ShaderGlobal;
  Token token = 0;             // reads: comes back once when all sectors are there. Writes: not answered.
  WordMask words = kAllWords;  // of a write: which words of the line it covers
  AtomicLanes atomic{};
  // Traffic::ShaderAtomic: a "read" whose token comes back when the L2 has changed the sectors, or a "write"
  // likewise without an answer.
};

// The sectors of a write (a Request or what becomes of it) that it covers.
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
