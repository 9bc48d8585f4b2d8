// Values in files of a folder, found again by the whole of their key: what caches keep beyond a process.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace glint {

// FNV-1a (Fowler, Noll, Vo), 8 bytes a step, with a fold of the high half, which a step of 8 bytes does not
// reach down from. `seed` goes on from earlier bytes.
uint64_t content_hash(std::string_view bytes, uint64_t seed = 0xcbf2'9ce4'8422'2325);

// Any number of processes may use one folder at a time: files appear whole, by renaming. A file that is
// damaged, or belongs to another key of the same hash, counts as not there and is written again. What cannot
// be written is only slower next time: no error. One object is for one thread at a time.
class FileStore {
 public:
  struct Options {
    std::string folder;  // made when first needed; empty: nothing is kept
    std::string ending;  // of the files: ".shader"
    std::string build;   // of the program that makes the values: those of another one are not found
    uint64_t max_bytes =
        0;  // of the folder's files with this ending; beyond it those not read for longest go
  };
  explicit FileStore(Options options) : options_(std::move(options)) {}

  std::optional<std::string> find(const std::string& key);
  void store(const std::string& key, std::string_view value);
  std::string file_of(const std::string& key) const;
  uint64_t damaged() const { return damaged_; }  // files found so by find()

 private:
  void sweep(uint64_t written);

  const Options options_;
  uint64_t written_bytes_ = 0, damaged_ = 0;
  bool swept_ = false;
};

}  // namespace glint
