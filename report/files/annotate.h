// A run's programs as GLSL, SPIR-V and ISA, with what each line cost beside it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/profile_table.h"
#include "report/files/source_files.h"
#include "report/metrics/measures.h"

namespace glint::report {

// The files of a profile with a share of its cycles, the costliest first.
struct FileShare {
  std::string file;
  double share = 0;  // of the cycles of all instructions
};
std::vector<FileShare> files_of(const ProfileTable& profile);

// The programs of a profile by number, the costliest first.
std::vector<uint32_t> programs_of(const ProfileTable& profile);

// Text for a terminal: a heading, then each line with its figures. The figures of all files (of all programs:
// of their SPIR-V, of their ISA) add up to the profile's instructions: what has no line stands in a row of
// its own.
class Annotator {
 public:
  // Both have to outlive it. `map` may have no programs; then there is source only.
  Annotator(const ProfileTable& profile, const SourceMap& map, const std::vector<std::string>& measures,
            const Terminal& terminal);

  // Each line of a file; when its text is not known only the lines that have figures.
  std::string file(const SourceFile& file) const;
  // Each SPIR-V instruction of program `number`'s functions, after optimisation.
  std::string spirv(uint32_t number) const;
  // Each instruction of program `number`.
  std::string isa(uint32_t number) const;
  // Each line of file `number` that some instruction belongs to, below it the SPIR-V and below that the ISA,
  // of all programs.
  std::string all(size_t number) const;

 private:
  std::string sheet(const std::string& heading, std::vector<std::string> columns,
                    const std::vector<std::vector<std::string>>& rows, const std::string& alignment) const;
  std::string place(const ListedLine& line) const;
  std::string heading_of(uint32_t program, const std::string& what) const;
  void add_below(std::vector<std::vector<std::string>>& rows, uint32_t program,
                 const std::vector<uint32_t>& instructions) const;

  const ProfileTable& profile_;
  const SourceMap& map_;
  Terminal terminal_;
  Measures measures_;
};

// Where the cycles of all schedulers went, by reason, the largest first: it adds up to 100 %.
std::string reason_table(const ProfileTable& profile, const Terminal& terminal);

}  // namespace glint::report
