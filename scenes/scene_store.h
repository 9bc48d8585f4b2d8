// Keeps scenes in files, so that a later run neither makes nor reads them again.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/file_store.h"
#include "base/lookup.h"
#include "scenes/scene.h"

namespace glint::scenes {

// Keeps one file a scene, in a folder that any number of processes may share (base/file_store.h). Vertices,
// indices and texels lie in it as simulated memory has them, so that a renderer takes its pages over and
// copies nothing.
class SceneStore {
 public:
  struct Options {
    std::string folder;                      // empty: nothing is kept
    std::string build;                       // identifies the program; scenes of another build are not found
    uint64_t max_bytes = uint64_t{4} << 30;  // limit of the folder's size; all of LumiBench takes 2.5 GB
    uint32_t threads = 1;                    // threads of the host that check and hash
    // Smaller scenes are not kept, because making them takes no longer than finding them. Bytes of vertices,
    // indices and texels.
    uint64_t least_bytes = uint64_t{1} << 20;
  };
  explicit SceneStore(const Options& options);

  // Returns the scene of this key, unless a file that it was made of has changed. When there is none, it is
  // loaded, and kept for the next time. `load` tells the log where it looks for files.
  Scene find_or_load(const std::string& key, const std::function<Scene(LookupLog*)>& load);

 private:
  std::optional<Scene> find(const std::string& key);
  void store(const std::string& key, const std::vector<Lookup>& lookups, const Scene& scene);

  const uint64_t least_bytes_;
  const uint32_t threads_;
  FileStore files_;
};

}  // namespace glint::scenes
