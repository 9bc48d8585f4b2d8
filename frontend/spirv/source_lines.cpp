// Reads debug information, and writes the listing to which its line numbers refer.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/source_lines.h"

#include <algorithm>
#include <spirv-tools/libspirv.hpp>
#include <spirv/unified1/NonSemanticShaderDebugInfo100.h>
#include <spirv/unified1/spirv.hpp11>
#include <sstream>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

// This limits the depth of scopes. A module beyond it has scopes that contain themselves.
constexpr int kMaxDepth = 1000;

// Returns true for names, lines and sources, which do not take part in the computation.
bool is_about_source(spv::Op op) {
  switch (op) {
    case spv::Op::OpLine:
    case spv::Op::OpNoLine:
    case spv::Op::OpName:
    case spv::Op::OpMemberName:
    case spv::Op::OpSource:
    case spv::Op::OpSourceContinued:
    case spv::Op::OpSourceExtension:
    case spv::Op::OpModuleProcessed:
    case spv::Op::OpString:
      return true;
    default:
      return false;
  }
}

bool is_debug_set(std::span<const uint32_t> words) {
  return op_of(words[0]) == spv::Op::OpExtInstImport && words.size() > 2 &&
         text_at(words.subspan(2)) == kDebugInfoSet;
}

bool is_of_set(std::span<const uint32_t> words, const std::set<uint32_t>& sets) {
  return op_of(words[0]) == spv::Op::OpExtInst && words.size() > 4 && sets.count(words[3]) != 0;
}

}  // namespace

bool SourceLines::read(std::span<const uint32_t> words) {
  const spv::Op op = op_of(words[0]);
  if (op == spv::Op::OpLine && words.size() > 2) place(strings_[words[1]], words[2]);
  if (op == spv::Op::OpString && words.size() > 2) strings_[words[1]] = text_at(words.subspan(2));
  if (op == spv::Op::OpConstant && words.size() > 3) numbers_[words[2]] = words[3];
  // Choice: like a line, a scope holds until the next one, because the optimiser leaves out some scopes of
  // terminators and new blocks.
  if (op == spv::Op::OpFunction) line_.scope = 0;
  line_.spirv = 0;
  if (is_debug_set(words))
    sets_.insert(words[1]);
  else if (is_of_set(words, sets_))
    return read_debug(words);
  else if (!is_about_source(op)) {
    line_.spirv = uint32_t(lines.size()) + 1;
    lines.push_back(line_);
  }
  return op == spv::Op::OpLine;
}

// OpExtInst has the words: result type, result, set, number of the instruction, operands.
bool SourceLines::read_debug(std::span<const uint32_t> words) {
  const uint32_t kind = words[4];
  const std::span<const uint32_t> operands = words.subspan(5);
  if (kind == NonSemanticShaderDebugInfo100DebugScope && !operands.empty())
    line_.scope = scope_of(operands[0], operands.size() > 1 ? operands[1] : 0, 0);
  else if (kind == NonSemanticShaderDebugInfo100DebugLine && operands.size() > 1)
    place(strings_[sources_[operands[0]]], number(operands[1]));
  else
    declare(words[2], kind, operands);
  return true;
}

void SourceLines::declare(uint32_t result, uint32_t kind, std::span<const uint32_t> operands) {
  if (kind == NonSemanticShaderDebugInfo100DebugSource && !operands.empty()) sources_[result] = operands[0];
  // DebugFunction has the operands name, type, source, ...; DebugLexicalBlock has source, line, column,
  // parent; DebugInlinedAt has line, scope and, within another inlining, that inlining.
  if (kind == NonSemanticShaderDebugInfo100DebugFunction && operands.size() > 2)
    functions_[result] = {strings_[operands[0]], operands[2]};
  if (kind == NonSemanticShaderDebugInfo100DebugLexicalBlock && operands.size() > 3)
    parents_[result] = operands[3];
  if (kind == NonSemanticShaderDebugInfo100DebugInlinedAt && operands.size() > 1)
    inlined_[result] = {number(operands[0]), operands[1], operands.size() > 2 ? operands[2] : 0};
}

// A line holds until the next one, also in following blocks, because glslang writes a line only when it
// changes.
void SourceLines::place(const std::string& file, uint32_t line) {
  line_.file = file_index(file);
  line_.line = line;
}

uint16_t SourceLines::file_index(const std::string& file) {
  const auto [at, is_new] = file_index_.try_emplace(file, uint16_t(files.size()));
  if (is_new) files.push_back(file);
  return at->second;
}

uint32_t SourceLines::number(uint32_t id) const {
  const auto found = numbers_.find(id);
  return found == numbers_.end() ? 0 : found->second;
}

// Returns the row of the function around the scope `id`, inlined by `inlined`, or 0 when the module does not
// say.
uint32_t SourceLines::scope_of(uint32_t id, uint32_t inlined, int depth) {
  if (depth > kMaxDepth) return 0;
  for (auto up = parents_.find(id); up != parents_.end() && depth < kMaxDepth;
       up = parents_.find(id), ++depth)
    id = up->second;
  const auto function = functions_.find(id);
  if (function == functions_.end()) return 0;
  if (const auto known = known_scopes_.find({id, inlined}); known != known_scopes_.end())
    return known->second;
  isa::Scope row{function->second.name, 0, {}};
  if (const auto call = inlined_.find(inlined); call != inlined_.end()) {
    row.caller = scope_of(call->second.scope, call->second.inlined, depth + 1);
    if (row.caller == 0) return 0;
    uint32_t caller = call->second.scope;
    for (auto up = parents_.find(caller); up != parents_.end() && depth < kMaxDepth;
         up = parents_.find(caller), ++depth)
      caller = up->second;
    row.call.file = file_index(strings_[sources_[functions_[caller].source]]);
    row.call.line = call->second.line;
  }
  scopes.push_back(std::move(row));
  return known_scopes_[{id, inlined}] = uint32_t(scopes.size());
}

namespace {

// Returns the module in a form whose disassembly has one line per instruction: its texts have no line ends,
// and sources are left out.
std::vector<uint32_t> with_plain_texts(const std::vector<uint32_t>& words) {
  std::vector<uint32_t> out(words.begin(), words.begin() + kHeaderWords);
  for (size_t i = kHeaderWords; i < words.size(); i += std::max(1u, words[i] >> 16)) {
    const spv::Op op = op_of(words[i]);
    const size_t length = words[i] >> 16, first = out.size();
    if (op == spv::Op::OpSource || op == spv::Op::OpSourceContinued) continue;
    out.insert(out.end(), words.begin() + long(i), words.begin() + long(i + length));
    const size_t text = op == spv::Op::OpString || op == spv::Op::OpName ? 2
                        : op == spv::Op::OpMemberName                    ? 3
                                                                         : length;
    for (size_t w = first + text; w < out.size(); ++w)
      for (int shift = 0; shift < 32; shift += 8)
        if ((out[w] >> shift & 0xff) == '\n') out[w] ^= uint32_t('\n' ^ ' ') << shift;
  }
  return out;
}

}  // namespace

std::vector<std::string> listing_of(const std::vector<uint32_t>& words) {
  const std::vector<uint32_t> plain = with_plain_texts(words);
  std::string text;
  const spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  if (!tools.Disassemble(plain, &text,
                         SPV_BINARY_TO_TEXT_OPTION_NO_HEADER | SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES))
    return {};
  std::istringstream in(text);
  std::vector<std::string> out;
  std::set<uint32_t> sets;
  std::string line;
  for (size_t i = kHeaderWords; i < plain.size() && std::getline(in, line); i += plain[i] >> 16) {
    const std::span<const uint32_t> instruction(&plain[i], plain[i] >> 16);
    if (is_debug_set(instruction))
      sets.insert(instruction[1]);
    else if (!is_of_set(instruction, sets) && !is_about_source(op_of(instruction[0])))
      out.push_back(line);
  }
  return out;
}

}  // namespace glint::frontend
