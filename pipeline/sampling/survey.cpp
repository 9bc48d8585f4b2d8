// Runs every n-th block on the functional machine.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/survey.h"

#include <algorithm>
#include <unordered_map>

#include "pipeline/sampling/warmer.h"

namespace glint::pipeline {
namespace {

// Notes which lines blocks touch.
class Lines {
 public:
  void touch(Address line, uint32_t block) {
    const auto [at, is_new] = first_.emplace(line, Toucher{block});
    if (is_new)
      ++of_one_;
    else if (!at->second.is_shared && at->second.block != block)
      at->second.is_shared = true, --of_one_;
  }
  uint64_t all() const { return first_.size(); }
  uint64_t of_one() const { return of_one_; }

 private:
  struct Toucher {
    uint32_t block = 0;  // the first one
    bool is_shared = false;
  };
  std::unordered_map<Address, Toucher> first_;
  uint64_t of_one_ = 0;
};

}  // namespace

std::vector<BlockWork> run_survey(const exec::World& world, const GpuParams& gpu, Survey& survey,
                                  exec::FaultLog& passed) {
  std::vector<BlockWork> out;
  if (survey.step == 0) return out;
  Lines lines;
  uint32_t block = survey.first;
  const auto note = [&](Address line, uint8_t, mem::Touch) {
    if (survey.asks == Question::Lines) lines.touch(line, block);
    return 0u;
  };
  Warmer runner(world, gpu.core.instruction_budget, gpu.memory, note, Written::AsRead);
  for (; block < exec::num_blocks(world); block += survey.step) {
    if (survey.asks == Question::Lines) runner.forget();
    const WorkCounts counts = runner.run(block);
    out.push_back({counts.instructions(), counts.rays.nodes});
  }
  survey.lines = lines.all(), survey.lines_of_one = lines.of_one();
  const bool has_rays = std::ranges::any_of(out, [](const BlockWork& one) { return one.nodes > 0; });
  for (const BlockWork& one : out) survey.costs.push_back(double(has_rays ? one.nodes : one.instructions));
  passed.add(runner.passed());
  return out;
}

}  // namespace glint::pipeline
