// Works on ranges of a count of things on several threads.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/check.h"

namespace glint {

// Cuts [0, count) into ranges of `range` things, of which the last may be shorter, and calls work(begin, end)
// for each of them on up to `threads` threads, of which the caller's is one. The ranges do not depend on the
// threads. When calls throw, no further range is begun, and the exception of the first range that threw
// leaves.
template <class Work>
void parallel_ranges(size_t count, size_t range, uint32_t threads, const Work& work) {
  GLINT_CHECK(threads > 0, "no threads for work; host_threads() says how many stand for 0");
  const size_t ranges = (count + range - 1) / range;
  std::atomic<size_t> next = 0;
  std::mutex mutex;  // of the following
  std::exception_ptr error;
  size_t at = ranges;  // the range that threw `error`
  const auto take_ranges = [&] {
    for (size_t i = next++; i < ranges; i = next++) try {
        work(i * range, std::min(count, (i + 1) * range));
      } catch (...) {
        next = ranges;
        const std::lock_guard lock(mutex);
        if (i < at) at = i, error = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> helpers;
    for (size_t t = 1; t < std::min<size_t>(threads, ranges); ++t) helpers.emplace_back(take_ranges);
    take_ranges();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace glint
