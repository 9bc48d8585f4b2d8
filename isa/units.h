// Names the execution units, and says what the compiler assumes of each.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace glint::isa {

// Names the execution units. Latency and initiation interval come from the configuration,
// `[core.units.<name>]`. FpDiv and IntDiv are multi-pass sequences that the hardware runs on the named pipe.
enum class Unit : uint8_t {
  Int,
  IntDiv,
  Fp32,
  FpDiv,
  Fp64,
  Fp64Div,
  Fp16,
  Sfu,
  Move,
  Predicate,
  Shuffle,  // ops whose lanes read each other: shfl, vote, match, redux
  Tensor,   // products of matrices that a warp holds: mma
  Lsu,
  Const,
  Tex,
  Branch,
  Barrier,  // bar.*, membar.*
  RtUnit,
  Count
};

struct UnitRow {
  Unit unit;
  std::string_view name;
  // Cycles from issue to use for which the compiler tunes the order of instructions. They change no result,
  // only how well latencies overlap. The machine's own times are parameters (core/params.h).
  uint32_t scheduled_latency;
};

// Sources of the latencies: arithmetic takes 4 cycles on Volta and later (Z. Jia et al., "Dissecting the
// NVIDIA Volta GPU architecture via microbenchmarking", 2018, table 4.1), and loads take about 28 cycles for
// an L1 hit (the same paper, table 3.1). Choice: the others are round numbers of the right order of
// magnitude, and 1 for the units whose instructions the compiler does not move.
inline constexpr UnitRow kUnits[] = {
    {Unit::Int, "int", 4},          {Unit::IntDiv, "int_div", 40},
    {Unit::Fp32, "fp32", 4},        {Unit::FpDiv, "fp_div", 40},
    {Unit::Fp64, "fp64", 16},       {Unit::Fp64Div, "fp64_div", 40},
    {Unit::Fp16, "fp16", 4},        {Unit::Sfu, "sfu", 16},
    {Unit::Move, "move", 4},        {Unit::Predicate, "predicate", 4},
    {Unit::Shuffle, "shuffle", 24}, {Unit::Tensor, "tensor", 24},
    {Unit::Lsu, "lsu", 28},         {Unit::Const, "const", 8},
    {Unit::Tex, "tex", 80},         {Unit::Branch, "branch", 1},
    {Unit::Barrier, "barrier", 1},  {Unit::RtUnit, "rt_unit", 1},
};
static_assert(std::size(kUnits) == size_t(Unit::Count), "every unit has a row");
static_assert(
    [] {
      for (size_t i = 0; i < std::size(kUnits); ++i)
        if (kUnits[i].unit != Unit(i)) return false;
      return true;
    }(),
    "the rows have the order of the enum");

constexpr std::string_view name_of(Unit u) {
  return kUnits[size_t(u)].name;
}
constexpr uint32_t scheduled_latency(Unit u) {
  return kUnits[size_t(u)].scheduled_latency;
}

}  // namespace glint::isa
