// Unpacks original scene data that exists beside the project into a folder for one test.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>
#include <unistd.h>
#include <vector>

#include "tests/support/catch.h"

namespace glint::test {

// Holds the archive shared/data/scenes/<name>.tar.zst and those of `others`, unpacked beside each other while
// the object lives. Without one of them `path` is empty, and the test has said that it skips.
struct SceneData {
  std::string path;  // folder that holds <name>/

  explicit SceneData(const std::string& name, const std::vector<std::string>& others = {}) {
    namespace fs = std::filesystem;
    std::vector<fs::path> archives;
    const auto add = [&](const std::string& scene) {
      archives.push_back(fs::path(GLINT_SOURCE_DIR) / ".." / "shared" / "data" / "scenes" /
                         (scene + ".tar.zst"));
    };
    add(name);
    for (const std::string& other : others) add(other);
    for (const fs::path& archive : archives)
      if (!fs::exists(archive)) {
        WARN("SKIPPED: " << archive.filename().string()
                         << " is not there, so nothing is compared with the original data");
        return;
      }
    const fs::path folder = fs::temp_directory_path() / ("glint_" + name + "_" + std::to_string(getpid()));
    fs::create_directories(folder);
    path = folder.string();
    for (const fs::path& archive : archives)
      REQUIRE(std::system(("tar --zstd -xf '" + archive.string() + "' -C '" + path + "'").c_str()) == 0);
  }
  ~SceneData() {
    if (!path.empty()) std::filesystem::remove_all(path);
  }
  SceneData(const SceneData&) = delete;
  SceneData& operator=(const SceneData&) = delete;
};

}  // namespace glint::test
