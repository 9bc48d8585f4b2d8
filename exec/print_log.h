// Collects what the shaders of a launch print. Lines are ordered by launch id and then as each thread printed
// them, whenever the threads ran.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace glint::exec {

// Keeps the first `limit` lines in that order and counts the others. Any number of threads may add at once.
// What is kept does not depend on who comes first, as long as each launch id adds its own lines in order.
class PrintLog {
 public:
  explicit PrintLog(uint64_t limit = 1000) : limit_(limit) {}

  // Returns false when a line that `thread` (its place in the launch, x fastest) began now would not be kept.
  bool wants(uint64_t thread) const;
  // Adds to the thread's present line, and ends the line if `ends` is set.
  void add(uint64_t thread, const std::string& text, bool ends);

  // Returns the lines, each with an end of line, and a last one that counts those left out. Empties the log.
  std::string take();
  uint64_t dropped() const { return dropped_; }

 private:
  bool has_room(uint64_t thread) const;

  const uint64_t limit_;
  mutable std::mutex mutex_;
  uint64_t kept_ = 0, dropped_ = 0;
  std::map<uint64_t, std::vector<std::string>> lines_;  // ordered by thread
  std::map<uint64_t, std::string> open_;                // lines that have not ended
};

}  // namespace glint::exec
