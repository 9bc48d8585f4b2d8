// Runs one block of a launch after the other on the functional machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/cost_recorder.h"
#include "exec/endless_loops.h"
#include "exec/executor.h"
#include "pipeline/render.h"
#include "rtunit/traversal/traversal.h"

namespace glint::pipeline {

// Counts what blocks have done.
struct WorkCounts {
  std::array<ClassCounts, size_t(isa::Class::Count)> by_class{};
  RayCounts rays;
  void add(const WorkCounts& other);
  uint64_t instructions() const;
};

// Keeps the warps of a block, which take turns.
class BlockRunner {
 public:
  // Is thrown when a warp does something wrong.
  struct Failed {
    exec::Fault fault;
  };

  // Hears of every node that a ray visits, before it does.
  using NodeListener = std::function<void(const rt::Fetch&)>;

  // `world` and `endless` outlive the runner. A warp that executes more than `instruction_budget`
  // instructions fails.
  BlockRunner(const exec::World& world, const exec::EndlessLoops& endless, uint64_t instruction_budget)
      : world_(world), endless_(endless), budget_(instruction_budget) {}

  // Runs block `index` to its end. `is_over()` is asked between turns of warps. When it answers true, the
  // block is left as it is, and the function returns false. `costs` may be null, and `nodes` empty.
  bool run(exec::Executor& executor, uint32_t index, WorkCounts& counts, const std::function<bool()>& is_over,
           core::CostRecorder* costs = nullptr, const NodeListener& nodes = {});

  uint64_t instructions() const { return instructions_; }  // of the block that run() ran last
  // Returns where most warps of that block are.
  std::optional<exec::BusiestLine> busiest_line() const;

 private:
  void run_warp(exec::Executor& executor, exec::WarpContext& warp, WorkCounts& counts,
                core::CostRecorder* costs, const NodeListener& nodes);

  const exec::World& world_;
  const exec::EndlessLoops& endless_;
  const uint64_t budget_;
  uint64_t instructions_ = 0;
  exec::Block block_;
  std::vector<exec::WarpContext> warps_;
};

// Traverses the rays that `warp` waits for and answers them. Adds what the traversal did to `counts`, and
// tells `listener`, unless it is empty.
void answer_rays(exec::Executor& executor, exec::WarpContext& warp, RayCounts& counts,
                 const BlockRunner::NodeListener& listener = {});

}  // namespace glint::pipeline
