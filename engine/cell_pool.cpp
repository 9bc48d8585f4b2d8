// Hands windows to threads, and lets threads wait for each other without taking processors from other
// programs.
// SPDX-License-Identifier: Apache-2.0
#include "engine/cell_pool.h"

#include <algorithm>
#include <utility>

namespace glint {
namespace {

constexpr uint64_t kEnd = ~uint64_t{0};

// Choice: a thread polls this many times before it sleeps. The polls take a few microseconds, which is about
// as long as the work between two windows. A longer wait means that another program has the processor that
// the awaited thread needs, and polling on would keep that thread from it.
constexpr int kPolls = 2'000;

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

// Waits until `value` is no longer `old`, and returns the new value.
uint64_t wait_change(const std::atomic<uint64_t>& value, uint64_t old) {
  for (int i = 0; i < kPolls; ++i) {
    if (const uint64_t now = value.load(std::memory_order_acquire); now != old) return now;
    relax();
  }
  value.wait(old, std::memory_order_acquire);
  return value.load(std::memory_order_acquire);
}

}  // namespace

CellPool::CellPool(const std::vector<Cell*>& cells, uint32_t threads, const std::vector<uint32_t>& homes)
    : places_(std::make_unique<Place[]>(cells.size())), num_places_(cells.size()) {
  const uint32_t count = std::clamp<uint32_t>(threads, 1, uint32_t(std::max<size_t>(cells.size(), 1)));
  for (size_t i = 0; i < num_places_; ++i) {
    places_[i].cell = cells[i];
    places_[i].home = (homes.empty() ? uint32_t(i) : homes[i % homes.size()]) % count;
  }
  for (uint32_t t = 1; t < count; ++t) helpers_.emplace_back([this, t] { help(t); });
}

CellPool::~CellPool() {
  window_.store(kEnd, std::memory_order_release);
  window_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void CellPool::advance(Cycle from, Cycle until) {
  from_ = from;
  until_ = until;
  left_.store(num_places_, std::memory_order_relaxed);
  const uint64_t window = window_.load(std::memory_order_relaxed) + 1;
  window_.store(window, std::memory_order_release);
  window_.notify_all();
  work(0, window);
  for (uint64_t left = left_.load(std::memory_order_acquire); left != 0;) left = wait_change(left_, left);
  rethrow();
}

void CellPool::help(uint32_t thread) {
  for (uint64_t seen = 0;;) {
    seen = wait_change(window_, seen);
    if (seen == kEnd) return;
    work(thread, seen);
  }
}

void CellPool::work(uint32_t thread, uint64_t window) {
  for (size_t i = 0; i < num_places_; ++i)
    if (places_[i].home == thread) take(places_[i], window);
  for (size_t i = 0; i < num_places_; ++i) take(places_[i], window);
}

// Takes the cell and advances it, unless another thread has taken it for this window. Every cell is taken
// once in each window, so a thread that comes after the end of its window finds no cell to take.
void CellPool::take(Place& place, uint64_t window) {
  uint64_t before = window - 1;
  if (place.taken.load(std::memory_order_relaxed) != before) return;
  if (!place.taken.compare_exchange_strong(before, window, std::memory_order_acq_rel)) return;
  try {
    place.cell->advance(from_, until_);
  } catch (...) {
    place.error = std::current_exception();
  }
  if (left_.fetch_sub(1, std::memory_order_acq_rel) == 1) left_.notify_one();
}

void CellPool::rethrow() {
  std::exception_ptr first;
  for (size_t i = 0; i < num_places_; ++i)
    if (std::exception_ptr error = std::exchange(places_[i].error, nullptr); error && !first) first = error;
  if (first) std::rethrow_exception(first);
}

}  // namespace glint
