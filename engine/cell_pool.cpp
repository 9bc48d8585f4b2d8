// Hands windows to threads, and lets threads wait for each other without taking processors from other
// programs.
// SPDX-License-Identifier: Apache-2.0
#include "engine/cell_pool.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace glint {
namespace {

constexpr uint64_t kEnd = ~uint64_t{0};
constexpr uint64_t kMostWays = 16;  // numbers of threads that a pool can choose from

// CellPool::left_ counts cells that have moved in steps of kMoved, and cells that have thrown in steps of
// kThrown.
constexpr uint64_t kMoved = uint64_t{1} << 24, kThrown = uint64_t{1} << 44;

// Choice: a thread polls this many times before it sleeps. The polls take a few microseconds, which is about
// as long as the work between two windows. A longer wait means that another program has the processor that
// the awaited thread needs, and polling on would keep that thread from it.
constexpr int kPolls = 2'000;

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

// Waits until `is_over(value)`, and returns the value.
template <class IsOver>
uint64_t wait_until(const std::atomic<uint64_t>& value, IsOver&& is_over) {
  for (;;) {
    uint64_t now = value.load(std::memory_order_acquire);
    for (int i = 0; i < kPolls && !is_over(now); ++i) {
      relax();
      now = value.load(std::memory_order_acquire);
    }
    if (is_over(now)) return now;
    value.wait(now, std::memory_order_acquire);
  }
}

// Returns the cells of each thread.
std::vector<std::vector<uint32_t>> dealt(size_t cells, uint32_t threads, const std::vector<uint32_t>& homes) {
  std::vector<std::vector<uint32_t>> lists(
      std::clamp<uint32_t>(threads, 1, uint32_t(std::max<size_t>(cells, 1))));
  for (uint32_t i = 0; i < cells; ++i)
    lists[(homes.empty() ? i : homes[i % homes.size()]) % lists.size()].push_back(i);
  return lists;
}

}  // namespace

CellPool::CellPool(const std::vector<Cell*>& cells, const std::vector<uint32_t>& counts,
                   const std::vector<uint32_t>& homes)
    : num_cells_(uint32_t(cells.size())), places_(std::make_unique<Place[]>(cells.size())) {
  GLINT_CHECK(!counts.empty() && counts.size() <= kMostWays, "{} numbers of threads", counts.size());
  for (size_t i = 0; i < cells.size(); ++i) {
    places_[i].cell = cells[i];
    places_[i].progress = cells[i]->progress();
  }
  for (const uint32_t count : counts) ways_.emplace_back(dealt(cells.size(), count, homes));
  const uint32_t threads = ways_[0].lists.num_lists();
  wanted_ = threads;
  for (uint32_t t = 1; t < threads; ++t) helpers_.emplace_back([this, t] { help(t); });
}

CellPool::~CellPool() {
  window_.round.store(kEnd, std::memory_order_release);
  window_.round.notify_all();
  wanted_.store(num_threads(), std::memory_order_release);
  wanted_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

bool CellPool::advance(Cycle from, Cycle until, size_t way) {
  window_.from = from;
  window_.until = until;
  Way& chosen = ways_[way];
  const uint32_t threads = chosen.lists.num_lists();
  if (threads == 1) return advance_alone();
  left_.store(num_cells_, std::memory_order_relaxed);
  if (wanted_.load(std::memory_order_relaxed) != threads) {
    wanted_.store(threads, std::memory_order_release);
    wanted_.notify_all();
  }
  const uint64_t round = ++chosen.rounds;
  window_.round.store(round * kMostWays + way, std::memory_order_release);
  window_.round.notify_all();
  work(0, chosen.lists, round);
  const uint64_t happened = wait_until(left_, [](uint64_t left) { return left % kMoved == 0; });
  if (happened >= kThrown) rethrow();
  return happened != 0;
}

// Advances the cells on the caller's thread. The others find no new window, and sleep.
bool CellPool::advance_alone() {
  uint64_t happened = 0;
  for (uint32_t i = 0; i < num_cells_; ++i) happened += advance(places_[i]);
  if (happened >= kThrown) rethrow();
  return happened != 0;
}

void CellPool::help(uint32_t thread) {
  for (uint64_t seen = 0;;) {
    seen = wait_until(window_.round, [seen](uint64_t round) { return round != seen; });
    if (seen == kEnd) return;
    TaskLists& lists = ways_[seen % kMostWays].lists;
    if (thread < lists.num_lists())
      work(thread, lists, seen / kMostWays);
    else
      rest(thread);
  }
}

// Sleeps until the thread is wanted.
void CellPool::rest(uint32_t thread) {
  for (uint32_t wanted; (wanted = wanted_.load(std::memory_order_acquire)) <= thread;) wanted_.wait(wanted);
}

// Advances the thread's own cells, and then those of other threads that nobody has taken. Every cell is taken
// once in a round, so a thread that comes after the end of its round finds none.
void CellPool::work(uint32_t thread, TaskLists& lists, uint64_t round) {
  uint64_t change = 0;
  for (uint32_t k = 0; k < lists.num_lists(); ++k) {
    const uint32_t list = (thread + k) % lists.num_lists();
    for (uint32_t task; (task = lists.take(list, round)) != TaskLists::kNone;)
      change += advance(places_[task]) - 1;
  }
  if (change == 0) return;
  if ((left_.fetch_add(change, std::memory_order_acq_rel) + change) % kMoved == 0) left_.notify_one();
}

// Advances a cell, and returns what has happened in it as left_ counts it.
uint64_t CellPool::advance(Place& place) {
  try {
    place.cell->advance(window_.from, window_.until);
  } catch (...) {
    place.error = std::current_exception();
    return kThrown;
  }
  const uint64_t progress = place.cell->progress();
  return std::exchange(place.progress, progress) == progress ? 0 : kMoved;
}

void CellPool::rethrow() {
  std::exception_ptr first;
  for (size_t i = 0; i < num_cells_; ++i)
    if (std::exception_ptr error = std::exchange(places_[i].error, nullptr); error && !first) first = error;
  if (first) std::rethrow_exception(first);
}

}  // namespace glint
