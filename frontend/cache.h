// Finds earlier results of the compiler by everything they were made from, in memory and in a folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "base/file_store.h"

namespace glint::frontend {

// Any number of threads may use one ShaderCache at a time, and any number of processes may use its folder
// (base/file_store.h).
class ShaderCache {
 public:
  struct Options {
    std::string folder;  // made when first needed; empty: memory only
    std::string build;   // identifies the compiler; entries of another build are not found
    // This is the folder's size limit in bytes. Above it, the files that were read longest ago go.
    uint64_t max_bytes = uint64_t{256} << 20;
  };
  struct Counts {
    uint64_t found = 0, missing = 0, damaged = 0;
  };

  explicit ShaderCache(const Options& options)
      : max_bytes_(options.max_bytes),
        files_({options.folder, ".shader", options.build, options.max_bytes}) {}

  std::optional<std::string> find(const std::string& key);
  void store(const std::string& key, const std::string& value);
  Counts counts() const;
  std::string file_of(const std::string& key) const;

 private:
  void remember(const std::string& key, const std::string& value);

  const uint64_t max_bytes_;
  mutable std::mutex mutex_;
  FileStore files_;
  std::map<std::string, std::string, std::less<>> memory_;
  uint64_t memory_bytes_ = 0;
  Counts counts_;
};

}  // namespace glint::frontend
