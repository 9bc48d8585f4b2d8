// Writes and reads the files of a store, each with a header, its key and its value, and keeps the folder
// small.
// SPDX-License-Identifier: Apache-2.0
#include "base/file_store.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
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
  char magic[8] = {'g', 'l', 'i', 'n', 't', 's', 'h', '4'};
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

// Returns Header::hash of a file, whose rest is given with the slack behind it.
uint64_t hash_of(std::string_view key, std::string_view head, std::string_view rest, uint32_t threads) {
  const uint64_t of_rest = parted_hash(rest, threads);
  BlockHash hash;
  for (const std::string_view part :
       {key, head, std::string_view(reinterpret_cast<const char*>(&of_rest), sizeof of_rest)})
    hash.add(part);
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
  Header header;
  std::string_view key;
  Large value;

  // Returns nullopt when the file has another length than its header asks for.
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
    Found found{header, {bytes + sizeof header, header.key_bytes}, {}};
    found.value.head = {bytes + header.head_at(), header.head_bytes};
    if (header.rest_bytes) found.value.rest = bytes + header.rest_at(), found.value.bytes = header.rest_bytes;
    found.value.pages = std::move(pages);
    return found;
  }
  // Returns the hash of what is there.
  uint64_t hash(uint32_t threads) const {
    const std::string_view with_slack(value.rest, value.bytes ? value.bytes + kRestSlack : 0);
    return hash_of(key, value.head, with_slack, threads);
  }
};

std::optional<FileStore::Found> FileStore::open(const std::string& given) {
  if (options_.folder.empty()) return std::nullopt;
  const std::string path = file_of(given);
  std::optional<Pages> pages = pages_of_file(path);
  if (!pages) return std::nullopt;
  std::optional<Found> found = Found::in(std::move(*pages));
  if (!found || found->hash(options_.threads) != found->header.hash) {
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
  if (!found || found->value.bytes) return std::nullopt;
  return std::string(found->value.head);
}

std::optional<FileStore::Large> FileStore::find_large(const std::string& key) {
  std::optional<Found> found = open(key);
  if (!found || !found->value.bytes) return std::nullopt;
  return std::move(found->value);
}

// Writes a file of the store. The pieces of its rest are not one block of memory, so their hash is taken from
// the file. Returns false when the file cannot be written.
bool FileStore::write(const std::string& path, const std::string& key, std::string_view head,
                      std::span<const std::string_view> rest) const {
  Header header;
  header.key_bytes = key.size(), header.head_bytes = head.size();
  for (const std::string_view piece : rest) header.rest_bytes += piece.size();
  std::fstream out(path, std::ios::binary | std::ios::in | std::ios::out | std::ios::trunc);
  const auto put_header = [&] { out.write(reinterpret_cast<const char*>(&header), sizeof header); };
  put_header();
  out << key << head;
  if (header.rest_bytes) {
    out << std::string(header.rest_at() - header.head_at() - head.size(), 0);
    for (const std::string_view piece : rest) out << piece;
    out << std::string(kRestSlack, 0);
  }
  out.flush();
  std::optional<Pages> pages = out ? pages_of_file(path) : std::nullopt;
  const std::optional<Found> written = pages ? Found::in(std::move(*pages)) : std::nullopt;
  if (!written) return false;
  header.hash = written->hash(options_.threads);
  out.seekp(0);
  put_header();
  out.flush();
  return bool(out);
}

void FileStore::store(const std::string& given, std::string_view head,
                      std::span<const std::string_view> rest) {
  if (options_.folder.empty()) return;
  std::error_code failed;
  fs::create_directories(options_.folder, failed);
  const std::string path = file_of(given);
  const std::string temporary =
      fmt::format("{}.{}.{:x}.{}", path, ::getpid(), reinterpret_cast<uintptr_t>(this), num_temporaries_++);
  if (!write(temporary, options_.build + '\0' + given, head, rest)) {
    fs::remove(temporary, failed);
    return;
  }
  const uint64_t bytes = fs::file_size(temporary, failed);
  fs::rename(temporary, path, failed);
  if (failed) fs::remove(temporary, failed);
  sweep(bytes);
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
