// Holds what a sampled run estimates of the whole one, with intervals.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/stats.h"

namespace glint::pipeline {

// Names what is estimated.
enum class Quantity : uint8_t {
  Cycles,
  Ipc,
  Instructions,
  Nodes,
  L1HitRate,
  L2HitRate,
  DramUtilisation,
  Count
};

struct Estimate {
  std::string_view name, unit, doc;
  double value = 0;
  double low = 0, high = 0;  // a 95 % interval
};

// Holds root mean squares of what a way to sample is wrong by beyond its scatter: shares of the value for
// cycles, and differences for fractions.
struct MethodError {
  double cycles = 0, l1 = 0, l2 = 0, utilisation = 0;
};

// Holds a value and its variance.
struct Uncertain {
  double value = 0, variance = 0;
};

// Makes an estimate. Its interval is `student` standard deviations of the value wide to either side, and that
// of the method's own error, whose root mean square is `error`. An interval does not leave what is possible.
Estimate make_estimate(Quantity which, Uncertain value, double student, double error);

// Holds estimates as statistics: NAME, NAME_low and NAME_high.
class SampleStats : public stats::Group {
 public:
  SampleStats(stats::Group* parent, std::vector<Estimate> estimates);
  const std::vector<Estimate>& estimates() const { return estimates_; }

 private:
  const std::vector<Estimate> estimates_;
  std::vector<std::string> names_, texts_;  // the statistics refer to them
  std::vector<std::unique_ptr<stats::Value>> values_;
};

}  // namespace glint::pipeline
