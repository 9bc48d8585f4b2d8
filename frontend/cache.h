// What compiling has made before, found again by the whole of what it was made from: in memory and in a folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace glint::frontend {

// Any number of threads and processes may use one folder at a time: files appear whole, by renaming. A file that is
// damaged, or belongs to another key of the same hash, counts as not there and is written again. What cannot be
// written is only slower next time: no error.
class ShaderCache {
 public:
  struct Options {
    std::string folder;                      // made when first needed; empty: memory only
    std::string build;                       // of the compiler: entries of another one are not found
    uint64_t max_bytes = uint64_t{256} << 20;  // of the folder; beyond it the files not read for longest go
  };
  struct Counts {
    uint64_t found = 0, missing = 0, damaged = 0;
  };

  explicit ShaderCache(Options options) : options_(std::move(options)) {}

  std::optional<std::string> find(const std::string& key);
  void store(const std::string& key, const std::string& value);
  Counts counts() const;
  std::string file_of(const std::string& key) const;

 private:
  std::optional<std::string> read(const std::string& key);
  void write(const std::string& key, const std::string& value) const;

  const Options options_;
  mutable std::mutex mutex_;
  std::map<std::string, std::string, std::less<>> memory_;
  uint64_t memory_bytes_ = 0, written_bytes_ = 0;
  bool swept_ = false;
  Counts counts_;
};

uint64_t content_hash(std::string_view bytes);

}  // namespace glint::frontend
