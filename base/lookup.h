// Remembers which files somebody looked for, so that a later run can tell whether any of them has changed.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// Records a file that was looked for, and what was found.
struct Lookup {
  std::string path;
  bool is_there = false;  // It is a regular file that can be read.
  uint64_t hash = 0;      // of its bytes; 0 if it is not there
  bool operator==(const Lookup&) const = default;
};
template <class Visit>
void for_each_field(Lookup& lookup, const Visit& visit) {
  visit(lookup.path);
  visit(lookup.is_there);
  visit(lookup.hash);
}

// Returns what is at a path. Large files are read on up to `threads` threads of the host.
Lookup look_up(const std::string& path, uint32_t threads = 1);
// Returns what look_up() would, of a file whose bytes are known.
Lookup found_at(const std::string& path, std::string_view bytes);

// Collects the paths at which somebody looks for files, and keeps them from the root on. Any number of
// threads may add to it.
class LookupLog {
 public:
  void add(const std::string& path);
  // Returns what is at the paths. It returns nothing when a file is younger than the log, or a little older:
  // nobody knows then whether it was read before or after it was written.
  std::optional<std::vector<Lookup>> lookups(uint32_t threads) const;

 private:
  const std::filesystem::file_time_type begin_ = std::filesystem::file_time_type::clock::now();
  mutable std::mutex mutex_;  // of the following
  std::set<std::string> paths_;
};

// Returns whether all files are as they were.
bool are_unchanged(const std::vector<Lookup>& lookups, uint32_t threads = 1);

}  // namespace glint
