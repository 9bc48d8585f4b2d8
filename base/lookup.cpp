// Hashes the files that somebody looked for.
// SPDX-License-Identifier: Apache-2.0
#include "base/lookup.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include "base/block_hash.h"
#include "base/file_pages.h"

namespace glint {

Lookup look_up(const std::string& path, uint32_t threads) {
  const std::optional<Pages> pages = pages_of_file(path);
  if (!pages) return {path};
  const auto* bytes = static_cast<const char*>(pages->get());
  return {path, true, parted_hash({bytes, bytes ? pages->get_deleter().bytes : 0}, threads)};
}

Lookup found_at(const std::string& path, std::string_view bytes) {
  return {path, true, parted_hash(bytes, 1)};
}

void LookupLog::add(const std::string& path) {
  const std::lock_guard lock(mutex_);
  paths_.insert(std::filesystem::absolute(path).string());
}

std::optional<std::vector<Lookup>> LookupLog::lookups(uint32_t threads) const {
  // Choice: file systems note the time of a change by two seconds (FAT) or finer.
  constexpr std::chrono::seconds kCoarsest{2};
  const std::lock_guard lock(mutex_);
  std::vector<Lookup> out;
  for (const std::string& path : paths_) {
    out.push_back(look_up(path, threads));
    std::error_code failed;
    const auto changed = std::filesystem::last_write_time(path, failed);
    if (out.back().is_there && (failed || changed > begin_ - kCoarsest)) return std::nullopt;
  }
  return out;
}

bool are_unchanged(const std::vector<Lookup>& lookups, uint32_t threads) {
  return std::all_of(lookups.begin(), lookups.end(),
                     [&](const Lookup& was) { return look_up(was.path, threads) == was; });
}

}  // namespace glint
