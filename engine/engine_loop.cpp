// Runs turns and windows, skips idle time, and notices when a machine is stuck.
// SPDX-License-Identifier: Apache-2.0
#include "engine/engine_loop.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <fmt/format.h>
#include <utility>

#include "base/check.h"
#include "base/diagnostics.h"
#include "base/host_threads.h"

namespace glint {

uint32_t EngineLoop::num_threads(uint32_t threads, size_t cells) {
  return std::min(host_threads(threads), uint32_t(std::max<size_t>(cells, 1)));
}

class EngineLoop::Receiver final : public Cell {
 public:
  explicit Receiver(Cell& cell) : cell_(cell) {}
  const Cell& cell() const { return cell_; }
  void receive(ChannelBase& channel) { channels_.push_back(&channel); }

  void advance(Cycle from, Cycle until) override {
    for (ChannelBase* channel : channels_) channel->deliver();
    cell_.advance(from, until);
  }
  Cycle next_event(Cycle from) const override { return cell_.next_event(from); }
  bool finished() const override { return cell_.finished(); }
  uint64_t progress() const override { return cell_.progress(); }
  std::string describe_stall() const override { return cell_.describe_stall(); }

 private:
  Cell& cell_;
  std::vector<ChannelBase*> channels_;
};

EngineLoop::EngineLoop(Options options) : options_(std::move(options)) {
}
EngineLoop::~EngineLoop() = default;

void EngineLoop::add(Cell& cell) {
  cells_.push_back(&cell);
  receivers_.push_back(std::make_unique<Receiver>(cell));
}

void EngineLoop::add(ChannelBase& channel) {
  channels_.push_back(&channel);
  delivered_between_.push_back(&channel);
}

void EngineLoop::set_receiver(ChannelBase& channel, const Cell& cell) {
  const auto receiver = std::find_if(receivers_.begin(), receivers_.end(),
                                     [&](const auto& each) { return &each->cell() == &cell; });
  GLINT_CHECK(receiver != receivers_.end(), "the receiver of a channel is no cell of the machine");
  if (!channel.follow(&windows_)) return;
  std::erase(delivered_between_, &channel);
  (*receiver)->receive(channel);
}

void EngineLoop::start_pool() {
  const uint32_t threads =
      num_threads(options_.threads, std::min<size_t>(cells_.size(), options_.most_threads));
  if (threads <= 1 || pool_) return;
  std::vector<Cell*> receivers;
  for (const auto& receiver : receivers_) receivers.push_back(receiver.get());
  std::vector<uint32_t> counts{threads};
  while (options_.threads == 0 && counts.back() > 1) counts.push_back(counts.back() / 2);
  pool_ = std::make_unique<CellPool>(receivers, counts, options_.homes);
  if (counts.size() > 1) pace_.emplace(counts.size());
}

Cycle EngineLoop::run(const Between& between, Cycle look_at) {
  start_pool();
  last_progress_ = progress();
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
    if (run_turn(now)) {
      last_moved = now;
    } else if (now - last_moved >= options_.watchdog) {
      throw_stuck(now, fmt::format("nothing has moved since cycle {}", last_moved));
    }
    now += options_.turn;
  }
}

// Returns whether any cell has moved in the turn.
bool EngineLoop::run_turn(Cycle from) {
  // A number of threads that was asked for is used throughout. Only a free choice depends on the pace.
  const size_t way =
      pace_ ? pace_->way_for(std::chrono::steady_clock::now(), [this] { return progress(); }) : 0;
  const Cycle end = from + options_.turn, step = options_.window ? options_.window : options_.turn;
  bool moved = false;
  for (Cycle now = from; now < end; now += step) moved |= run_window(now, std::min(now + step, end), way);
  if (pool_) return moved;
  const uint64_t now = progress();
  return std::exchange(last_progress_, now) != now;
}

// Returns whether the pool has seen a cell move.
bool EngineLoop::run_window(Cycle from, Cycle until, size_t way) {
  ++windows_;
  bool moved = false;
  if (pool_)
    moved = pool_->advance(from, until, way);
  else
    for (const auto& receiver : receivers_) receiver->advance(from, until);
  for (ChannelBase* channel : delivered_between_) channel->deliver();
  return moved;
}

bool EngineLoop::all_finished() const {
  return std::all_of(cells_.begin(), cells_.end(), [](const Cell* cell) { return cell->finished(); }) &&
         std::all_of(channels_.begin(), channels_.end(),
                     [](const ChannelBase* channel) { return channel->next_arrival() == kNever; });
}

// Returns the earliest event. If there is any in the turn that begins at `from`, it returns such a one,
// because no turn is skipped then, and asks no more cells.
Cycle EngineLoop::next_event(Cycle from) const {
  Cycle next = kNever;
  for (const Cell* cell : cells_) {
    next = std::min(next, cell->next_event(from));
    if (next < from + options_.turn) return next;
  }
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
