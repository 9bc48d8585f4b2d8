// Writes debug information of functions, and writes lines in their older form.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/inline_scopes.h"

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>
#include <span>
#include <spirv/unified1/NonSemanticShaderDebugInfo100.h>
#include <spirv/unified1/spirv.hpp11>
#include <string>
#include <string_view>

#include "frontend/spirv/source_lines.h"
#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

constexpr uint32_t kNonSemanticVersion = 0x10600;  // the first version in which such sets need no extension
constexpr uint32_t kDwarfVersion = 5, kLanguageUnknown = 0;

// Returns the words of a text. They end in a zero byte, as texts in a module do.

// Holds what marking needs to know of a module.
struct Survey {
  struct Function {
    uint32_t id = 0, file = 0, line = 0;  // `file` is the id of an OpString
  };
  std::map<uint32_t, std::string> names;  // from OpName
  std::vector<Function> functions;
  std::set<uint32_t> files, lines;
  uint32_t void_type = 0, u32_type = 0;
  bool has_other_set = false;
};

Survey survey(const Words& words) {
  Survey out;
  for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16) {
    const std::span<const uint32_t> inst(&words[i], words[i] >> 16);
    switch (op_of(inst[0])) {
      case spv::Op::OpExtInstImport:
        out.has_other_set |= text_at(inst.subspan(2)).starts_with("NonSemantic.");
        break;
      case spv::Op::OpName:
        out.names[inst[1]] = text_at(inst.subspan(2));
        break;
      case spv::Op::OpTypeVoid:
        out.void_type = inst[1];
        break;
      case spv::Op::OpTypeInt:
        if (inst[2] == 32 && inst[3] == 0) out.u32_type = inst[1];
        break;
      case spv::Op::OpFunction:
        out.functions.push_back({inst[2], 0, 0});
        break;
      case spv::Op::OpLine:
        if (out.functions.empty()) break;
        out.files.insert(inst[1]);
        out.lines.insert(inst[2]);
        if (out.functions.back().file == 0)
          out.functions.back().file = inst[1], out.functions.back().line = inst[2];
        break;
      default:
        break;
    }
  }
  return out;
}

// Returns a function's name without the parameter types that glslang adds, as in "shade(vf3;f1;".
std::string function_name(const Survey& module, uint32_t id) {
  const auto found = module.names.find(id);
  const std::string name =
      found == module.names.end() ? std::string() : found->second.substr(0, found->second.find('('));
  return name.empty() ? "%" + std::to_string(id) : name;
}

// Builds the instructions that are added in three places of the module, and the marks of the functions.
class Marks {
 public:
  Marks(const Survey& module, uint32_t bound) : module_(module), bound_(bound) {
    set_ = fresh();
    append(imports_, spv::Op::OpExtInstImport, {set_}, words_of(kDebugInfoSet));
    if (module.u32_type == 0)
      append(globals_, spv::Op::OpTypeInt, {u32_ = fresh(), 32, 0});
    else
      u32_ = module.u32_type;
    for (const uint32_t file : module.files)
      source_[file] = debug(globals_, NonSemanticShaderDebugInfo100DebugSource, {file});
    const uint32_t unit = debug(globals_, NonSemanticShaderDebugInfo100DebugCompilationUnit,
                                {number(NonSemanticShaderDebugInfo100Version), number(kDwarfVersion),
                                 source_.begin()->second, number(kLanguageUnknown)});
    const uint32_t type =
        debug(globals_, NonSemanticShaderDebugInfo100DebugTypeFunction, {number(0), module.void_type});
    for (const Survey::Function& function : module.functions) declare(function, unit, type);
    for (const uint32_t line : module.lines) number(line);
  }

  const Words& imports() const { return imports_; }
  const Words& strings() const { return strings_; }
  const Words& globals() const { return globals_; }
  uint32_t bound() const { return bound_; }

  // Returns the instructions that say to which function a block belongs. They are empty for a function
  // without lines.
  Words scope(uint32_t function) {
    Words out;
    if (const auto mark = function_.find(function); mark != function_.end())
      debug(out, NonSemanticShaderDebugInfo100DebugScope, {mark->second});
    return out;
  }
  // Returns the DebugLine that replaces an OpLine. Before an OpLine at the start of a block, the optimiser
  // forgets to write the scope; before a DebugLine it does not.
  Words line(uint32_t file, uint32_t line) {
    Words out;
    debug(out, NonSemanticShaderDebugInfo100DebugLine,
          {source_.at(file), number(line), number(line), number(0), number(0)});
    return out;
  }
  Words no_scope() {
    Words out;
    debug(out, NonSemanticShaderDebugInfo100DebugNoScope, {});
    return out;
  }

 private:
  uint32_t fresh() { return bound_++; }

  uint32_t debug(Words& out, uint32_t kind, std::initializer_list<uint32_t> operands) {
    const uint32_t id = fresh();
    append(out, spv::Op::OpExtInst, {module_.void_type, id, set_, kind}, operands);
    return id;
  }
  // Returns a constant, because numbers are constants when they are operands of this set.
  uint32_t number(uint32_t value) {
    const auto [at, is_new] = numbers_.try_emplace(value, 0);
    if (is_new) append(globals_, spv::Op::OpConstant, {u32_, at->second = fresh(), value});
    return at->second;
  }
  void declare(const Survey::Function& function, uint32_t unit, uint32_t type) {
    if (function.file == 0) return;
    const uint32_t name = fresh();
    append(strings_, spv::Op::OpString, {name}, words_of(function_name(module_, function.id)));
    const uint32_t line = number(function.line), zero = number(0);
    // DebugFunction has the operands: name, type, source, line, column, parent, linkage name, flags, line of
    // the body.
    function_[function.id] =
        debug(globals_, NonSemanticShaderDebugInfo100DebugFunction,
              {name, type, source_.at(function.file), line, zero, unit, name, zero, line});
  }

  const Survey& module_;
  uint32_t bound_;
  uint32_t set_ = 0, u32_ = 0;
  Words imports_, strings_, globals_;
  std::map<uint32_t, uint32_t> source_, numbers_, function_;
};

// Returns true for the sections of a module's logical layout (SPIR-V specification, 2.4) that stand before
// debug information.
bool is_before_strings(spv::Op op) {
  return op == spv::Op::OpCapability || op == spv::Op::OpExtension || op == spv::Op::OpExtInstImport ||
         op == spv::Op::OpMemoryModel || op == spv::Op::OpEntryPoint || op == spv::Op::OpExecutionMode ||
         op == spv::Op::OpExecutionModeId;
}

bool may_stand_first(spv::Op op) {
  return op == spv::Op::OpPhi || op == spv::Op::OpVariable;
}

// Returns true for debug information about the instructions that follow it.
bool is_mark(uint32_t debug_op) {
  return debug_op == NonSemanticShaderDebugInfo100DebugScope ||
         debug_op == NonSemanticShaderDebugInfo100DebugNoScope ||
         debug_op == NonSemanticShaderDebugInfo100DebugLine;
}

}  // namespace

std::optional<Words> with_inline_scopes(const Words& words) {
  const Survey module = survey(words);
  if (words[kVersionWord] < kNonSemanticVersion || module.has_other_set || module.files.empty() ||
      module.void_type == 0)
    return std::nullopt;
  Marks marks(module, words[kBoundWord]);
  Words out(words.begin(), words.begin() + kHeaderWords);
  const auto add = [&](const Words& more) { out.insert(out.end(), more.begin(), more.end()); };
  uint32_t function = 0;
  bool has_strings = false;
  // This is the place in `out` where a block's instructions begin, after phis and variables. It is 0 outside
  // of a block and after the block was marked.
  size_t body = 0;
  for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16) {
    const spv::Op op = op_of(words[i]);
    if (op == spv::Op::OpMemoryModel) add(marks.imports());
    if (!has_strings && !is_before_strings(op)) add(marks.strings()), has_strings = true;
    if (op == spv::Op::OpFunction) {
      if (function == 0) add(marks.globals());
      function = words[i + 2];
    }
    if (body != 0 && !may_stand_first(op) && op != spv::Op::OpLine && op != spv::Op::OpNoLine) {
      const Words scope = marks.scope(function);
      out.insert(out.begin() + long(body), scope.begin(), scope.end());
      body = 0;
    }
    // Labels must have no scope: a scope that the optimiser reads continues across blocks, and it writes none
    // for a block whose label already has it.
    if (op == spv::Op::OpLabel || op == spv::Op::OpFunctionEnd) add(marks.no_scope());
    if (op == spv::Op::OpLine && function != 0)
      add(marks.line(words[i + 1], words[i + 2]));
    else
      out.insert(out.end(), words.begin() + long(i), words.begin() + long(i + (words[i] >> 16)));
    if (op == spv::Op::OpLabel || (body != 0 && may_stand_first(op))) body = out.size();
  }
  out[kBoundWord] = marks.bound();
  return out;
}

Words with_marks_in_place(const Words& words) {
  Words out(words.begin(), words.begin() + kHeaderWords);
  std::set<uint32_t> sets;
  size_t marks = out.size();  // where the marks begin that the last instruction has before it
  for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16) {
    const std::span<const uint32_t> inst(&words[i], words[i] >> 16);
    const spv::Op op = op_of(inst[0]);
    if (op == spv::Op::OpExtInstImport && text_at(inst.subspan(2)) == kDebugInfoSet) sets.insert(inst[1]);
    const bool is_debug = op == spv::Op::OpExtInst && sets.count(inst[3]);
    if (is_debug && inst[4] == NonSemanticShaderDebugInfo100DebugNoLine) continue;
    const size_t at = op == spv::Op::OpVariable ? marks : out.size();
    out.insert(out.begin() + long(at), inst.begin(), inst.end());
    if (op == spv::Op::OpVariable)
      marks += inst.size();
    else if (!is_debug || !is_mark(inst[4]))
      marks = out.size();
  }
  return out;
}

Words with_plain_lines(const Words& words) {
  Words out(words.begin(), words.begin() + kHeaderWords);
  std::set<uint32_t> sets;
  std::map<uint32_t, uint32_t> files, numbers;  // DebugSource: its string; OpConstant: its low word
  for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16) {
    const std::span<const uint32_t> inst(&words[i], words[i] >> 16);
    const spv::Op op = op_of(inst[0]);
    if (op == spv::Op::OpConstant) numbers[inst[2]] = inst[3];
    if (op == spv::Op::OpExtInstImport && text_at(inst.subspan(2)) == kDebugInfoSet) {
      sets.insert(inst[1]);
    } else if (op == spv::Op::OpExtInst && sets.count(inst[3])) {
      if (inst[4] == NonSemanticShaderDebugInfo100DebugSource && inst.size() > 5) files[inst[2]] = inst[5];
      const bool is_line = inst[4] == NonSemanticShaderDebugInfo100DebugLine && inst.size() > 6;
      if (is_line && files.count(inst[5]))
        append(out, spv::Op::OpLine, {files[inst[5]], numbers[inst[6]], 0});
    } else {
      out.insert(out.end(), inst.begin(), inst.end());
    }
  }
  return out;
}

}  // namespace glint::frontend
