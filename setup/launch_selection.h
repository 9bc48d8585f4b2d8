// Chooses launches of an application: by number, frame, label, shader, or the first ones of each pipeline.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint::setup {

// Says what a selection may ask of a launch.
struct LaunchFacts {
  std::string kind;                 // "dispatch" or "trace"
  uint64_t number = 0;              // of the launch, counted from 0 on the device over all kinds
  uint64_t frame = 0;               // how many frames were presented before
  uint64_t of_pipeline = 0;         // how often its pipeline was launched before
  std::string shader;               // its name
  std::vector<std::string> labels;  // of debug utils that are open
};

// Is a list of numbers as a user writes it: "0,7-9".
class NumberList {
 public:
  // Throws UserError that begins with the variable's name and says what is wrong.
  static NumberList parse(const std::string& text, const std::string& variable);
  bool has(uint64_t number) const;

 private:
  struct Range {
    uint64_t from, to;
  };
  std::vector<Range> ranges_;
};

class LaunchSelection {
 public:
  // Reads choices that ';' separates: "all", "none", "launch 0,7-9" (of any kind), "dispatch 0,7-9", "trace
  // 3", "frame 2", "first 2" (of each pipeline), "label:NAME", "shader:NAME". An empty text is "none". Throws
  // UserError that begins with the variable's name and says what is wrong.
  static LaunchSelection parse(const std::string& text, const std::string& variable);

  bool takes(const LaunchFacts& launch) const;
  bool is_empty() const {
    return !all_ && first_ == 0 && numbers_.empty() && labels_.empty() && shaders_.empty();
  }

 private:
  void add(const std::string& choice, const std::string& variable);

  bool all_ = false;
  uint64_t first_ = 0;
  struct Numbers {
    std::string kind;  // "launch" for any; "frame" when frames are meant
    NumberList list;
  };
  std::vector<Numbers> numbers_;
  std::vector<std::string> labels_, shaders_;
};

}  // namespace glint::setup
