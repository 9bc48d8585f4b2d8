// Runs windows of blocks, and lets the blocks of a window take their turns.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/blocks_ahead.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/cell_pool.h"
#include "exec/block_memory.h"

namespace glint::pipeline {
namespace {

constexpr uint32_t kMostPartsPerThread = 32;  // of a window. Choice: starting the threads costs little then
constexpr uint32_t kFirstPartsPerThread = 2;  // Choice: little is lost where blocks need each other
constexpr uint64_t kPart = 50'000;     // instructions of a part. Choice: what a part costs is little then
constexpr uint32_t kMostBlocks = 256;  // of a part
constexpr uint64_t kShortPart = 1'000'000;  // instructions that a part may always run ahead
constexpr uint32_t kFirstPause = 64;        // parts in order after a window of which many ran again
constexpr uint32_t kLongestPause = 1u << 20;
constexpr size_t kMostLines = 1u << 20;  // copies that a window may need, of some 120 bytes
constexpr uint32_t kAlways = std::numeric_limits<uint32_t>::max();

// Names consecutive blocks, which run in order on one thread. To other parts they are like one block.
struct Part {
  uint32_t first = 0, count = 0;
};

// Holds what a part did.
struct PartRun {
  enum class End : uint8_t {
    Whole,
    Failed,
    LeftOut,  // It ran for too long, or not at all because one before it failed.
    Stopped   // LaunchWatch::stop said so.
  };
  Part part{};
  End end = End::LeftOut;
  uint32_t ended_blocks = 0;
  WorkCounts counts{};
  uint64_t instructions = 0;
  exec::FaultLog faults{};
  exec::NotFiniteStores not_finite{};
  std::optional<exec::Fault> fault{};
  std::optional<exec::BusiestLine> line{};      // where its warps were when it was stopped
  std::unique_ptr<exec::BlockMemory> memory{};  // null: its effects have happened
};

// Runs parts of a window on one thread, in whatever order threads come to them.
class Worker final : public Cell {
 public:
  Worker(const exec::World& world, const exec::EndlessLoops& endless, uint64_t instruction_budget,
         const std::function<void(BlockRunner&)>& work)
      : runner(world, endless, instruction_budget), work_(work) {}
  void advance(Cycle, Cycle) override { work_(runner); }
  Cycle next_event(Cycle) const override { return kNever; }
  bool finished() const override { return true; }
  uint64_t progress() const override { return 0; }
  std::string describe_stall() const override { return ""; }

  BlockRunner runner;

 private:
  const std::function<void(BlockRunner&)>& work_;
};

class BlocksAhead {
 public:
  BlocksAhead(const exec::World& world, uint64_t instruction_budget, const LaunchWatch& watch,
              uint32_t threads)
      : world_(world),
        watch_(watch),
        threads_(threads),
        num_blocks_(exec::num_blocks(world)),
        endless_(*world.image),
        uses_(*world.memory),
        written_(uses_.size()) {
    std::vector<Cell*> cells;
    for (uint32_t t = 0; t < threads; ++t) {
      workers_.push_back(std::make_unique<Worker>(world, endless_, instruction_budget, work_));
      cells.push_back(workers_.back().get());
    }
    pool_ = std::make_unique<CellPool>(cells, std::vector{threads});
    counts_.progress.num_warps = uint64_t{num_blocks_} * exec::warps_per_block(world);
  }

  FunctionalCounts run() {
    // The first block shows which allocations blocks write.
    bool goes_on = run_alone({0, 1});
    while (goes_on && next_ < num_blocks_) {
      if (in_order_ == 0) {
        goes_on = run_window();
      } else {
        goes_on = run_in_order(part_at(next_));
        if (in_order_ != kAlways) --in_order_;
      }
    }
    return std::move(counts_);
  }

 private:
  // Returns the part that begins with a block. Parts have about as many instructions as costs little to hand
  // them out, by the mean of the blocks before.
  Part part_at(uint32_t first) const {
    const uint64_t mean = next_ ? counts_.instructions() / next_ : kPart;
    return {first,
            std::min(uint32_t(std::clamp<uint64_t>(kPart / std::max<uint64_t>(mean, 1), 1, kMostBlocks)),
                     num_blocks_ - first)};
  }

  // Runs a part. It is left out when `is_left_out(instructions)` says so between the turns of warps.
  template <class IsLeftOut>
  PartRun run_part(BlockRunner& runner, const Part& part, bool apart, IsLeftOut&& is_left_out) {
    PartRun out{.part = part};
    exec::Executor executor(world_);
    if (apart) {
      out.memory = std::make_unique<exec::BlockMemory>(uses_);
      executor.use(out.memory.get());
    }
    try {
      bool goes_on = true;
      for (; goes_on && out.ended_blocks < part.count; out.ended_blocks += goes_on) {
        goes_on = runner.run(executor, part.first + out.ended_blocks, out.counts, [&] {
          poll(runner);
          return stopped_.load(std::memory_order_relaxed) ||
                 is_left_out(out.instructions + runner.instructions());
        });
        out.instructions += runner.instructions();
      }
      if (out.ended_blocks == part.count) out.end = PartRun::End::Whole;
    } catch (BlockRunner::Failed& failed) {
      out.end = PartRun::End::Failed;
      out.fault = std::move(failed.fault);
    }
    if (out.end == PartRun::End::LeftOut && stopped_) {
      out.end = PartRun::End::Stopped;
      out.line = runner.busiest_line();
    }
    out.faults = executor.passed();
    out.not_finite = executor.not_finite_stores();
    return out;
  }

  // Runs a part before its turn, on any thread.
  PartRun run_before_its_turn(BlockRunner& runner, const Part& part) {
    const auto is_left_out = [&](uint64_t instructions) {
      return part.first > first_failed_.load(std::memory_order_relaxed) || instructions > limit_;
    };
    if (stopped_) return {.part = part, .end = PartRun::End::Stopped};
    if (is_left_out(0)) return {.part = part};
    PartRun out = run_part(runner, part, true, is_left_out);
    if (out.end == PartRun::End::Failed)
      for (uint32_t before = first_failed_; part.first < before;)
        if (first_failed_.compare_exchange_weak(before, part.first)) break;
    return out;
  }

  // The functions that run parts in their turn return false when the launch has been stopped.

  bool run_window() {
    parts_.clear();
    const size_t most = std::max<size_t>(kMostLines / std::max<size_t>(most_lines_, 1), threads_);
    for (uint32_t at = next_;
         parts_.size() < std::min(size_t{parts_per_thread_} * threads_, most) && at < num_blocks_;) {
      parts_.push_back(part_at(at));
      at += parts_.back().count;
    }
    first_failed_ = kAlways;
    limit_ = std::max(kShortPart, 16 * longest_);
    runs_.clear();
    runs_.resize(parts_.size());
    next_part_ = 0;
    pool_->advance(0, 1);
    written_.clear();
    size_t num_again = 0;
    for (PartRun& run : runs_) {
      const bool is_true = run.memory && run.end != PartRun::End::LeftOut && !run.memory->is_unsuited() &&
                           !run.memory->has_read(written_);
      if (run.end == PartRun::End::Stopped && !is_true)
        run = {.part = run.part, .end = run.end, .line = std::move(run.line)};
      const bool is_again = !is_true && run.end != PartRun::End::Stopped;
      num_again += is_again;
      if (is_again ? !run_alone(run.part) : !settle(run)) return false;
      run.memory = nullptr;
      if (in_order_ == kAlways) return true;
    }
    if (4 * num_again <= runs_.size()) {
      pause_ = kFirstPause;
      parts_per_thread_ = std::min(2 * parts_per_thread_, kMostPartsPerThread);
    } else {
      in_order_ = pause_;
      pause_ = std::min(2 * pause_, kLongestPause);
      parts_per_thread_ = kFirstPartsPerThread;
    }
    return true;
  }

  // Runs a part alone, in its turn, so that later parts of the window can be compared with what it wrote.
  bool run_alone(const Part& part) {
    PartRun run = run_part(workers_[0]->runner, part, true, [](uint64_t) { return false; });
    if (!run.memory->is_unsuited()) return settle(run);
    in_order_ = kAlways;
    return run_in_order(part);
  }

  bool run_in_order(const Part& part) {
    PartRun run = run_part(workers_[0]->runner, part, false, [](uint64_t) { return false; });
    return settle(run);
  }

  // Lets a part take its turn.
  bool settle(PartRun& run) {
    counts_.faults.add(run.faults);
    if (run.end == PartRun::End::Failed) throw Error(run.fault->exit(), counts_.faults.with(*run.fault));
    if (run.memory) {
      run.memory->commit(written_, uses_);
      most_lines_ = std::max(most_lines_, run.memory->num_lines());
    }
    counts_.add(run.counts);
    counts_.not_finite.add(run.not_finite);
    longest_ = std::max(longest_, run.instructions);
    next_ = run.part.first + run.ended_blocks;
    counts_.progress.ended_warps = uint64_t{next_} * exec::warps_per_block(world_);
    if (run.end == PartRun::End::Stopped) {
      counts_.end = LaunchEnd::Stopped;
      counts_.progress.instructions = counts_.instructions();
      if (run.line) counts_.progress.where = run.line->to_string(*world_.image);
      return false;
    }
    tell(0, [] { return std::string(); });
    return true;
  }

  // `running` is the number of instructions of the block that runs on the caller's thread.
  template <class Line>
  void tell(uint64_t running, Line&& line) {
    if (!watch_.progress) return;
    counts_.progress.instructions = counts_.instructions() + running;
    watch_.progress(counts_.progress, line);
  }

  // Tells the caller what goes on, and asks it whether to stop. Only the caller's thread does that.
  void poll(const BlockRunner& runner) {
    if (std::this_thread::get_id() != caller_) return;
    tell(runner.instructions(), [&runner] {
      const auto line = runner.busiest_line();
      return line ? line->place : "";
    });
    if (watch_.stop && watch_.stop()) stopped_ = true;
  }

  const exec::World& world_;
  const LaunchWatch& watch_;
  const uint32_t threads_, num_blocks_;
  const exec::EndlessLoops endless_;
  const std::thread::id caller_ = std::this_thread::get_id();
  exec::MemoryUses uses_;
  exec::WrittenBytes written_;  // by the blocks of the window that have had their turn
  FunctionalCounts counts_;
  uint32_t next_ = 0;  // the block whose turn is next
  uint32_t parts_per_thread_ = kFirstPartsPerThread;
  size_t most_lines_ = 0;                        // copies of lines of a part
  uint32_t in_order_ = 0, pause_ = kFirstPause;  // parts still to run in order
  uint64_t longest_ = 0, limit_ = 0;             // instructions of a part
  std::atomic<uint32_t> first_failed_{kAlways};  // the first block of the window that has failed
  std::atomic<bool> stopped_{false};
  std::vector<Part> parts_;  // of the window
  std::vector<PartRun> runs_;
  std::atomic<size_t> next_part_{0};  // the first one that no thread has taken
  const std::function<void(BlockRunner&)> work_ = [this](BlockRunner& runner) {
    for (size_t i = next_part_++; i < parts_.size(); i = next_part_++)
      runs_[i] = run_before_its_turn(runner, parts_[i]);
  };
  std::vector<std::unique_ptr<Worker>> workers_;
  std::unique_ptr<CellPool> pool_;
};

}  // namespace

FunctionalCounts run_ahead(const exec::World& world, uint64_t instruction_budget, const LaunchWatch& watch,
                           uint32_t threads) {
  return BlocksAhead(world, instruction_budget, watch, threads).run();
}

}  // namespace glint::pipeline
