// Holds the threads that advance the cells of a machine together, one window after the other.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <thread>
#include <vector>

#include "base/types.h"
#include "engine/engine.h"
#include "engine/task_lists.h"

namespace glint {

// Advances all cells by a window at a time, on several threads. The caller is one of the threads, and the
// others live as long as the pool. A thread takes its own cells first, because they stay in its caches, and
// then the cells of other threads that nobody has taken yet. Which thread advances a cell never shows in a
// result: a cell reads and writes its own state only, and each window ends before the next begins.
class CellPool {
 public:
  // Starts the threads. `counts` holds the numbers of threads that may be wanted, the largest first. With n
  // threads, cell i belongs to thread homes[i] modulo n. Without homes, the cells are dealt out to the
  // threads in turn.
  CellPool(const std::vector<Cell*>& cells, const std::vector<uint32_t>& counts,
           const std::vector<uint32_t>& homes = {});
  ~CellPool();
  CellPool(const CellPool&) = delete;
  CellPool& operator=(const CellPool&) = delete;

  // Advances every cell on counts[way] threads, and returns whether any has moved (Cell::progress). If cells
  // have thrown, it rethrows the exception of the first of them in the order of the cells.
  bool advance(Cycle from, Cycle until, size_t way = 0);
  // Returns the largest number of threads, which is at most that of cells.
  uint32_t num_threads() const { return uint32_t(helpers_.size()) + 1; }

 private:
  // Has a cache line of its own, because several threads write to neighbouring places.
  struct alignas(64) Place {
    Cell* cell = nullptr;
    uint64_t progress = 0;  // after the last window
    std::exception_ptr error;
  };

  // Holds what each thread takes when there are `lists.num_lists()` of them, and how many windows they had.
  struct Way {
    explicit Way(const std::vector<std::vector<uint32_t>>& tasks) : lists(tasks) {}
    TaskLists lists;
    uint64_t rounds = 0;
  };

  void help(uint32_t thread);
  void rest(uint32_t thread);
  void work(uint32_t thread, TaskLists& lists, uint64_t round);
  bool advance_alone();
  uint64_t advance(Place& place);
  void rethrow();

  const uint32_t num_cells_;
  std::unique_ptr<Place[]> places_;
  std::deque<Way> ways_;
  // The bounds of the present window lie beside its number, because every thread reads all three. The number
  // is that of the window among those of its way, times kMostWays, plus the way.
  struct alignas(64) Window {
    std::atomic<uint64_t> round{0};  // or kEnd: the threads end
    Cycle from = 0, until = 0;
  } window_;
  std::atomic<uint32_t> wanted_;  // number of threads; the others sleep
  // This is the number of cells that have not advanced yet, and above it lie the numbers of cells that have
  // moved and that have thrown.
  alignas(64) std::atomic<uint64_t> left_{0};
  std::vector<std::thread> helpers_;
};

}  // namespace glint
