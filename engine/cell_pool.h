// Threads that advance the cells of a machine together, one window after the other.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

#include "base/types.h"
#include "engine/engine.h"

namespace glint {

// The caller is one of the threads; the others live as long as the pool. A thread takes its own cells first,
// which stay in its caches, then those that nobody has taken yet. Which thread advances a cell never shows in
// a result: a cell reads and writes its own state only, and each window ends before the next begins.
class CellPool {
 public:
  // Cell i belongs to thread homes[i] modulo `threads`; without homes, cells are dealt out in turn.
  CellPool(const std::vector<Cell*>& cells, uint32_t threads, const std::vector<uint32_t>& homes = {});
  ~CellPool();
  CellPool(const CellPool&) = delete;
  CellPool& operator=(const CellPool&) = delete;

  // Returns when every cell has advanced. Rethrows what the first of them, in their order, has thrown.
  void advance(Cycle from, Cycle until);
  uint32_t num_threads() const { return uint32_t(helpers_.size()) + 1; }

 private:
  struct alignas(64) Place {  // a cache line of its own: threads take them
    Cell* cell = nullptr;
    uint32_t home = 0;
    std::atomic<uint64_t> taken{0};  // the last window in which somebody has advanced it
    std::exception_ptr error;
  };

  void help(uint32_t thread);
  void work(uint32_t thread, uint64_t window);
  void take(Place& place, uint64_t window);
  void rethrow();

  std::unique_ptr<Place[]> places_;
  const size_t num_places_;
  Cycle from_ = 0, until_ = 0;                   // of the present window
  alignas(64) std::atomic<uint64_t> window_{0};  // counts; kEnd: the threads go home
  alignas(64) std::atomic<uint64_t> left_{0};    // cells that have not advanced yet
  std::vector<std::thread> helpers_;
};

}  // namespace glint
