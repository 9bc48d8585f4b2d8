// Chooses launches of an application: by number, label, shader, or the first ones of each pipeline.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::vulkan {

// Says what a selection may ask of a launch.
struct LaunchFacts {
  std::string kind;                 // "dispatch" or "trace"
  uint64_t number = 0;              // of the launch, counted from 0 on the device over all kinds
  uint64_t of_pipeline = 0;         // how often its pipeline was launched before
  std::string shader;               // its name
  std::vector<std::string> labels;  // of debug utils that are open
};

class LaunchSelection {
 public:
  // Reads choices that ';' separates: "all", "none", "launch 0,7-9" (of any kind), "dispatch 0,7-9", "trace
  // 3", "first 2" (of each pipeline), "label:NAME", "shader:NAME". An empty text is "none". Throws UserError
  // that says what is wrong.
  static LaunchSelection parse(const std::string& text);

  bool takes(const LaunchFacts& launch) const;
  bool is_empty() const {
    return !all_ && first_ == 0 && numbers_.empty() && labels_.empty() && shaders_.empty();
  }

 private:
  void add(const std::string& choice);
  void add_numbers(const std::string& kind, const std::string& list);

  bool all_ = false;
  uint64_t first_ = 0;
  struct Range {
    std::string kind;  // "launch" for any
    uint64_t from, to;
  };
  std::vector<Range> numbers_;
  std::vector<std::string> labels_, shaders_;
};

}  // namespace glint::vulkan
