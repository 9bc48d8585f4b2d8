// What travels between a core and the memory system: one request for sectors of one line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "base/types.h"

namespace glint::mem {

// Why the traffic exists; every hit, miss and byte is counted under it. memsys knows nothing else of it.
enum class Traffic : uint8_t {
  ShaderGlobal, ShaderLocal, ShaderTexture, ShaderSurface, ShaderBinding,
  ShaderAtomic,  // read-modify-write at the L2
  Instruction, Constant,  // lines for a core's caches of them: an L1 keeps none
  RtNode, RtInstance, RtTriangle, RtProcedural,
  RtTable,       // candidates that wait for their shaders
  Count
};
constexpr std::string_view name_of(Traffic t) {
  constexpr std::string_view kNames[] = {"shader_global",  "shader_local", "shader_texture", "shader_surface",
                                         "shader_binding", "shader_atomic", "instruction", "constant", "rt_node", "rt_instance",
                                         "rt_triangle",    "rt_procedural", "rt_table"};
  return kNames[size_t(t)];
}
constexpr bool is_rt(Traffic t) { return t >= Traffic::RtNode; }
constexpr bool passes_l1(Traffic t) { return t == Traffic::Instruction || t == Traffic::Constant; }

inline constexpr uint32_t kSectorBytes = 32;  // the unit of transfer between all levels (Volta and later)

using Token = uint32_t;  // the requester's own name for a request; returned untouched

struct Request {
  Address line = 0;         // physical, aligned to the L1 line size
  uint8_t sectors = 0;      // bit i: sector i of the line is wanted or written
  bool write = false;
  Traffic traffic = Traffic::ShaderGlobal;
  Token token = 0;          // reads: comes back once when all sectors are there. Writes: not answered.
  // Traffic::ShaderAtomic: a "read" whose token comes back when the L2 has changed the sectors, or a "write" likewise
  // without an answer.
};

}  // namespace glint::mem
