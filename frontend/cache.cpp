// Keeps compiled shaders in memory, in front of the files of the store.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/cache.h"

namespace glint::frontend {

std::string ShaderCache::file_of(const std::string& key) const {
  return files_.file_of(key);
}

ShaderCache::Counts ShaderCache::counts() const {
  const std::lock_guard lock(mutex_);
  Counts out = counts_;
  out.damaged = files_.damaged();
  return out;
}

std::optional<std::string> ShaderCache::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  if (const auto it = memory_.find(key); it != memory_.end()) {
    ++counts_.found;
    return it->second;
  }
  std::optional<std::string> value = files_.find(key);
  ++(value ? counts_.found : counts_.missing);
  if (value) remember(key, *value);
  return value;
}

void ShaderCache::store(const std::string& key, const std::string& value) {
  const std::lock_guard lock(mutex_);
  if (memory_bytes_ > max_bytes_) memory_.clear(), memory_bytes_ = 0;
  remember(key, value);
  files_.store(key, value);
}

void ShaderCache::remember(const std::string& key, const std::string& value) {
  memory_bytes_ += key.size() + value.size();
  memory_[key] = value;
}

}  // namespace glint::frontend
