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
#include <vector>

#include "base/block_hash.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

struct Header {
  char magic[8] = {'g', 'l', 'i', 'n', 't', 's', 'h', '2'};
  uint64_t key_bytes = 0, value_bytes = 0, hash = 0;  // `hash` covers key and value
};

Header header_of(const std::string& key, std::string_view head, std::string_view rest) {
  Header header;
  header.key_bytes = key.size(), header.value_bytes = head.size() + rest.size();
  BlockHash hash;
  for (const std::string_view part : {std::string_view(key), head, rest}) hash.add(part);
  header.hash = hash.first();
  return header;
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

std::optional<std::string> FileStore::find(const std::string& key) {
  std::string value;
  const auto room = [&](uint64_t bytes) {
    value.resize(bytes);
    return value.data();
  };
  if (!find(key, {}, room)) return std::nullopt;
  return value;
}

bool FileStore::find(const std::string& given, std::span<char> head, const Room& room) {
  if (options_.folder.empty()) return false;
  const std::string path = file_of(given), key = options_.build + '\0' + given;
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) return false;
  const auto bytes = uint64_t(in.tellg());
  in.seekg(0);
  Header header;
  const bool begins = bytes >= sizeof header && in.read(reinterpret_cast<char*>(&header), sizeof header) &&
                      std::memcmp(header.magic, Header{}.magic, sizeof header.magic) == 0;
  const uint64_t after = bytes - std::min<uint64_t>(bytes, sizeof header);
  if (!begins || header.key_bytes > after || header.value_bytes != after - header.key_bytes ||
      header.value_bytes < head.size()) {
    ++damaged_;
    return false;
  }
  std::string found_key(header.key_bytes, 0);
  const uint64_t left = header.value_bytes - head.size();
  char* const rest = room(left);
  in.read(found_key.data(), std::streamsize(found_key.size()));
  in.read(head.data(), std::streamsize(head.size()));
  in.read(rest, std::streamsize(left));
  if (!in || header_of(found_key, {head.data(), head.size()}, {rest, left}).hash != header.hash) {
    ++damaged_;
    return false;
  }
  if (found_key != key) return false;
  std::error_code failed;
  fs::last_write_time(path, fs::file_time_type::clock::now(), failed);
  return true;
}

void FileStore::store(const std::string& given, std::string_view head, std::string_view rest) {
  if (options_.folder.empty()) return;
  std::error_code failed;
  fs::create_directories(options_.folder, failed);
  const std::string path = file_of(given), key = options_.build + '\0' + given;
  const std::string temporary =
      fmt::format("{}.{}.{:x}.{}", path, ::getpid(), reinterpret_cast<uintptr_t>(this), num_temporaries_++);
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    const Header header = header_of(key, head, rest);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out << key << head << rest;
    out.flush();
    if (!out) {
      out.close();
      fs::remove(temporary, failed);
      return;
    }
  }
  fs::rename(temporary, path, failed);
  if (failed) fs::remove(temporary, failed);
  sweep(key.size() + head.size() + rest.size());
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
