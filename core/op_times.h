// Interface: the time of single ops, where it is not that of their unit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "base/registry.h"
#include "isa/op_row.h"

namespace glint::core {

// Units give one latency and interval to all their ops; a real part takes longer for some of them, or runs them on
// another pipe, or makes a sequence of instructions of one.
struct OpTime {
  std::string_view name;   // of an op; one '*' stands for any text
  uint32_t latency = 1;    // issue to issue of a dependent instruction
  uint32_t interval = 1;   // issue to the next issue on the pipe
  isa::Unit pipe = isa::Unit::Count;  // the unit on whose pipe it runs; Count: on its own
  bool alternates = false;            // between pipes, so that `latency` has their crossing in it
};

// Contract (tests/timing/op_times_test.cpp): every entry names at least one op, times are at least 1.
class OpTimes {
 public:
  struct Context {};
  virtual ~OpTimes() = default;
  virtual std::span<const OpTime> entries() const = 0;  // the first that fits an op is taken

  // Null: the op has the time of its unit.
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
