// Where the instructions of a SPIR-V module come from: lines of OpLine and DebugLine, calls of DebugScope,
// numbers of a listing. SPDX-License-Identifier: Apache-2.0
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

// Debug information of version 100: SPIR-V NonSemantic.Shader.DebugInfo, an extended instruction set.
inline constexpr const char* kDebugInfoSet = "NonSemantic.Shader.DebugInfo.100";

// Reads a module's instructions in order. Those that say where others come from, or what they are called, are
// debug instructions: a listing leaves them out, and all others are numbered from 1.
class SourceLines {
 public:
  // True when the instruction is of debug information alone and nothing else needs to look at it. Words that
  // are too few for what the instruction should hold are passed over.
  bool read(std::span<const uint32_t> words);

  // Of the instruction read last.
  const isa::Line& line() const { return line_; }

  // What isa::Line::file, ::spirv and ::scope number; the last is without names of the calls' files that no
  // line has.
  std::vector<std::string> files;
  std::vector<isa::Line> lines;  // one a listed instruction
  std::vector<isa::Scope> scopes;

 private:
  struct Function {
    std::string name;
    uint32_t source = 0;
  };
  struct InlinedAt {
    uint32_t line = 0, scope = 0, inlined = 0;  // a number; ids
  };
  bool read_debug(std::span<const uint32_t> words);
  void declare(uint32_t result, uint32_t kind, std::span<const uint32_t> operands);
  void place(const std::string& file, uint32_t line);
  uint16_t file_index(const std::string& file);
  uint32_t number(uint32_t id) const;
  uint32_t scope_of(uint32_t id, uint32_t inlined, int depth);

  isa::Line line_;
  std::set<uint32_t> sets_;                  // imports of kDebugInfoSet
  std::map<uint32_t, std::string> strings_;  // OpString
  std::map<uint32_t, uint32_t> numbers_;     // OpConstant, its low word
  std::map<uint32_t, uint32_t> sources_;     // DebugSource: its file's string
  std::map<uint32_t, uint32_t> parents_;     // DebugLexicalBlock: what it lies in
  std::map<uint32_t, Function> functions_;   // DebugFunction
  std::map<uint32_t, InlinedAt> inlined_;    // DebugInlinedAt
  std::map<std::string, uint16_t> file_index_;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> known_scopes_;  // by ids of a scope and an inlining
};

// The text of each instruction that SourceLines numbers, in order, with friendly names.
std::vector<std::string> listing_of(const std::vector<uint32_t>& words);

}  // namespace glint::frontend
