// Finds bottom-level structures that were built before, by the geometry they were built of.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>

#include "base/file_store.h"
#include "rtunit/structure/build.h"

namespace glint::pipeline {

// Keeps one file per structure, in a folder that any number of processes may share (base/file_store.h). Small
// structures are built each time, because finding them takes as long. Any number of threads may use the
// cache; of equal structures one is built, and the others wait for it.
class StructureCache {
 public:
  struct Options {
    std::string folder;  // empty: nothing is kept
    std::string build;   // identifies the builder; structures of another one are not found
    uint64_t max_bytes = uint64_t{6} << 30;  // limit of the folder's size; all of LumiBench takes 5 GB
    // Smaller structures are not kept. A structure of this many primitives takes about half a millisecond to
    // build, and a tenth of that to find.
    uint64_t least_primitives = 1024;
  };
  struct Counts {
    uint64_t found = 0, built = 0;
  };
  explicit StructureCache(const Options& options)
      : least_primitives_(options.least_primitives),
        files_({options.folder, ".bvh", options.build, options.max_bytes}) {}

  // Returns the same bytes as rt::encode_bottom.
  rt::EncodedStructure encode(const std::string& name, const rt::BottomLevel& input,
                              const rt::BuildOptions& options, uint32_t threads = 1);
  // Returns the counts. No encode() may be under way.
  const Counts& counts() const { return counts_; }

 private:
  // Holds a key, which no other thread can hold at the same time.
  class Turn {
   public:
    Turn(StructureCache& cache, const std::string& key);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    StructureCache& cache_;
    const std::string& key_;
  };
  void count(uint64_t Counts::*which);

  const uint64_t least_primitives_;
  FileStore files_;
  std::mutex mutex_;  // of the following
  std::condition_variable turn_ended_;
  std::set<std::string> held_;  // keys of structures that are being found or built
  Counts counts_;
};

}  // namespace glint::pipeline
