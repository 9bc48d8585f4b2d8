// Takes cells and channels through simulated time, window by window, on one thread or several.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "engine/cell_pool.h"
#include "engine/engine.h"
#include "engine/pace.h"

namespace glint {

// Time goes in turns, and a turn in windows. A turn's length is the model's: what acts between turns (blocks
// are handed out, stores become visible to other cores) acts in the same cycles however the machine is run. A
// window is what a cell advances alone; its length, the threads and the cells each of them runs change
// nothing but the time that a run takes. Turns start at multiples of their length, so that skipping idle time
// does not move them.
class EngineLoop {
 public:
  struct Options {
    Cycle turn = 32;                // at most the shortest latency of the channels
    bool no_skip = false;           // visits every turn; cells have a switch of their own
    Cycle watchdog = 1'000'000;     // cycles without progress of any cell before the machine counts as stuck
    uint32_t threads = 1;           // 0: as many as the host has processors, while they are faster than one
    Cycle window = 0;               // at most a turn, and the last of a turn ends with it; 0: a turn
    std::vector<uint32_t> homes{};  // of the cells (cell_pool.h)
  };
  enum class Next { Continue, NothingMore, Stop };
  // Called at the start of each turn. Continue: more work may be handed out later. NothingMore: run until all
  // cells are finished. Stop: end at once, because of a fault for instance.
  using Between = std::function<Next(Cycle now)>;

  explicit EngineLoop(Options options) : options_(std::move(options)) {}
  void add(Cell& cell) { cells_.push_back(&cell); }
  void add(ChannelBase& channel) { channels_.push_back(&channel); }

  // Runs to the end; returns the start of the turn that was not run any more. Throws Error(Exit::Stuck) with
  // every cell's description when nothing has moved for `watchdog` cycles or nothing ever will.
  Cycle run(const Between& between);

  // That options_.threads comes to on this host, for `cells` cells.
  static uint32_t num_threads(uint32_t threads, size_t cells);

 private:
  bool all_finished() const;
  Cycle next_event(Cycle from) const;
  void run_turn(Cycle from, uint64_t progress);
  void run_window(Cycle from, Cycle until, bool in_parallel);
  uint64_t progress() const;
  [[noreturn]] void throw_stuck(Cycle now, const std::string& why) const;

  const Options options_;
  std::vector<Cell*> cells_;
  std::vector<ChannelBase*> channels_;
  std::unique_ptr<CellPool> pool_;  // from the first run on; null with one thread
  Pace pace_;
};

}  // namespace glint
