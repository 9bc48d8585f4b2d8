// Makes results on several threads, and hands them over in order on one.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace glint {

// Calls make(i) for each i below `count` on up to `threads` threads, of which the caller's is one, and
// take(i, result) in the order of i on the caller's thread. Results that wait to be taken are at most two for
// each thread, so that memory does not grow with `count`. When make(i) throws, the exception leaves run()
// after the results before i were taken, and no further result is made.
template <class Result>
class OrderedWork {
 public:
  OrderedWork(size_t count, uint32_t threads) : count_(count), threads_(std::max(threads, 1u)) {}

  template <class Make, class Take>
  void run(Make&& make, Take&& take) {
    std::vector<std::jthread> helpers;
    const Stop stop{*this};  // leaves before the helpers are joined
    for (uint32_t t = 1; t < std::min<size_t>(threads_, count_); ++t)
      helpers.emplace_back([&] {
        while (const std::optional<size_t> index = claim(true)) fill(*index, make);
      });
    for (size_t i = 0; i < count_; ++i) {
      while (!is_made(i)) {
        if (const std::optional<size_t> index = claim(false))
          fill(*index, make);
        else
          wait_for(i);
      }
      Place place = std::move(places_[i % window()]);
      if (place.error) std::rethrow_exception(place.error);
      take(i, std::move(*place.result));
      free(i);
    }
  }

 private:
  struct Place {
    std::optional<Result> result;
    std::exception_ptr error;
  };
  // Lets the helpers end, also when the caller leaves by an exception.
  struct Stop {
    OrderedWork& work;
    ~Stop() {
      const std::lock_guard lock(work.mutex_);
      work.stopped_ = true;
      work.changed_.notify_all();
    }
  };

  size_t window() const { return places_.size(); }

  // Returns the next index to make. Waits for room if `waits`, and returns none when there is nothing left to
  // make, or no room.
  std::optional<size_t> claim(bool waits) {
    std::unique_lock lock(mutex_);
    const auto has_room = [&] { return next_ < count_ && next_ < taken_ + window(); };
    if (waits) changed_.wait(lock, [&] { return stopped_ || next_ == count_ || has_room(); });
    if (stopped_ || !has_room()) return std::nullopt;
    return next_++;
  }
  template <class Make>
  void fill(size_t index, Make&& make) {
    Place place;
    try {
      place.result.emplace(make(index));
    } catch (...) {
      place.error = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    if (place.error) next_ = count_;
    places_[index % window()] = std::move(place);
    changed_.notify_all();
  }
  bool has_result(size_t i) const {
    const Place& place = places_[i % window()];
    return place.result || place.error;
  }
  bool is_made(size_t i) {
    const std::lock_guard lock(mutex_);
    return has_result(i);
  }
  void wait_for(size_t i) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return has_result(i); });
  }
  void free(size_t i) {
    const std::lock_guard lock(mutex_);
    places_[i % window()] = {};
    taken_ = i + 1;
    changed_.notify_all();
  }

  const size_t count_;
  const uint32_t threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Place> places_ = std::vector<Place>(2 * size_t{threads_});  // index i has place i % window()
  size_t next_ = 0;   // first index that nobody has claimed
  size_t taken_ = 0;  // number of results that were taken
  bool stopped_ = false;
};

}  // namespace glint
