// Holds the threads that advance the cells of a machine together, one window after the other.
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

// Advances all cells by a window at a time, on several threads. The caller is one of the threads, and the
// others live as long as the pool. A thread takes its own cells first, because they stay in its caches, and
// then the cells that no thread has taken yet. Which thread advances a cell never shows in a result: a cell
// reads and writes its own state only, and each window ends before the next begins.
class CellPool {
 public:
  // Starts the threads. Cell i belongs to thread homes[i] modulo `threads`. Without homes, the cells are
  // dealt out to the threads in turn.
  CellPool(const std::vector<Cell*>& cells, uint32_t threads, const std::vector<uint32_t>& homes = {});
  ~CellPool();
  CellPool(const CellPool&) = delete;
  CellPool& operator=(const CellPool&) = delete;

  // Advances every cell and returns when all have advanced. If cells have thrown, it rethrows the exception
  // of the first of them in the order of the cells.
  void advance(Cycle from, Cycle until);
  uint32_t num_threads() const { return uint32_t(helpers_.size()) + 1; }

 private:
  // Holds a cell and whether it is taken. Each place has a cache line of its own, because several threads
  // write to neighbouring places.
  struct alignas(64) Place {
    Cell* cell = nullptr;
    uint32_t home = 0;
    std::atomic<uint64_t> taken{0};  // the last window for which a thread took the cell
    std::exception_ptr error;
  };

  void help(uint32_t thread);
  void work(uint32_t thread, uint64_t window);
  void take(Place& place, uint64_t window);
  void rethrow();

  std::unique_ptr<Place[]> places_;
  const size_t num_places_;
  Cycle from_ = 0, until_ = 0;                   // the bounds of the present window
  alignas(64) std::atomic<uint64_t> window_{0};  // number of the window, or kEnd: the threads end
  alignas(64) std::atomic<uint64_t> left_{0};    // number of cells that have not advanced yet
  std::vector<std::thread> helpers_;
};

}  // namespace glint
