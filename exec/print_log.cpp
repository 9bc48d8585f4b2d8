// Keeps the first lines of a launch.
// SPDX-License-Identifier: Apache-2.0
#include "exec/print_log.h"

#include <fmt/format.h>
#include <iterator>
#include <utility>

namespace glint::exec {

// Returns whether a line has room. A full log stays full, and the last thread in it can only be replaced by
// an earlier one. So a line that has no room now will never have it.
bool PrintLog::has_room(uint64_t thread) const {
  return kept_ < limit_ || (!lines_.empty() && thread < std::prev(lines_.end())->first);
}

bool PrintLog::wants(uint64_t thread) const {
  const std::lock_guard lock(mutex_);
  return has_room(thread);
}

void PrintLog::add(uint64_t thread, const std::string& text, bool ends) {
  const std::lock_guard lock(mutex_);
  if (!has_room(thread)) {
    open_.erase(thread);
    dropped_ += ends;
    return;
  }
  std::string& line = open_[thread];
  line += text;
  if (!ends) return;
  if (line.empty() || line.back() != '\n') line += '\n';
  lines_[thread].push_back(std::move(line));
  open_.erase(thread);
  if (++kept_ <= limit_) return;
  const auto last = std::prev(lines_.end());
  last->second.pop_back();
  if (last->second.empty()) lines_.erase(last);
  --kept_;
  ++dropped_;
}

std::string PrintLog::take() {
  const std::lock_guard lock(mutex_);
  std::string out;
  for (const auto& [thread, lines] : lines_)
    for (const std::string& line : lines) out += line;
  for (const auto& [thread, line] : open_)  // lines of lanes that a fault has stopped in the middle
    if (has_room(thread)) out += line + "\n";
  if (dropped_) out += fmt::format("({} more messages not shown; the limit is {})\n", dropped_, limit_);
  lines_.clear(), open_.clear();
  kept_ = dropped_ = 0;
  return out;
}

}  // namespace glint::exec
