// Defines the decoded instruction and its operand slots, which an op's handler reads at run time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

namespace glint::isa {

// An operand slot names one row of 32 lanes by 32 bits in one of three banks, or the index of a predicate.
// All banks have the same layout, so a handler reads registers, constants and specials alike.
using Slot = uint16_t;
inline constexpr Slot kRegisterBank = 0x0000;  // + register number; a 64-bit value is an even/odd pair
inline constexpr Slot kConstantBank = 0x4000;  // + row of Program::constants (64 bits: two rows, low first)
inline constexpr Slot kSpecialBank = 0x8000;   // + Special
inline constexpr Slot kSlotIndexMask = 0x3fff;
inline constexpr int kBankShift = 14;

inline constexpr int kMaxRegisters = 255;  // per lane, 32 bits each (PTX targets: 255)
inline constexpr int kNumPredicates = 8;   // %p0..%p7
inline constexpr int kMaxOperands = 18;    // slots of one instruction (rt.trace is the widest)

inline constexpr uint8_t kNoGuard = 0xff;
inline constexpr uint8_t kGuardNegate = 0x80;  // guard = predicate index | kGuardNegate

// Names the read-only values of each lane that the machine provides; the text of LaunchX is %launch.x. The
// hit and ray values refer to the innermost trace of the warp: the candidate in any-hit and intersection
// shaders, the committed hit in closest-hit shaders, the ray in miss shaders (SPV_KHR_ray_tracing, built-in
// table).
enum class Special : uint8_t {
  LaneId,
  LaunchX,
  LaunchY,
  LaunchZ,
  LaunchSizeX,
  LaunchSizeY,
  LaunchSizeZ,
  // These belong to blocks (PTX's CTAs, Vulkan's workgroups) of a compute launch.
  TidX,
  TidY,
  TidZ,
  NtidX,
  NtidY,
  NtidZ,
  CtaidX,
  CtaidY,
  CtaidZ,
  NctaidX,
  NctaidY,
  NctaidZ,
  WarpId,   // warp slot in the core
  NwarpId,  // warp slots of the core
  SmId,     // number of the core
  NsmId,    // number of cores
  GridId,   // always 0
  LanemaskEq,
  LanemaskLe,
  LanemaskLt,
  LanemaskGe,
  LanemaskGt,
  // The sizes are bytes of shared memory of the block.
  TotalSmemSize,
  DynamicSmemSize,
  // The clock is the core cycle at issue, and the timer counts nanoseconds since launch. Both are 0 on the
  // functional machine.
  Clock,
  ClockHi,
  GlobalTimerLo,
  GlobalTimerHi,
  Payload,    // local address of the incoming payload or callable data
  Attribute,  // local address of the hit attributes
  // The record is the address of the data in the shader's record of the binding table, in two halves.
  Record,
  RecordHi,
  HitT,
  HitKind,  // 0xfe front, 0xff back, user 0..127
  HitU,     // barycentric
  HitV,     // barycentric
  HitPrimitive,
  HitGeometry,
  HitInstance,
  HitCustomIndex,
  RayFlags,
  RayTmin,
  RayCullMask,
  // The ray's origin and direction are in world space.
  RayOriginX,
  RayOriginY,
  RayOriginZ,
  RayDirectionX,
  RayDirectionY,
  RayDirectionZ,
  ObjectOriginX,
  ObjectOriginY,
  ObjectOriginZ,
  ObjectDirectionX,
  ObjectDirectionY,
  ObjectDirectionZ,
  // The matrices are row-major 3x4, and element N is 4 * row + column.
  ObjectToWorld0,
  ObjectToWorld1,
  ObjectToWorld2,
  ObjectToWorld3,
  ObjectToWorld4,
  ObjectToWorld5,
  ObjectToWorld6,
  ObjectToWorld7,
  ObjectToWorld8,
  ObjectToWorld9,
  ObjectToWorld10,
  ObjectToWorld11,
  WorldToObject0,
  WorldToObject1,
  WorldToObject2,
  WorldToObject3,
  WorldToObject4,
  WorldToObject5,
  WorldToObject6,
  WorldToObject7,
  WorldToObject8,
  WorldToObject9,
  WorldToObject10,
  WorldToObject11,
  Count
};
inline constexpr int kNumSpecials = int(Special::Count);

struct Inst {
  uint16_t op = 0;           // index into op_table()
  uint8_t guard = kNoGuard;  // predicate index, | kGuardNegate
  uint8_t reserved = 0;
  int32_t imm = 0;  // byte displacement of a memory operand, or target instruction of a label
  std::array<Slot, kMaxOperands> operand{};  // in the order of OpRow::operands, vectors one slot a part
};
static_assert(sizeof(Inst) == 44);

}  // namespace glint::isa
