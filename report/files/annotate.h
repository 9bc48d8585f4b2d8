// Prints a run's programs as GLSL, SPIR-V and ISA, with what each line cost beside it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/profile_table.h"
#include "report/files/source_files.h"
#include "report/metrics/measures.h"

namespace glint::report {

// Names a file of a profile with its share of the cycles. Lists of these have the costliest file first.
struct FileShare {
  std::string file;
  double share = 0;  // fraction of the cycles of all instructions
};
std::vector<FileShare> files_of(const ProfileTable& profile);

// Returns the programs of a profile by number, the costliest first.
std::vector<uint32_t> programs_of(const ProfileTable& profile);

// Makes text for a terminal: a heading, then each line with its figures. The figures of all files, of the
// SPIR-V of all programs, and of their ISA each add up to the profile's instructions, because what has no
// line has a row of its own.
class Annotator {
 public:
  // Both arguments have to outlive it. `map` may have no programs; then only source can be printed.
  Annotator(const ProfileTable& profile, const SourceMap& map, const std::vector<std::string>& measures,
            const Terminal& terminal);

  // Returns each line of a file or, when its text is not known, the lines that have figures.
  std::string file(const SourceFile& file) const;
  // Returns each SPIR-V instruction of program `number`'s functions, after optimisation.
  std::string spirv(uint32_t number) const;
  // Returns each instruction of program `number`.
  std::string isa(uint32_t number) const;
  // Returns each line of file `number` that has instructions; below it the SPIR-V and the ISA, of all
  // programs.
  std::string all(size_t number) const;

  using IsWanted = std::function<bool(const std::string& path)>;
  using IsWantedProgram = std::function<bool(uint32_t program)>;
  // Returns the `count` lines that cost most, of all wanted files, the costliest first. `with_parts` puts the
  // SPIR-V and the ISA below each, as all() does.
  std::string top_lines(size_t count, const IsWanted& is_wanted, bool with_parts) const;
  // Returns the `count` instructions of the wanted programs that cost most, in SPIR-V or in ISA.
  std::string top_instructions(size_t count, const IsWantedProgram& is_wanted, bool in_spirv) const;

 private:
  // Maps the lines of a file to programs, and these to their instructions.
  using Parts = std::map<uint32_t, std::map<uint32_t, std::vector<uint32_t>>>;

  Parts parts_of(size_t file) const;
  std::string sheet(const std::string& heading, std::vector<std::string> columns,
                    const std::vector<std::vector<std::string>>& rows, const std::string& alignment) const;
  std::string place(const ListedLine& line) const;
  std::string heading_of(uint32_t program, const std::string& what) const;
  void add_below(std::vector<std::vector<std::string>>& rows, uint32_t program,
                 const std::vector<uint32_t>& instructions) const;
  void add_programs(std::vector<std::vector<std::string>>& rows,
                    const std::map<uint32_t, std::vector<uint32_t>>& programs) const;
  std::string top_heading(const std::vector<ProfileRow>& top, size_t of, const std::string& what) const;

  const ProfileTable& profile_;
  const SourceMap& map_;
  Terminal terminal_;
  Measures measures_;
};

// Returns where the cycles of all schedulers went, by reason, the largest first. The rows add up to 100 %.
std::string reason_table(const ProfileTable& profile, const Terminal& terminal);

}  // namespace glint::report
