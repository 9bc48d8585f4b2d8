// Holds which thread does which tasks of a round, and which of them have been taken.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace glint {

// Gives each thread a list of tasks that are done in every round. Any thread may take from any list. Nothing
// is prepared for a round: a list counts what has been taken from it in all rounds, so a thread that comes
// late to a round finds nothing to take.
class TaskLists {
 public:
  static constexpr uint32_t kNone = ~uint32_t{0};

  explicit TaskLists(const std::vector<std::vector<uint32_t>>& lists)
      : num_lists_(uint32_t(lists.size())), lists_(std::make_unique<List[]>(lists.size())) {
    for (uint32_t i = 0; i < num_lists_; ++i) {
      lists_[i].first = uint32_t(tasks_.size());
      lists_[i].count = uint32_t(lists[i].size());
      tasks_.insert(tasks_.end(), lists[i].begin(), lists[i].end());
    }
  }

  // Takes a task of the list for the round, or returns kNone when none is left. Rounds count from 1.
  uint32_t take(uint32_t list, uint64_t round) {
    List& from = lists_[list];
    const uint64_t end = round * from.count;
    uint64_t taken = from.taken.load(std::memory_order_relaxed);
    while (taken < end)
      if (from.taken.compare_exchange_weak(taken, taken + 1, std::memory_order_acq_rel))
        return tasks_[from.first + uint32_t(taken + from.count - end)];
    return kNone;
  }
  uint32_t num_lists() const { return num_lists_; }
  uint32_t num_tasks() const { return uint32_t(tasks_.size()); }

 private:
  // Has a cache line of its own, because each thread writes to its list.
  struct alignas(64) List {
    std::atomic<uint64_t> taken{0};  // in all rounds
    uint32_t first = 0, count = 0;   // its tasks in `tasks_`
  };

  const uint32_t num_lists_;
  const std::unique_ptr<List[]> lists_;
  std::vector<uint32_t> tasks_;
};

}  // namespace glint
