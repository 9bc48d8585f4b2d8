// Lowers built-ins of compute shaders and subgroups: the position of the invocation in its warp, block and
// grid.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <optional>

#include "frontend/lower/lowering.h"

namespace glint::frontend {
namespace {

using isa::Special;
using spv::BuiltIn;

constexpr uint32_t kSubgroupSize = 32;

Operands vector(Special first) {
  Operands parts;
  for (uint32_t i = 0; i < 3; ++i) parts.push_back(Operand::of(Special(uint32_t(first) + i)));
  return parts;
}

Operands mask(Special lanes) {
  return {Operand::of(lanes), Operand::value(0), Operand::value(0), Operand::value(0)};
}

// Returns the position in the block. It is 0 along an axis where the block is one thread wide.
Operands local_id(ModuleLowering& l) {
  Operands id = vector(Special::TidX);
  for (uint32_t i = 0; i < 3; ++i)
    if (l.program().local_size[i] == 1) id[i] = Operand::value(0);
  return id;
}

Operand local_index(ModuleLowering& l) {
  const Operands id = local_id(l);
  const auto& size = l.program().local_size;
  const auto step = [&](const Operand& sum, uint32_t by, const Operand& more) {
    return l.emit().value("add.u32", {l.emit().value("mul.lo.u32", {sum, Operand::value(by)}), more});
  };
  return step(step(id[2], size[1], id[1]), size[0], id[0]);
}

uint32_t num_subgroups(const std::array<uint32_t, 3>& size) {
  return (size[0] * size[1] * size[2] + kSubgroupSize - 1) / kSubgroupSize;
}

}  // namespace

std::optional<Operands> ModuleLowering::load_compute_builtin(BuiltIn builtin) {
  switch (builtin) {
    case BuiltIn::GlobalInvocationId:
      return vector(Special::LaunchX);
    case BuiltIn::WorkgroupId:
      return vector(Special::CtaidX);
    case BuiltIn::NumWorkgroups:
      return vector(Special::NctaidX);
    case BuiltIn::WorkgroupSize: {
      Operands size;
      for (const uint32_t axis : program_.local_size) size.push_back(Operand::value(axis));
      return size;
    }
    case BuiltIn::LocalInvocationId:
      return local_id(*this);
    case BuiltIn::LocalInvocationIndex:
      return Operands{local_index(*this)};
    case BuiltIn::SubgroupSize:
      return Operands{Operand::value(kSubgroupSize)};
    case BuiltIn::NumSubgroups:
      return Operands{Operand::value(num_subgroups(program_.local_size))};
    case BuiltIn::SubgroupId:
      return Operands{emitter_.value("shr.u32", {local_index(*this), Operand::value(5)})};
    case BuiltIn::SubgroupLocalInvocationId:
      return Operands{Operand::of(Special::LaneId)};
    case BuiltIn::SubgroupEqMask:
      return mask(Special::LanemaskEq);
    case BuiltIn::SubgroupGeMask:
      return mask(Special::LanemaskGe);
    case BuiltIn::SubgroupGtMask:
      return mask(Special::LanemaskGt);
    case BuiltIn::SubgroupLeMask:
      return mask(Special::LanemaskLe);
    case BuiltIn::SubgroupLtMask:
      return mask(Special::LanemaskLt);
    case BuiltIn::WarpsPerSMNV:
      return Operands{Operand::of(Special::NwarpId)};
    case BuiltIn::SMCountNV:
      return Operands{Operand::of(Special::NsmId)};
    case BuiltIn::WarpIDNV:
      return Operands{Operand::of(Special::WarpId)};
    case BuiltIn::SMIDNV:
      return Operands{Operand::of(Special::SmId)};
    case BuiltIn::DeviceIndex:
      return Operands{Operand::value(0)};
    default:
      return std::nullopt;
  }
}

}  // namespace glint::frontend
