// Holds what a sampled run estimates of the whole one, with intervals.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/stats.h"
#include "pipeline/sampling/batch_counts.h"

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

// Returns its name in statistics: "l1_hit_rate".
std::string_view name_of(Quantity which);

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

// Holds what the estimates of a run are made of.
struct RunSums {
  Uncertain cycles, instructions, nodes;  // of the whole run; nodes 0: it has no rays
  // These are the quotients of kFractions, in their order; none where nothing was counted.
  std::array<std::optional<Uncertain>, 3> fractions;
};

// Names the estimates that are quotients of two counts.
struct Fraction {
  Quantity which;
  BatchCount above, below;
  double MethodError::*error;
};
inline constexpr std::array<Fraction, 3> kFractions{
    {{Quantity::L1HitRate, BatchCount::L1Hits, BatchCount::L1Reads, &MethodError::l1},
     {Quantity::L2HitRate, BatchCount::L2Hits, BatchCount::L2Reads, &MethodError::l2},
     {Quantity::DramUtilisation, BatchCount::DramBusy, BatchCount::DramClocks, &MethodError::utilisation}}};

// Makes all estimates of a run, and IPC from instructions and cycles. `student` and `error` are those of
// make_estimate().
std::vector<Estimate> make_estimates(const RunSums& sums, double student, const MethodError& error);

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
