// Takes cells and channels through simulated time, window by window, on one thread or several.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"
#include "engine/cell_pool.h"
#include "engine/engine.h"
#include "engine/pace.h"

namespace glint {

// Runs simulated time in turns, and each turn in windows. The length of a turn belongs to the model: blocks
// are handed out and stores become visible to other cores between turns, so these things happen in the same
// cycles however the machine is run. A window is the time that a cell advances alone. The length of a window,
// the number of threads and the cells that each thread runs change nothing but the time that a run takes.
// Turns start at multiples of their length, so that skipping idle time does not move them.
class EngineLoop {
 public:
  struct Options {
    Cycle turn = 32;             // cycles of a turn, at most the shortest latency of the channels
    bool no_skip = false;        // True: the loop visits every turn. Cells have a switch of their own.
    Cycle watchdog = 1'000'000;  // cycles without progress of any cell before the machine counts as stuck
    // This is the number of threads. With 0 there are as many as the host has processors, or half as many, a
    // quarter and so on, as long as these are faster.
    uint32_t threads = 1;
    // These are the cycles of a window, at most those of a turn. The last window of a turn ends with the
    // turn. 0 stands for a whole turn.
    Cycle window = 0;
    std::vector<uint32_t> homes{};         // the threads to which the cells belong (cell_pool.h)
    uint32_t most_threads = ~uint32_t{0};  // more threads than these would not be faster
  };
  enum class Next { Continue, NothingMore, Stop };
  // Is called at the start of each turn, and says how to go on. Continue means that more work may be handed
  // out later. With NothingMore, the loop runs until all cells are finished. With Stop, it ends at once, for
  // instance because of a fault.
  using Between = std::function<Next(Cycle now)>;

  explicit EngineLoop(Options options);
  ~EngineLoop();
  void add(Cell& cell);
  void add(ChannelBase& channel);
  // Says which cell alone receives the messages of a channel. The thread that advances this cell then
  // delivers them, where the channel can do that (ChannelBase::follow).
  void set_receiver(ChannelBase& channel, const Cell& cell);

  // Runs to the end, and returns the start of the first turn that was not run. `between` is called for the
  // turn that begins at `look_at` or next after it, even if idle time around it is skipped. Throws
  // Error(Exit::Stuck) with the description of every unfinished cell when nothing has moved for `watchdog`
  // cycles or nothing will move again.
  Cycle run(const Between& between, Cycle look_at = kNever);

  // Returns the number of threads that this host uses for `cells` cells when `threads` is asked for.
  static uint32_t num_threads(uint32_t threads, size_t cells);

 private:
  bool all_finished() const;
  Cycle next_event(Cycle from) const;
  void start_pool();
  bool run_turn(Cycle from);
  bool run_window(Cycle from, Cycle until, size_t way);
  uint64_t progress() const;
  [[noreturn]] void throw_stuck(Cycle now, const std::string& why) const;

  const Options options_;
  class Receiver;  // a cell that delivers its channels before it advances

  std::vector<Cell*> cells_;
  std::vector<std::unique_ptr<Receiver>> receivers_;  // one for each cell
  std::vector<ChannelBase*> channels_;
  std::vector<ChannelBase*> delivered_between_;  // those channels that no receiver delivers
  std::unique_ptr<CellPool> pool_;               // exists from the first run on; null with one thread
  std::optional<Pace> pace_;          // chooses among the pool's numbers of threads, if it is free to
  uint64_t last_progress_ = 0;        // of all cells after the last turn; unused with a pool
  alignas(64) uint64_t windows_ = 0;  // Every thread reads this number of windows.
};

}  // namespace glint
