// Holds one resident warp: registers, SIMT stack, local memory and the rays that it has in flight.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "exec/block.h"
#include "exec/image.h"
#include "exec/simt_stack.h"
#include "isa/warp.h"
#include "rtunit/traversal/ray_state.h"

namespace glint::exec {

// Holds what shaders still see of a ray whose walk is over, while its thread traces another one.
struct EndedRay {
  rt::Ray ray;
  rt::Hit committed;
  rt::CandidateTable* table = nullptr;
  rt::RayStatus status = rt::RayStatus::Idle;
  bool attribute_slot = false, broken = false;
};

// Holds what one nesting level of rt.trace has besides the rays that are under way (WarpContext::traced).
struct TraceFrame {
  std::array<uint32_t, kLanes> payload{}, attributes{};  // local addresses
  std::array<uint32_t, kLanes> time{};                   // bits of a float
  std::vector<rt::CandidateTable> tables;                // one per lane, if the any-hit mode has tables
  // These are the rays of the level below of the lanes in `kept`. The level gives them back when it ends.
  // They are allocated when first needed.
  std::unique_ptr<std::array<EndedRay, kLanes>> outer;
  LaneMask kept = 0;
};

// Holds the callables of one nesting level of call.sbt.callable.
struct CallableFrame {
  std::array<uint32_t, kLanes> data{};   // local addresses
  std::array<Address, kLanes> record{};  // records of the binding table
};

// Model: the two attribute buffers are a fixed 64 bytes each (Vulkan's minimum for hit attributes is 32).
inline constexpr uint32_t kAttributeBytes = 64;

// Holds ray queries or hit objects, which are named by number. Each level of rt.trace has its own, so a hit
// shader's objects do not disturb its caller's. They are made when first used.
template <class Object>
using Numbered = std::vector<std::unique_ptr<std::array<Object, kLanes>>>;
// This is the number of objects of a kind and level. Choice: neither Vulkan nor the extension sets a limit.
inline constexpr uint32_t kMaxNumbered = 16;

// Holds what a ray found, as a shader keeps it (SPV_NV_shader_invocation_reorder).
struct HitObject {
  enum class Type : uint8_t { Empty, Hit, Miss } type = Type::Empty;
  rt::Ray ray;
  rt::Hit hit;
  uint32_t record = 0;  // record of the hit or miss region
  std::array<uint32_t, kAttributeBytes / 4> attributes{};
  uint32_t time = 0;  // bits of a float
};

// Notes how long the running lanes have gone round in a loop in vain (exec/control.cpp).
struct WaitingLoop {
  LaneMask lanes = 0;     // the lanes that went back last
  uint64_t effects = 0;   // WarpContext::effects then
  uint32_t turns = 0;     // turns since these were others
  uint32_t waited = ~0u;  // the end of the loop in which the warp has given way last
  uint32_t next = 0;      // the entry of the SIMT stack from which on the next lanes are looked for
};

// Holds the state of a warp. The members that every instruction touches come first and lie together.
struct WarpContext {
  isa::Warp regs;
  SimtStack simt;
  uint64_t instructions = 0;      // instructions retired since the start, for the instruction budget
  bool waiting_for_rays = false;  // An rt.trace or rt.resume has not been finished.
  // The warp executes nothing until another warp of the block has opened the barrier.
  bool waiting_at_barrier = false;
  // A phase that the last mbarrier.*_wait asked for has not ended. The warp may go on.
  bool waits_for_phase = false;
  uint32_t warp_index = 0;  // number in the launch, in the order of World::layout
  Block* block = nullptr;   // the block that the warp belongs to
  uint32_t warp_in_block = 0;
  uint32_t slot = 0;       // Seat::slot: where the machine has put the warp
  uint32_t depth = 0;      // open rt.trace levels
  uint32_t callables = 0;  // open call.sbt.callable levels
  std::vector<std::unique_ptr<CallableFrame>> callable_frames;  // like `frames`
  Numbered<HitObject> hit_objects;
  // This is the time of the next ray. Model: nothing moves; shaders read the value back.
  std::array<uint32_t, kLanes> next_time{};
  std::vector<std::unique_ptr<TraceFrame>> frames;  // allocated when first needed, then kept
  // This is each lane's ray of the innermost rt.trace that it has opened. It is allocated like `frames`.
  std::unique_ptr<std::array<rt::RayState, kLanes>> traced;
  Numbered<rt::RayState> queries;
  std::vector<uint32_t> local;   // [word][lane]
  LaneMask ray_lanes = 0;        // lanes that it handed over
  rt::RayState* rays = nullptr;  // one per lane, in `traced` or `queries`
  isa::Slot ray_answer = 0;      // predicate that receives the answer
  LaneMask walking = 0;          // the lanes of ray_lanes whose rays World::traversal walks

  // This grows with every store to global or shared memory and to images, and with every atomic but those
  // with which lanes ask for a lock or look at a word (MemoryOps::has_effect).
  uint64_t effects = 0;
  WaitingLoop waiting_loop;

  // While it waits at a barrier, these are the barrier and the instruction that waits.
  uint32_t barrier = 0, barrier_pc = 0;
  LaneMask barrier_lanes = 0;

  std::unique_ptr<Block> own_block;  // used in a launch without blocks, where each warp is a block of its own

  // These are the rows of the specials bank, and those of the register bank when the machine has not set one.
  Rows own_registers, own_specials;

  TraceFrame& frame() { return *frames[depth - 1]; }
  const TraceFrame& frame() const { return *frames[depth - 1]; }
  // Returns the ray of a lane that has opened the innermost level.
  rt::RayState& ray(int lane) { return (*traced)[size_t(lane)]; }
  const rt::RayState& ray(int lane) const { return (*traced)[size_t(lane)]; }
};

}  // namespace glint::exec
