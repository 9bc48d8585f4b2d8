// One resident warp: registers, SIMT stack, local memory and the rays it has in flight.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/image.h"
#include "core/simt_stack.h"
#include "isa/warp.h"
#include "rtunit/ray_state.h"

namespace glint::core {

// The rays of one nesting level of rt.trace..
struct TraceFrame {
  std::array<rt::RayState, kLanes> ray;
  std::array<uint32_t, kLanes> payload{}, attributes{};  // local addresses
};

// Model: the two attribute buffers are a fixed 64 bytes each (Vulkan's minimum for hit attributes is 32).
inline constexpr uint32_t kAttributeBytes = 64;

inline constexpr uint32_t kMaxRayQueries = 16;  // of a shader. Choice: Vulkan sets no limit

struct WarpContext {
  isa::Warp regs;
  SimtStack simt;
  uint32_t warp_index = 0;            // of the launch: warp w holds launch indices [32 w, 32 w + 32)
  uint32_t depth = 0;                 // open rt.trace levels
  std::vector<std::unique_ptr<TraceFrame>> frames;  // allocated when first needed, then kept
  // Ray queries: kMaxRayQueries a level of rt.trace, allocated when first used.
  std::vector<std::unique_ptr<std::array<rt::RayState, kLanes>>> queries;
  std::vector<uint32_t> local;        // [word][lane]
  uint64_t instructions = 0;          // retired since start, for the instruction budget
  bool waiting_for_rays = false;      // an rt.trace or rt.resume has not been finished
  LaneMask ray_lanes = 0;             // that it handed over
  rt::RayState* rays = nullptr;       // one a lane, in `frames` or `queries`
  isa::Slot ray_answer = 0;           // predicate it writes

  // Rows of the specials bank, and of the register bank when the machine has not set one.
  std::unique_ptr<uint32_t[]> own_registers, own_specials;

  TraceFrame& frame() { return *frames[depth - 1]; }
};

}  // namespace glint::core
