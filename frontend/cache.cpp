// Files of the cache: header, key, value; and keeping the folder small.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

namespace glint::frontend {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".shader";

struct Header {
  char magic[8] = {'g', 'l', 'i', 'n', 't', 's', 'h', '1'};
  uint64_t key_bytes = 0, value_bytes = 0, hash = 0;  // of key and value
};

std::string header_bytes(const std::string& key, const std::string& value) {
  Header header;
  header.key_bytes = key.size(), header.value_bytes = value.size();
  header.hash = content_hash(key + value);
  return {reinterpret_cast<const char*>(&header), sizeof header};
}

// Keeps the newest of a folder's entries, up to `max_bytes`.
void remove_oldest(const std::string& folder, uint64_t max_bytes) {
  struct Entry {
    fs::file_time_type time;
    uint64_t bytes;
    fs::path path;
  };
  std::vector<Entry> entries;
  uint64_t bytes = 0;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->path().extension() != kEnding) continue;
    std::error_code gone;  // another process may have removed it
    const uint64_t size = it->file_size(gone);
    const fs::file_time_type time = it->last_write_time(gone);
    if (gone) continue;
    entries.push_back({time, size, it->path()});
    bytes += size;
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (const Entry& entry : entries) {
    if (bytes <= max_bytes) return;
    fs::remove(entry.path, failed);
    bytes -= entry.bytes;
  }
}

}  // namespace

// FNV-1a (Fowler, Noll, Vo), 8 bytes a step, with a fold of the high half, which a step of 8 bytes does not reach down from.
uint64_t content_hash(std::string_view bytes) {
  uint64_t hash = 0xcbf2'9ce4'8422'2325;
  const auto step = [&](uint64_t word) {
    hash = (hash ^ word) * 0x0000'0100'0000'01b3;
    hash ^= hash >> 32;
  };
  for (; bytes.size() >= 8; bytes.remove_prefix(8)) {
    uint64_t word;
    std::memcpy(&word, bytes.data(), 8);
    step(word);
  }
  for (const char c : bytes) step(uint8_t(c));
  return hash;
}

std::string ShaderCache::file_of(const std::string& key) const {
  return fmt::format("{}/{:016x}{}", options_.folder, content_hash(options_.build + '\0' + key), kEnding);
}

ShaderCache::Counts ShaderCache::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::optional<std::string> ShaderCache::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  if (const auto it = memory_.find(key); it != memory_.end()) {
    ++counts_.found;
    return it->second;
  }
  std::optional<std::string> value = options_.folder.empty() ? std::nullopt : read(options_.build + '\0' + key);
  ++(value ? counts_.found : counts_.missing);
  if (value) {
    memory_bytes_ += key.size() + value->size();
    memory_[key] = *value;
    std::error_code failed;
    fs::last_write_time(file_of(key), fs::file_time_type::clock::now(), failed);
  }
  return value;
}

std::optional<std::string> ShaderCache::read(const std::string& key) {
  std::ifstream in(fmt::format("{}/{:016x}{}", options_.folder, content_hash(key), kEnding), std::ios::binary);
  if (!in) return std::nullopt;
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  Header header;
  if (bytes.size() >= sizeof header) std::memcpy(&header, bytes.data(), sizeof header);
  const uint64_t rest = bytes.size() - std::min(bytes.size(), sizeof header);
  const bool fits = bytes.size() >= sizeof header && header.key_bytes <= rest && header.value_bytes == rest - header.key_bytes;
  if (!fits || std::memcmp(header.magic, Header{}.magic, sizeof header.magic) != 0 ||
      content_hash(std::string_view(bytes).substr(sizeof header)) != header.hash) {
    ++counts_.damaged;
    return std::nullopt;
  }
  if (bytes.compare(sizeof header, header.key_bytes, key) != 0) return std::nullopt;
  return bytes.substr(sizeof header + header.key_bytes);
}

void ShaderCache::store(const std::string& key, const std::string& value) {
  const std::lock_guard lock(mutex_);
  if (memory_bytes_ > options_.max_bytes) memory_.clear(), memory_bytes_ = 0;
  memory_bytes_ += key.size() + value.size();
  memory_[key] = value;
  if (options_.folder.empty()) return;
  write(options_.build + '\0' + key, value);
  written_bytes_ += key.size() + value.size();
  // The folder is looked through now and then only: it may exceed the limit by an eighth for each process.
  if (swept_ && written_bytes_ < options_.max_bytes / 8) return;
  swept_ = true;
  written_bytes_ = 0;
  remove_oldest(options_.folder, options_.max_bytes);
}

void ShaderCache::write(const std::string& key, const std::string& value) const {
  std::error_code failed;
  fs::create_directories(options_.folder, failed);
  const std::string path = fmt::format("{}/{:016x}{}", options_.folder, content_hash(key), kEnding);
  const std::string temporary = fmt::format("{}.{}.{:x}", path, ::getpid(), reinterpret_cast<uintptr_t>(this));
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out << header_bytes(key, value) << key << value;
    out.flush();
    if (!out) {
      out.close();
      fs::remove(temporary, failed);
      return;
    }
  }
  fs::rename(temporary, path, failed);
  if (failed) fs::remove(temporary, failed);
}

}  // namespace glint::frontend
