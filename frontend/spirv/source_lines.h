// Tells where the instructions of a SPIR-V module come from: lines of OpLine and DebugLine, calls of
// DebugScope, and line numbers of a listing.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "isa/program.h"

namespace glint::frontend {

// Names the supported debug information: the extended instruction set SPIR-V NonSemantic.Shader.DebugInfo,
// version 100.
inline constexpr const char* kDebugInfoSet = "NonSemantic.Shader.DebugInfo.100";

// Reads a module's instructions in order. Debug instructions say where other instructions come from or what
// they are called. A listing leaves them out and numbers all others from 1.
class SourceLines {
 public:
  // Returns true when the instruction is debug information only and nothing else needs to look at it. An
  // instruction with too few words is skipped.
  bool read(std::span<const uint32_t> words);

  // Returns the line of the instruction that was read last.
  const isa::Line& line() const { return line_; }

  // The numbers isa::Line::file, ::spirv and ::scope refer to these lists. In `scopes`, a call's file has no
  // name when no line is in that file.
  std::vector<std::string> files;
  std::vector<isa::Line> lines;  // one for each listed instruction
  std::vector<isa::Scope> scopes;

 private:
  struct Function {
    std::string name;
    uint32_t source = 0;
  };
  struct InlinedAt {
    uint32_t line = 0, scope = 0, inlined = 0;  // `line` is a number, the others are ids
  };
  bool read_debug(std::span<const uint32_t> words);
  void declare(uint32_t result, uint32_t kind, std::span<const uint32_t> operands);
  void place(const std::string& file, uint32_t line);
  uint16_t file_index(const std::string& file);
  uint32_t number(uint32_t id) const;
  uint32_t scope_of(uint32_t id, uint32_t inlined, int depth);

  isa::Line line_;
  std::set<uint32_t> sets_;                  // imports of kDebugInfoSet
  std::map<uint32_t, std::string> strings_;  // from OpString
  std::map<uint32_t, uint32_t> numbers_;     // from OpConstant: its low word
  std::map<uint32_t, uint32_t> sources_;     // from DebugSource: the string of its file
  std::map<uint32_t, uint32_t> parents_;     // from DebugLexicalBlock: the scope around it
  std::map<uint32_t, Function> functions_;   // from DebugFunction
  std::map<uint32_t, InlinedAt> inlined_;    // from DebugInlinedAt
  std::map<std::string, uint16_t> file_index_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> known_scopes_;  // by ids of a scope and an inlining
};

// Returns the text of each instruction that SourceLines numbers, in order, with friendly names.
std::vector<std::string> listing_of(const std::vector<uint32_t>& words);

}  // namespace glint::frontend
