// Runs turns and windows, skips idle time, and notices when a machine is stuck.
// SPDX-License-Identifier: Apache-2.0
#include "engine/engine_loop.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fmt/format.h>

#include "base/diagnostics.h"
#include "base/host_threads.h"

namespace glint {

uint32_t EngineLoop::num_threads(uint32_t threads, size_t cells) {
  return std::min(host_threads(threads), uint32_t(std::max<size_t>(cells, 1)));
}

Cycle EngineLoop::run(const Between& between, Cycle look_at) {
  if (const uint32_t threads = num_threads(options_.threads, cells_.size()); threads > 1 && !pool_)
    pool_ = std::make_unique<CellPool>(cells_, threads, options_.homes);
  uint64_t last_progress = progress();
  Cycle last_moved = 0;
  for (Cycle now = 0;;) {
    const Next next = between(now);
    if (next == Next::Stop || (next == Next::NothingMore && all_finished())) return now;
    if (!options_.no_skip) {
      const Cycle event = next_event(now);
      if (event == kNever) throw_stuck(now, "nothing is left that could happen");
      const Cycle next_turn = std::max(now, event / options_.turn * options_.turn);
      if (now < look_at && next_turn >= look_at) {
        const Cycle turn_to_look = (look_at + options_.turn - 1) / options_.turn * options_.turn;
        look_at = kNever;
        if (turn_to_look > now && turn_to_look <= next_turn) {
          now = turn_to_look;
          continue;
        }
      }
      now = next_turn;
    }
    run_turn(now, last_progress);
    const uint64_t moved = progress();
    if (moved != last_progress) {
      last_progress = moved;
      last_moved = now;
    } else if (now - last_moved >= options_.watchdog) {
      throw_stuck(now, fmt::format("nothing has moved since cycle {}", last_moved));
    }
    now += options_.turn;
  }
}

void EngineLoop::run_turn(Cycle from, uint64_t progress) {
  // A number of threads that was asked for is used throughout. Only a free choice depends on the pace.
  const bool in_parallel =
      pool_ && (options_.threads || pace_.in_parallel(std::chrono::steady_clock::now(), progress));
  const Cycle end = from + options_.turn, step = options_.window ? options_.window : options_.turn;
  for (Cycle now = from; now < end; now += step) run_window(now, std::min(now + step, end), in_parallel);
}

void EngineLoop::run_window(Cycle from, Cycle until, bool in_parallel) {
  if (in_parallel)
    pool_->advance(from, until);
  else
    for (Cell* cell : cells_) cell->advance(from, until);
  for (ChannelBase* channel : channels_) channel->deliver();
}

bool EngineLoop::all_finished() const {
  return std::all_of(cells_.begin(), cells_.end(), [](const Cell* cell) { return cell->finished(); }) &&
         std::all_of(channels_.begin(), channels_.end(),
                     [](const ChannelBase* channel) { return channel->next_arrival() == kNever; });
}

Cycle EngineLoop::next_event(Cycle from) const {
  Cycle next = kNever;
  for (const Cell* cell : cells_) next = std::min(next, cell->next_event(from));
  for (const ChannelBase* channel : channels_) next = std::min(next, channel->next_arrival());
  return next;
}

uint64_t EngineLoop::progress() const {
  uint64_t sum = 0;
  for (const Cell* cell : cells_) sum += cell->progress();
  return sum;
}

void EngineLoop::throw_stuck(Cycle now, const std::string& why) const {
  std::string message = fmt::format("the machine is stuck at cycle {}: {}\n", now, why);
  for (const Cell* cell : cells_)
    if (!cell->finished()) message += cell->describe_stall();
  throw Error(Exit::Stuck, message);
}

}  // namespace glint
