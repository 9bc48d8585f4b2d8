// Writes and reads the files of a store, each with a header, its key and its value, and keeps the folder
// small.
// SPDX-License-Identifier: Apache-2.0
#include "base/file_store.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <initializer_list>
#include <mutex>
#include <unistd.h>
#include <utility>
#include <vector>

#include "base/block_hash.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// Stands at the beginning of a file. The key follows it, then the head of the value, and at a multiple of
// kPage its rest and FileStore::kRestSlack zeros. A value without a rest ends with its head.
struct Header {
  char magic[8] = {'g', 'l', 'i', 'n', 't', 's', 'h', '3'};
  uint64_t key_bytes = 0, head_bytes = 0, rest_bytes = 0;
  uint64_t hash = 0;  // of all that follows the header, but for what fills the head's last page

  // Return where the parts of the file are. Sums of sizes that a damaged file has may wrap around; a file
  // with such sizes does not have the length that they ask for.
  uint64_t head_at() const { return sizeof *this + key_bytes; }
  uint64_t rest_at() const { return (head_at() + head_bytes + kPage - 1) / kPage * kPage; }
  uint64_t file_bytes() const {
    return rest_bytes ? rest_at() + rest_bytes + FileStore::kRestSlack : head_at() + head_bytes;
  }

  static constexpr uint64_t kPage = 4096;
};

uint64_t hash_of(std::initializer_list<std::string_view> parts) {
  BlockHash hash;
  for (const std::string_view part : parts) hash.add(part);
  return hash.first();
}

// Removes the oldest files with this ending until the folder holds at most `max_bytes` of such files.
void remove_oldest(const std::string& folder, const std::string& ending, uint64_t max_bytes) {
  struct Entry {
    fs::file_time_type time;
    uint64_t bytes;
    fs::path path;
  };
  std::vector<Entry> entries;
  uint64_t bytes = 0;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->path().extension() != ending) continue;
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

uint64_t content_hash(std::string_view bytes, uint64_t seed) {
  uint64_t hash = seed;
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

std::string FileStore::file_of(const std::string& key) const {
  return fmt::format("{}/{:016x}{}", options_.folder, content_hash(options_.build + '\0' + key),
                     options_.ending);
}

// Is what a file of the store says. The views lie in its pages.
struct FileStore::Found {
  std::string_view key, head;
  Rest rest;

  // Returns nullopt when the file is damaged.
  static std::optional<Found> in(Pages pages) {
    char* const bytes = static_cast<char*>(pages.get());
    const size_t size = pages.get_deleter().bytes;
    Header header;
    if (size < sizeof header) return std::nullopt;
    std::memcpy(&header, bytes, sizeof header);
    const bool is_whole = std::memcmp(header.magic, Header{}.magic, sizeof header.magic) == 0 &&
                          std::max({header.key_bytes, header.head_bytes, header.rest_bytes}) <= size &&
                          header.file_bytes() == size;
    if (!is_whole) return std::nullopt;
    Found found{{bytes + sizeof header, header.key_bytes}, {bytes + header.head_at(), header.head_bytes}, {}};
    std::string_view rest, slack;
    if (header.rest_bytes) {
      found.rest.data = bytes + header.rest_at(), found.rest.bytes = header.rest_bytes;
      rest = {found.rest.data, header.rest_bytes}, slack = {rest.end(), kRestSlack};
    }
    found.rest.pages = std::move(pages);
    if (hash_of({found.key, found.head, rest, slack}) != header.hash) return std::nullopt;
    return found;
  }
};

std::optional<FileStore::Found> FileStore::open(const std::string& given) {
  if (options_.folder.empty()) return std::nullopt;
  const std::string path = file_of(given);
  std::optional<Pages> pages = pages_of_file(path);
  if (!pages) return std::nullopt;
  std::optional<Found> found = Found::in(std::move(*pages));
  if (!found) {
    ++damaged_;
    return std::nullopt;
  }
  if (found->key != options_.build + '\0' + given) return std::nullopt;
  std::error_code failed;
  fs::last_write_time(path, fs::file_time_type::clock::now(), failed);
  return found;
}

std::optional<std::string> FileStore::find(const std::string& key) {
  const std::optional<Found> found = open(key);
  if (!found || found->rest.bytes) return std::nullopt;
  return std::string(found->head);
}

std::optional<FileStore::Rest> FileStore::find(const std::string& key, std::span<char> head) {
  std::optional<Found> found = open(key);
  if (!found || found->head.size() != head.size()) return std::nullopt;
  std::copy(found->head.begin(), found->head.end(), head.begin());
  return std::move(found->rest);
}

void FileStore::store(const std::string& given, std::string_view head, std::string_view rest) {
  if (options_.folder.empty()) return;
  std::error_code failed;
  fs::create_directories(options_.folder, failed);
  const std::string path = file_of(given), key = options_.build + '\0' + given;
  const std::string temporary =
      fmt::format("{}.{}.{:x}.{}", path, ::getpid(), reinterpret_cast<uintptr_t>(this), num_temporaries_++);
  Header header;
  header.key_bytes = key.size(), header.head_bytes = head.size(), header.rest_bytes = rest.size();
  const std::string slack(rest.empty() ? 0 : kRestSlack, 0);
  header.hash = hash_of({key, head, rest, slack});
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out << key << head;
    if (!rest.empty())
      out << std::string(header.rest_at() - header.head_at() - head.size(), 0) << rest << slack;
    out.flush();
    if (!out) {
      out.close();
      fs::remove(temporary, failed);
      return;
    }
  }
  fs::rename(temporary, path, failed);
  if (failed) fs::remove(temporary, failed);
  sweep(header.file_bytes());
}

// Limits the size of the folder. The folder is only searched from time to time, so it may exceed its limit by
// an eighth for each process.
void FileStore::sweep(uint64_t written) {
  const std::lock_guard lock(sweeping_);
  written_bytes_ += written;
  if (swept_ && written_bytes_ < options_.max_bytes / 8) return;
  swept_ = true;
  written_bytes_ = 0;
  remove_oldest(options_.folder, options_.ending, options_.max_bytes);
}

}  // namespace glint
