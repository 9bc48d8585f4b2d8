// Finds and reads the files that a GLSL shader includes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glslang/Public/ShaderLang.h>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/lookup.h"
#include "isa/program.h"

namespace glint::frontend {

// Looks for the file of `#include "..."` in the folder of the including file, then in the folders of the
// files that led to it, the nearest first, and then in the include directories in order. `#include <...>`
// looks only in the include directories. Chains of includes that do not end are refused.
class Includer final : public glslang::TShader::Includer {
 public:
  Includer(const std::vector<std::string>& dirs, isa::Stage stage, const std::string& path)
      : dirs_(dirs), stage_(stage), chain_{path} {}

  IncludeResult* includeLocal(const char* header, const char* includer, size_t depth) override;
  IncludeResult* includeSystem(const char* header, const char* includer, size_t depth) override;
  void releaseInclude(IncludeResult* result) override { delete result; }

  const std::vector<Lookup>& lookups() const { return lookups_; }
  // Returns why an include failed, as it stands in glslang's messages. It is empty when none failed.
  const std::string& failure() const { return failure_; }
  // Returns the first chain of files in which one leads to itself. It is empty when there is none.
  const std::string& cycle() const { return cycle_; }

 private:
  IncludeResult* load(const std::filesystem::path& path);
  IncludeResult* give(const std::string& name, const std::string& text);
  IncludeResult* look_in(const std::string& directory, const char* header);
  // Notes the files that lead to the present header. Returns whether the header may be looked for.
  bool enter(size_t depth);
  IncludeResult* say_failure();
  std::string chain_in_words() const;

  const std::vector<std::string>& dirs_;
  const isa::Stage stage_;
  std::vector<std::string> chain_;  // the shader, and the files that include each other down to the present
  std::vector<std::string> searched_;         // directories searched for the present header
  std::map<std::string, std::string> texts_;  // by path; glslang names them in messages after their release
  std::vector<Lookup> lookups_;
  std::string failure_, cycle_;
  bool has_said_failure_ = false;
  size_t repeats_ = 0, repeated_bytes_ = 0;  // of files that were included before
};

}  // namespace glint::frontend
