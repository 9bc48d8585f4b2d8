// A shader as the compiler left it, for people: ISA, the SPIR-V it was lowered from, and which line belongs
// to which. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// A line of ISA or SPIR-V and where it comes from.
struct ListedLine {
  std::string text;
  uint16_t file = 0;   // of ProgramListing::files
  uint32_t line = 0;   // in it, from 1; 0: unknown
  uint32_t spirv = 0;  // of ISA: row of ProgramListing::spirv, from 1; 0: unknown
  uint32_t scope = 0;  // of ISA: row of ProgramListing::scopes, from 1; 0: unknown
};

// A function's body as it was inlined: one for each chain of calls that leads to it.
struct ListedScope {
  std::string function;
  uint32_t caller = 0;  // row of ProgramListing::scopes, from 1; 0: none
  uint16_t file = 0;    // of the call
  uint32_t line = 0;
};

struct ProgramListing {
  std::string shader, stage;
  std::vector<std::string> files;  // paths, as the compiler was given them
  std::vector<ListedLine> isa;     // one an instruction
  std::vector<ListedLine> spirv;   // one an instruction, after optimisation; empty when unknown
  std::vector<ListedScope> scopes;
};

}  // namespace glint
