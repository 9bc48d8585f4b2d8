// Tests threads that advance cells: each cell is advanced once per window, whoever does it.
// SPDX-License-Identifier: Apache-2.0
#include "engine/cell_pool.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "engine/engine_loop.h"
#include "tests/support/catch.h"

namespace glint {
namespace {

// Notes its windows, and sends a number to the next cell of a ring in each of them.
class RingCell final : public Cell {
 public:
  RingCell(Channel<uint64_t>* in, Channel<uint64_t>* out, Cycle latency, Cycle end)
      : in_(in), out_(out), latency_(latency), end_(end) {}
  void advance(Cycle from, Cycle until) override {
    windows.push_back({from, until});
    if (from <= throws_at && throws_at < until) throw std::runtime_error("cell " + std::to_string(throws_at));
    for (Cycle now = from; now < until; ++now) {
      for (; in_ && in_->ready(now); in_->pop()) sum = sum * 31 + in_->front() + now;
      if (out_ && now < end_ && now % 3 == 0) out_->send(now + latency_, sum ^ now);
    }
    now_ = until;
  }
  Cycle next_event(Cycle from) const override { return from < end_ ? from : kNever; }
  bool finished() const override { return now_ >= end_; }
  uint64_t progress() const override { return now_; }
  std::string describe_stall() const override { return {}; }

  std::vector<std::pair<Cycle, Cycle>> windows;
  uint64_t sum = 1;
  Cycle throws_at = kNever;

 private:
  Channel<uint64_t>*in_, *out_;
  Cycle latency_, end_, now_ = 0;
};

// Returns what a ring of cells comes to.
std::vector<uint64_t> run_ring(size_t size, const EngineLoop::Options& options) {
  std::vector<Channel<uint64_t>> channels(size);
  std::vector<std::unique_ptr<RingCell>> cells;
  for (size_t i = 0; i < size; ++i)
    cells.push_back(std::make_unique<RingCell>(&channels[i], &channels[(i + 1) % size], 49, 2000));
  EngineLoop engine(options);
  for (auto& cell : cells) engine.add(*cell);
  for (auto& channel : channels) engine.add(channel);
  engine.run([](Cycle) { return EngineLoop::Next::NothingMore; });
  std::vector<uint64_t> sums;
  for (auto& cell : cells) sums.push_back(cell->sum);
  return sums;
}

}  // namespace

TEST_CASE("every cell advances once a window, with any number of threads") {
  for (uint32_t threads : {1u, 2u, 3u, 8u, 20u}) {
    std::vector<std::unique_ptr<RingCell>> cells;
    std::vector<Cell*> pointers;
    for (int i = 0; i < 7; ++i)
      pointers.push_back(cells.emplace_back(std::make_unique<RingCell>(nullptr, nullptr, 1, 1)).get());
    CellPool pool(pointers, {threads}, {3, 1, 4, 1, 5});
    CHECK(pool.num_threads() == std::min(threads, 7u));
    std::vector<std::pair<Cycle, Cycle>> windows;
    for (Cycle now = 0; now < 5000; now += 5) {
      pool.advance(now, now + 5);
      windows.push_back({now, now + 5});
    }

    for (const auto& cell : cells) CHECK(cell->windows == windows);
  }
}

TEST_CASE("every cell advances once a window, whatever numbers of threads are wanted one after another") {
  std::vector<std::unique_ptr<RingCell>> cells;
  std::vector<Cell*> pointers;
  for (int i = 0; i < 9; ++i)
    pointers.push_back(cells.emplace_back(std::make_unique<RingCell>(nullptr, nullptr, 1, 1)).get());
  CellPool pool(pointers, {6, 3, 1}, {0, 1, 2, 3, 4, 5});
  std::vector<std::pair<Cycle, Cycle>> windows;
  for (Cycle now = 0; now < 4000; ++now) {
    pool.advance(now, now + 1, (now / 3 + now / 40) % 3);
    windows.push_back({now, now + 1});
  }

  for (const auto& cell : cells) CHECK(cell->windows == windows);
}

TEST_CASE("what the first cell throws reaches the caller, and the pool goes on") {
  std::vector<std::unique_ptr<RingCell>> cells;
  std::vector<Cell*> pointers;
  for (int i = 0; i < 4; ++i)
    pointers.push_back(cells.emplace_back(std::make_unique<RingCell>(nullptr, nullptr, 1, 1)).get());
  cells[3]->throws_at = 12;
  cells[1]->throws_at = 11;
  CellPool pool(pointers, {3});
  pool.advance(0, 10);

  CHECK_THROWS_WITH(pool.advance(10, 20), "cell 11");
  pool.advance(20, 30);
  for (const auto& cell : cells) CHECK(cell->windows.size() == 3);
}

TEST_CASE("neither threads nor windows nor homes change what cells tell each other") {
  const std::vector<uint64_t> expected = run_ring(5, {.turn = 49});
  for (uint32_t threads : {0u, 2u, 4u})
    for (Cycle window : {Cycle{1}, Cycle{7}, Cycle{0}}) {
      CAPTURE(threads, window);
      CHECK(run_ring(5, {.turn = 49, .threads = threads, .window = window, .homes = {1, 0, 0, 3, 2}}) ==
            expected);
    }
}

TEST_CASE("a pool says whether a cell has moved, on several threads and on one") {
  RingCell moves(nullptr, nullptr, 1, 1), rests(nullptr, nullptr, 1, 1);
  CellPool pool({&rests, &moves}, {2, 1});
  CHECK(pool.advance(0, 5));
  CHECK_FALSE(pool.advance(0, 5));  // The cells' progress is the end of the window.
  CHECK(pool.advance(5, 6, 1));
  CHECK_FALSE(pool.advance(0, 6));
  CHECK_FALSE(pool.advance(0, 6, 1));
}

TEST_CASE("each task of a list is taken once in a round, and none after it") {
  TaskLists lists({{4, 2}, {}, {7}});
  CHECK(lists.num_tasks() == 3);
  for (uint64_t round = 1; round < 4; ++round) {
    CHECK(lists.take(0, round) == 4);
    CHECK(lists.take(0, round) == 2);
    CHECK(lists.take(0, round) == TaskLists::kNone);
    CHECK(lists.take(1, round) == TaskLists::kNone);
    CHECK(lists.take(2, round) == 7);
    if (round > 1) CHECK(lists.take(0, round - 1) == TaskLists::kNone);
  }
}

TEST_CASE("a turn is cut into windows that end with it") {
  RingCell cell(nullptr, nullptr, 1, 25);
  EngineLoop engine({.turn = 20, .window = 8});
  engine.add(cell);
  std::vector<Cycle> turns;
  engine.run([&](Cycle now) { return turns.push_back(now), EngineLoop::Next::NothingMore; });

  CHECK(turns == std::vector<Cycle>{0, 20, 40});
  CHECK(cell.windows ==
        std::vector<std::pair<Cycle, Cycle>>{{0, 8}, {8, 16}, {16, 20}, {20, 28}, {28, 36}, {36, 40}});
}

// Returns how many windows each number of threads gets, of which cost[i] is the time of a window.
std::vector<uint32_t> windows_of(const std::vector<int>& cost, uint32_t windows) {
  Pace pace(cost.size());
  Pace::Time now{};
  uint64_t progress = 0;
  std::vector<uint32_t> out(cost.size());
  for (uint32_t i = 0; i < windows; ++i) {
    const size_t way = pace.way_for(now, [&] { return progress; });
    ++out[way];
    now += std::chrono::microseconds(cost[way]);
    progress += 100;
  }
  return out;
}

TEST_CASE("several threads stop when one is faster, and go on when they are") {
  constexpr uint32_t kTrial = Pace::kTrial, kLeast = Pace::kLeast, kStay = Pace::kStay;
  // At first the answer counts as one thread's, so that one thread stays for 2 and then 4 lengths.
  CHECK(windows_of({120, 100}, 6 * kStay + 4 * kTrial) == std::vector{2 * kTrial, 2 * kTrial + 6 * kStay});
  CHECK(windows_of({80, 100}, 3 * kStay + 4 * kTrial) == std::vector{2 * kTrial + 3 * kStay, 2 * kTrial});
  CHECK(windows_of({10, 100}, 3 * kStay + 2 * (kTrial + kLeast)) ==
        std::vector{2 * kTrial + 3 * kStay, 2 * kLeast});
}

TEST_CASE("the fastest of several numbers of threads goes on, and much slower ones end the trials") {
  constexpr uint32_t kTrial = Pace::kTrial, kLeast = Pace::kLeast, kStay = Pace::kStay;
  CHECK(windows_of({50, 30, 40, 70, 130}, kStay + 3 * kTrial + kLeast) ==
        std::vector<uint32_t>{kTrial, kTrial + kStay, kTrial, kLeast, 0});
  CHECK(windows_of({30, 50, 10, 10}, kStay + kTrial + kLeast) ==
        std::vector<uint32_t>{kTrial + kStay, kLeast, 0, 0});
  CHECK(windows_of({400, 300, 200, 100}, 2 * kStay + 4 * kTrial) ==
        std::vector<uint32_t>{kTrial, kTrial, kTrial, kTrial + 2 * kStay});
}

}  // namespace glint
