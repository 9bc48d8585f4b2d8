// Takes cells and channels through simulated time, window by window.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/engine.h"
#include "base/types.h"

namespace glint {

// Windows start at multiples of the window length, so that skipping idle time does not move their edges: what acts
// between windows acts in the same cycles with and without skipping.
class EngineLoop {
 public:
  struct Options {
    Cycle window = 32;             // at most the shortest latency of the channels
    bool no_skip = false;          // visits every window; cells have a switch of their own
    Cycle watchdog = 1'000'000;    // cycles without progress of any cell before the machine counts as stuck
  };
  enum class Next { Continue, NothingMore, Stop };
  // Called at the start of each window. Continue: more work may be handed out later. NothingMore: run until all
  // cells are finished. Stop: end at once, because of a fault for instance.
  using Between = std::function<Next(Cycle now)>;

  explicit EngineLoop(Options options) : options_(options) {}
  void add(Cell& cell) { cells_.push_back(&cell); }
  void add(ChannelBase& channel) { channels_.push_back(&channel); }

  // Runs to the end; returns the start of the window that was not run any more. Throws Error(Exit::Stuck) with
  // every cell's description when nothing has moved for `watchdog` cycles or nothing ever will.
  Cycle run(const Between& between);

 private:
  bool all_finished() const;
  Cycle next_event(Cycle from) const;
  void run_window(Cycle from, Cycle until);
  uint64_t progress() const;
  [[noreturn]] void throw_stuck(Cycle now, const std::string& why) const;

  const Options options_;
  std::vector<Cell*> cells_;
  std::vector<ChannelBase*> channels_;
};

}  // namespace glint
