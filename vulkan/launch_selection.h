// Chooses launches of an application: by number, label, shader, or the first ones of each pipeline.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace glint::vulkan {

// Says what a selection may ask of a launch.
struct LaunchFacts {
  uint64_t number = 0;              // of the launch, counted from 0 on the device
  uint64_t of_pipeline = 0;         // how often its pipeline was launched before
  std::string shader;               // its name
  std::vector<std::string> labels;  // of debug utils that are open
};

class LaunchSelection {
 public:
  // Reads choices that ';' separates: "all", "none", "dispatch 0,7-9", "first 2" (of each pipeline),
  // "label:NAME", "shader:NAME". An empty text is "none". Throws UserError that says what is wrong.
  static LaunchSelection parse(const std::string& text);

  bool takes(const LaunchFacts& launch) const;
  bool is_empty() const {
    return !all_ && first_ == 0 && numbers_.empty() && labels_.empty() && shaders_.empty();
  }

 private:
  void add(const std::string& choice);
  void add_numbers(const std::string& list);

  bool all_ = false;
  uint64_t first_ = 0;
  std::vector<std::pair<uint64_t, uint64_t>> numbers_;  // from, to
  std::vector<std::string> labels_, shaders_;
};

}  // namespace glint::vulkan
