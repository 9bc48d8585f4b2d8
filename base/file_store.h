// Stores values in the files of a folder and finds them by their whole key. Caches use it to keep values
// longer than a process lives.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/file_pages.h"

namespace glint {

// Hashes bytes with FNV-1a (Fowler, Noll, Vo), eight bytes per step. Each step also folds the high half of
// the hash into the low half, because the multiplication carries bits only upwards. `seed` continues the hash
// of earlier bytes.
uint64_t content_hash(std::string_view bytes, uint64_t seed = 0xcbf2'9ce4'8422'2325);

// Keeps values in a folder. Any number of processes may use one folder at a time, because a file appears
// whole, by renaming, and any number of threads may use one store. A file that is damaged, or that belongs to
// another key with the same hash, counts as absent and is written again. A value that cannot be written
// causes no error, only more work next time.
class FileStore {
 public:
  struct Options {
    std::string folder;  // made at the first store; empty: nothing is kept
    std::string ending;  // file name extension, such as ".shader"
    std::string build;   // build of the program that makes the values; values of other builds are not found
    // This limits the size of all files of the folder with this ending. Above it, the files that were read
    // longest ago are removed.
    uint64_t max_bytes = 0;
    uint32_t threads = 1;  // threads of the host that check large values side by side
  };
  explicit FileStore(Options options) : options_(std::move(options)) {}

  // Returns the value of a key, if there is one.
  std::optional<std::string> find(const std::string& key);
  void store(const std::string& key, std::string_view value) { store(key, value, std::string_view()); }

  // Is a large value, in pages of its file, which belong to this process.
  struct Large {
    Pages pages;
    std::string_view head;  // in `pages`
    char* rest = nullptr;   // in `pages`, at an address that is a multiple of 4096
    uint64_t bytes = 0;     // of the rest; kRestSlack more can be read behind them
  };
  static constexpr uint64_t kRestSlack = 128;
  // Finds a large value without copying it.
  std::optional<Large> find_large(const std::string& key);
  // Stores a large value. The rest comes in pieces, which follow each other.
  void store(const std::string& key, std::string_view head, std::string_view rest) {
    store(key, head, std::span(&rest, 1));
  }
  void store(const std::string& key, std::string_view head, std::span<const std::string_view> rest);
  std::string file_of(const std::string& key) const;
  uint64_t damaged() const { return damaged_; }  // number of damaged files that find() met

 private:
  struct Found;
  std::optional<Found> open(const std::string& key);
  bool write(const std::string& path, const std::string& key, std::string_view head,
             std::span<const std::string_view> rest) const;
  void sweep(uint64_t written);

  const Options options_;
  std::atomic<uint64_t> damaged_ = 0;
  std::atomic<uint64_t> num_temporaries_ = 0;  // tells the temporary files of threads apart
  std::mutex sweeping_;
  uint64_t written_bytes_ = 0;
  bool swept_ = false;
};

}  // namespace glint
