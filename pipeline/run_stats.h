// Holds the statistics of a finished run: those of the functional machine, or the tree of the timing machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "base/stats.h"
#include "pipeline/functional_machine.h"
#include "pipeline/timing_machine.h"

namespace glint::pipeline {

// Holds what the functional machine counts, as a tree of statistics.
class FunctionalStats : public stats::Group {
 public:
  explicit FunctionalStats(const FunctionalCounts& counts);

 private:
  stats::Breakdown<isa::Class> instructions_{this, "instructions", "instruction",
                                             "Number of warp instructions executed, by class."};
  stats::Breakdown<isa::Class> lanes_{this, "lanes", "instruction", "Number of lane instructions, by class."};
  stats::Counter rays_{this, "rays", "ray", "Number of rays traced."};
  stats::Counter nodes_{this, "nodes", "node", "Number of nodes and leaves visited."};
  stats::Ratio nodes_per_ray_{this,   "nodes_per_ray", "node/ray",
                              nodes_, rays_,           "Mean number of nodes that a ray visits."};
  stats::Counter box_tests_{this, "box_tests", "test", "Number of ray-box tests."};
  stats::Counter triangle_tests_{this, "triangle_tests", "test", "Number of ray-triangle tests."};
  stats::Breakdown<exec::FaultKind> faults_{this, "faults", "fault", exec::kFaultsDoc};
};

class RunStats {
 public:
  explicit RunStats(const FunctionalCounts& counts)
      : functional_(std::make_unique<FunctionalStats>(counts)) {}
  explicit RunStats(std::unique_ptr<TimingMachine> machine) : timing_(std::move(machine)) {}
  stats::Group& root() { return timing_ ? timing_->root() : *functional_; }
  const stats::Group& root() const { return timing_ ? timing_->root() : *functional_; }
  // Keeps a group of the tree that is no part of the machine.
  void keep(std::unique_ptr<stats::Group> group) { others_.push_back(std::move(group)); }
  // Returns the machine that ran, or null after a functional run.
  const TimingMachine* timing() const { return timing_.get(); }

 private:
  std::unique_ptr<FunctionalStats> functional_;
  std::unique_ptr<TimingMachine> timing_;
  std::vector<std::unique_ptr<stats::Group>> others_;
};

}  // namespace glint::pipeline
