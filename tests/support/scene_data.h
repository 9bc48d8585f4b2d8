// Original scene data, where it stands beside the project: unpacked into a folder of its own for one test.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/catch.h"

namespace glint::test {

// The archive shared/data/scenes/<name>.tar.zst, unpacked while the object lives. Without it `path` is empty, and the
// test has said that it skips.
struct SceneData {
  std::string path;  // of the folder that holds <name>/

  explicit SceneData(const std::string& name) {
    namespace fs = std::filesystem;
    const fs::path archive = fs::path(GLINT_SOURCE_DIR) / ".." / "shared" / "data" / "scenes" / (name + ".tar.zst");
    if (!fs::exists(archive)) {
      WARN("SKIPPED: " << name << ".tar.zst is not there, so nothing is compared with the original data");
      return;
    }
    const fs::path folder = fs::temp_directory_path() / ("glint_" + name + "_" + std::to_string(getpid()));
    fs::create_directories(folder);
    path = folder.string();
    REQUIRE(std::system(("tar --zstd -xf '" + archive.string() + "' -C '" + path + "'").c_str()) == 0);
  }
  ~SceneData() {
    if (!path.empty()) std::filesystem::remove_all(path);
  }
  SceneData(const SceneData&) = delete;
  SceneData& operator=(const SceneData&) = delete;
};

}  // namespace glint::test
