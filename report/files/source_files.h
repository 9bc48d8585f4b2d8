// Writes source.json, which holds what a profiled run executed as GLSL, SPIR-V and ISA, and how these belong
// together.
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
  bool is_known = false;  // true when its text could be read at the end of the run
  std::vector<std::string> lines;
};

// Holds all programs of a run. ProgramListing::files of each is empty, and the numbers ListedLine::file and
// ListedScope::file refer to `files`.
struct SourceMap {
  std::vector<SourceFile> files;
  std::vector<ProgramListing> programs;
};

// Returns the text of a file, or nothing when it cannot be read.
using TextOf = std::function<std::optional<std::string>(const std::string& path)>;

SourceMap source_map(const std::vector<ProgramListing>& programs, const TextOf& text_of);

// Returns the document (docs/profiling.md). The same map gives the same bytes.
std::string source_json(const SourceMap& map);

// Reads what source_json() wrote. `name` is used in messages. Throws UserError when the text is something
// else, or when its numbers name nothing.
SourceMap parse_source(const std::string& text, const std::string& name);

// Returns the lines of a text without their ends. Tabs become four blanks.
std::vector<std::string> lines_of(const std::string& text);

}  // namespace glint::report
