// Lists a compiled shader for people: its ISA, the SPIR-V it was lowered from, and which line of one belongs
// to which line of the other.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// Holds a line of ISA or SPIR-V and the source line it comes from.
struct ListedLine {
  std::string text;
  uint16_t file = 0;   // index into ProgramListing::files
  uint32_t line = 0;   // line of that file, from 1; 0: unknown
  uint32_t spirv = 0;  // for ISA: row of ProgramListing::spirv, from 1; 0: unknown
  uint32_t scope = 0;  // for ISA: row of ProgramListing::scopes, from 1; 0: unknown
};

// Names an inlined function body. Each chain of calls that leads to the function has its own scope.
struct ListedScope {
  std::string function;
  uint32_t caller = 0;  // row of ProgramListing::scopes, from 1; 0: none
  uint16_t file = 0;    // file and line of the call
  uint32_t line = 0;
};

struct ProgramListing {
  std::string shader, stage;
  std::vector<std::string> files;  // paths, as the compiler was given them
  std::vector<ListedLine> isa;     // one line per instruction
  std::vector<ListedLine> spirv;   // one line per instruction, after optimisation; empty when unknown
  std::vector<ListedScope> scopes;
};

}  // namespace glint
