// source.json: what a profiled run executed, as text: GLSL, SPIR-V and ISA, and which line belongs to which.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/program_listing.h"

namespace glint::report {

struct SourceFile {
  std::string path;
  bool is_known = false;  // whether its text could be read when the run ended
  std::vector<std::string> lines;
};

// All programs of a run. ProgramListing::files of each is empty: ListedLine::file and ListedScope::file
// number `files`.
struct SourceMap {
  std::vector<SourceFile> files;
  std::vector<ProgramListing> programs;
};

// The text of a file; nothing when it cannot be read.
using TextOf = std::function<std::optional<std::string>(const std::string& path)>;

SourceMap source_map(const std::vector<ProgramListing>& programs, const TextOf& text_of);

// The document (docs/profiling.md); the same map gives the same bytes.
std::string source_json(const SourceMap& map);

// What source_json() wrote. `name` stands in messages; UserError when it is something else, or its numbers
// name nothing.
SourceMap parse_source(const std::string& text, const std::string& name);

// Lines without their ends; tabs are four blanks.
std::vector<std::string> lines_of(const std::string& text);

}  // namespace glint::report
