// Marks loops by prints that never run.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/kept_loops.h"

#include <map>
#include <optional>
#include <set>
#include <span>
#include <spirv/unified1/spirv.hpp11>
#include <string_view>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

using LoopWords = std::span<const uint32_t>;

constexpr std::string_view kSet = "OpenCL.std", kMark = "glint: a loop that nothing leads out of";
constexpr uint32_t kPrint = 184;  // OpenCL extended instruction set: printf

template <class Visit>
void visit_words(const Words& words, const Visit& visit) {
  for (size_t at = kHeaderWords; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16)
    visit(op_of(words[at]), LoopWords(words).subspan(at, words[at] >> 16));
}

struct LoopBlock {
  std::vector<uint32_t> next;  // labels
  bool is_header = false, may_end = false;
};

// Holds what marking has to know of a module.
struct LoopSurvey {
  std::map<uint32_t, LoopBlock> blocks;  // by label
  std::set<uint32_t> always, never;      // ids of the constants true and false
  std::optional<uint32_t> set, void_type;
  bool calls_may_end = false;
};

bool ends_invocation(spv::Op op) {
  using enum spv::Op;
  return op == OpKill || op == OpTerminateInvocation || op == OpIgnoreIntersectionKHR ||
         op == OpTerminateRayKHR || op == OpIgnoreIntersectionNV || op == OpTerminateRayNV ||
         op == OpEmitMeshTasksEXT;
}

void take_terminator(spv::Op op, LoopWords w, LoopSurvey& survey, LoopBlock& block) {
  using enum spv::Op;
  if (op == OpBranch) {
    block.next.push_back(w[1]);
  } else if (op == OpBranchConditional) {
    if (!survey.never.contains(w[1])) block.next.push_back(w[2]);
    if (!survey.always.contains(w[1])) block.next.push_back(w[3]);
  } else if (op == OpSwitch) {
    // Literals may stand among the labels. A literal that is a label by chance only adds a way out.
    for (const uint32_t word : w.subspan(2)) block.next.push_back(word);
  } else {
    block.may_end |= op == OpReturn || op == OpReturnValue || op == OpUnreachable || ends_invocation(op);
  }
}

LoopSurvey survey_of(const Words& words) {
  using enum spv::Op;
  LoopSurvey out;
  visit_words(words, [&](spv::Op op, LoopWords) { out.calls_may_end |= ends_invocation(op); });
  LoopBlock* block = nullptr;
  visit_words(words, [&](spv::Op op, LoopWords w) {
    if (op == OpExtInstImport && text_at(w.subspan(2)) == kSet) out.set = w[1];
    if (op == OpTypeVoid) out.void_type = w[1];
    if (op == OpConstantTrue) out.always.insert(w[2]);
    if (op == OpConstantFalse) out.never.insert(w[2]);
    if (op == OpLabel) block = &out.blocks[w[1]];
    if (!block) return;
    block->is_header |= op == OpLoopMerge;
    block->may_end |= op == OpFunctionCall && out.calls_may_end;
    take_terminator(op, w, out, *block);
  });
  return out;
}

// Returns the labels of the blocks from which some path comes to an end.
std::set<uint32_t> ending_blocks(const LoopSurvey& survey) {
  std::map<uint32_t, std::vector<uint32_t>> before;
  std::set<uint32_t> out;
  std::vector<uint32_t> pending;
  for (const auto& [label, block] : survey.blocks) {
    for (const uint32_t next : block.next) before[next].push_back(label);
    if (block.may_end && out.insert(label).second) pending.push_back(label);
  }
  while (!pending.empty()) {
    const uint32_t label = pending.back();
    pending.pop_back();
    for (const uint32_t from : before[label])
      if (out.insert(from).second) pending.push_back(from);
  }
  return out;
}

bool comes_before_strings(spv::Op op) {
  using enum spv::Op;
  return op == OpCapability || op == OpExtension || op == OpExtInstImport || op == OpMemoryModel ||
         op == OpEntryPoint || op == OpExecutionMode || op == OpExecutionModeId;
}

}  // namespace

std::vector<uint32_t> with_kept_loops(const std::vector<uint32_t>& words) {
  const LoopSurvey survey = survey_of(words);
  const std::set<uint32_t> ending = ending_blocks(survey);
  std::set<uint32_t> endless;
  for (const auto& [label, block] : survey.blocks)
    if (block.is_header && !ending.contains(label)) endless.insert(label);
  if (endless.empty() || !survey.void_type) return words;
  Words out(words.begin(), words.begin() + kHeaderWords);
  const uint32_t set = survey.set ? *survey.set : out[kBoundWord]++, text = out[kBoundWord]++;
  bool has_text = false;
  uint32_t label = 0;
  visit_words(words, [&](spv::Op op, LoopWords w) {
    if (op == spv::Op::OpMemoryModel && !survey.set)
      append(out, spv::Op::OpExtInstImport, {set}, words_of(kSet));
    if (!has_text && !comes_before_strings(op)) {
      append(out, spv::Op::OpString, {text}, words_of(kMark));
      has_text = true;
    }
    if (op == spv::Op::OpLabel) label = w[1];
    if (op == spv::Op::OpLoopMerge && endless.contains(label))
      append(out, spv::Op::OpExtInst, {*survey.void_type, out[kBoundWord]++, set, kPrint, text});
    out.insert(out.end(), w.begin(), w.end());
  });
  return out;
}

std::vector<uint32_t> without_marks(const std::vector<uint32_t>& words) {
  std::set<uint32_t> texts, sets, used;
  const auto is_mark = [&](spv::Op op, LoopWords w) {
    return op == spv::Op::OpExtInst && w.size() > 5 && w[4] == kPrint && texts.contains(w[5]);
  };
  visit_words(words, [&](spv::Op op, LoopWords w) {
    if (op == spv::Op::OpString && text_at(w.subspan(2)) == kMark) texts.insert(w[1]);
    if (op == spv::Op::OpExtInst) (is_mark(op, w) ? sets : used).insert(w[3]);
  });
  if (texts.empty()) return words;
  Words out(words.begin(), words.begin() + kHeaderWords);
  visit_words(words, [&](spv::Op op, LoopWords w) {
    // A set that only marks have used was imported for them.
    const bool is_import =
        op == spv::Op::OpExtInstImport && text_at(w.subspan(2)) == kSet && !used.contains(w[1]);
    if (!is_mark(op, w) && !is_import) out.insert(out.end(), w.begin(), w.end());
  });
  return out;
}

}  // namespace glint::frontend
