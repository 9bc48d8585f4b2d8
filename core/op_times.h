// Declares the interface of the policies that give single ops a time of their own, where it is not that of
// their unit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "base/registry.h"
#include "core/slow_paths.h"
#include "isa/op_row.h"

namespace glint::core {

// Holds the time of one op. Units give one latency and interval to all their ops. A real part takes longer
// for some of them, or runs them on another pipe, or makes a sequence of instructions of one.
struct OpTime {
  std::string_view name;  // name of an op; one '*' stands for any text
  uint32_t latency = 1;   // cycles from issue to the issue of a dependent instruction
  // These are the mean cycles from issue to the next issue on the pipe, a multiple of 1 / kParts.
  double interval = 1;
  isa::Unit pipe = isa::Unit::Count;  // the unit on whose pipe it runs; Count: its own unit
  bool alternates = false;  // It alternates between pipes, so that `latency` includes their crossing.
  uint32_t issues = 1;      // machine instructions that make up the op: issue slots
  // A whole op ends in a branch for rare operands, so that its warp issues nothing else before its end, and
  // its slots are spread over the latency. The parts of other ops issue as early as they can, because an
  // assembler fills the gaps between them with the instructions that follow.
  bool whole = false;
  SlowPath slow_path = SlowPath::None;  // what rare operands add; only whole ops have one

  static constexpr uint32_t kParts = 16;  // parts of a cycle
};

// Contract (tests/timing/op_times_test.cpp): every entry names at least one op, times are at least 1, and no
// op issues longer than its latency.
class OpTimes {
 public:
  static constexpr PolicyKind kKind{"core.op_times", "core/op_times"};
  struct Context {};
  virtual ~OpTimes() = default;
  virtual std::span<const OpTime> entries() const = 0;  // the first entry that fits an op is taken

  // Returns null when the op has the time of its unit.
  const OpTime* find(std::string_view op) const {
    for (const OpTime& entry : entries())
      if (fits(entry.name, op)) return &entry;
    return nullptr;
  }
  static bool fits(std::string_view pattern, std::string_view op) {
    const size_t star = pattern.find('*');
    if (star == std::string_view::npos) return pattern == op;
    const std::string_view end = pattern.substr(star + 1);
    return op.size() + 1 >= pattern.size() && op.starts_with(pattern.substr(0, star)) && op.ends_with(end);
  }
};

}  // namespace glint::core
