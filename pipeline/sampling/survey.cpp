// Runs one of so many neighbouring blocks on the functional machine.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/survey.h"

#include <algorithm>
#include <unordered_map>

#include "exec/block_memory.h"
#include "pipeline/sampling/warmer.h"

namespace glint::pipeline {
namespace {

// Choice: a line that so many surveyed blocks touch belongs to all blocks. Neighbours of which each touches a
// line's end are fewer.
constexpr uint32_t kBlocksOfShared = 4;

// Notes how many blocks touch each line. Blocks come one after the other.
class Lines {
 public:
  void touch(Address line, uint32_t block) {
    Touchers& touchers = of_[line];
    if (touchers.number > 0 && touchers.last == block) return;
    touchers.last = block;
    ++touchers.number;
  }
  uint64_t all() const { return of_.size(); }
  // Returns those that many blocks touch, ascending.
  std::vector<Address> shared() const {
    std::vector<Address> out;
    for (const auto& [line, touchers] : of_)
      if (touchers.number >= kBlocksOfShared) out.push_back(line);
    std::ranges::sort(out);
    return out;
  }

 private:
  struct Touchers {
    uint32_t last = 0, number = 0;
  };
  std::unordered_map<Address, Touchers> of_;
};

}  // namespace

std::vector<BlockWork> run_survey(const exec::World& world, const GpuParams& gpu, Survey& survey,
                                  exec::FaultLog& passed) {
  std::vector<BlockWork> out;
  if (survey.step == 0) return out;
  const bool is_dry = survey.asks == Question::Lines;
  exec::World quiet;
  if (is_dry) quiet = world, quiet.prints = nullptr;
  const exec::MemoryUses uses(*world.memory);
  Lines lines;
  uint32_t block = 0;
  const auto note = [&](Address line, uint8_t, mem::Touch) {
    if (is_dry) lines.touch(line, block);
    return 0u;
  };
  Warmer runner(is_dry ? quiet : world, gpu.core.instruction_budget, gpu.memory, note, Written::AsRead);
  for (uint32_t i = 0; (block = survey.block(i)) < exec::num_blocks(world); ++i) {
    exec::BlockMemory apart(uses);
    if (is_dry) runner.forget(), runner.use(&apart);
    const WorkCounts counts = runner.run(block);
    out.push_back({counts.instructions(), counts.rays.nodes});
  }
  survey.lines = lines.all(), survey.shared = lines.shared();
  const bool has_rays = std::ranges::any_of(out, [](const BlockWork& one) { return one.nodes > 0; });
  for (const BlockWork& one : out) survey.costs.push_back(double(has_rays ? one.nodes : one.instructions));
  if (!is_dry) passed.add(runner.passed());
  return out;
}

}  // namespace glint::pipeline
