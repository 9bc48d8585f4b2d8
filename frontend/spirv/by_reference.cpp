// Finds copies around calls, block by block, and drops them.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/by_reference.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <spirv/unified1/spirv.hpp11>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

struct Code {
  spv::Op op;
  size_t at;  // index of the first word
  std::span<const uint32_t> words;
  uint32_t operator[](size_t i) const { return words[i]; }
};

class Copies {
 public:
  explicit Copies(const std::vector<uint32_t>& words) : words_(words) {
    for (size_t at = kHeaderWords; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16)
      code_.push_back({spv::Op(words[at] & 0xffff), at, std::span(words).subspan(at, words[at] >> 16)});
  }

  std::vector<uint32_t> run() {
    count_uses();
    for (size_t i = 0; i < code_.size(); ++i)
      if (code_[i].op == spv::Op::OpFunctionCall) visit_call(i);
    std::vector<uint32_t> out(words_.begin(), words_.begin() + kHeaderWords);
    for (const Code& c : code_) {
      if (dropped_.count(c.at)) continue;
      const size_t begin = out.size();
      out.insert(out.end(), c.words.begin(), c.words.end());
      const auto changed = arguments_.find(c.at);
      if (changed == arguments_.end()) continue;
      for (const auto& [word, id] : changed->second) out[begin + word] = id;
    }
    return out;
  }

 private:
  // Finds the variables and pointer parameters of functions, and counts how often any word may name an id.
  void count_uses() {
    std::set<uint32_t> local_pointers;
    for (const Code& c : code_) {
      if (c.op == spv::Op::OpTypePointer && spv::StorageClass(c[2]) == spv::StorageClass::Function)
        local_pointers.insert(c[1]);
      const bool is_local = c.op == spv::Op::OpVariable || c.op == spv::Op::OpFunctionParameter;
      if (is_local && local_pointers.count(c[1]))
        locals_[c[2]] = c.op == spv::Op::OpVariable && c.words.size() == 4;
      if (c.op == spv::Op::OpName || c.op == spv::Op::OpMemberName || c.op == spv::Op::OpLine) continue;
      // Words that are not ids count as uses, too. This can only keep a copy that could have gone.
      for (size_t w = 1; w < c.words.size(); ++w) ++uses_[c[w]];
    }
  }

  static bool ends_block(spv::Op op) {
    return op == spv::Op::OpLabel || op == spv::Op::OpFunctionEnd || op == spv::Op::OpFunction;
  }

  // Returns the only instruction between the start of the block and `call` that stores to `variable`.
  const Code* copy_in(size_t call, uint32_t variable, uint32_t* value) const {
    for (size_t i = call; i-- > 0 && !ends_block(code_[i].op);)
      if (code_[i].op == spv::Op::OpStore && code_[i][1] == variable) return *value = code_[i][2], &code_[i];
    return nullptr;
  }

  // Returns true when nothing between two places of a block may write a local variable or take its address.
  bool is_untouched(size_t from, size_t to, uint32_t variable) const {
    for (size_t i = from + 1; i < to; ++i) {
      const Code& c = code_[i];
      if (c.op == spv::Op::OpLoad && c[3] == variable) continue;
      if (c.op == spv::Op::OpFunctionCall || c.op == spv::Op::OpCopyMemory) return false;
      // This store goes through an access chain, which may lead to the variable.
      if (c.op == spv::Op::OpStore && !locals_.count(c[1])) return false;
      if (std::find(c.words.begin() + 1, c.words.end(), variable) != c.words.end()) return false;
    }
    return true;
  }

  void visit_call(size_t call) {
    std::set<uint32_t> passed(code_[call].words.begin() + 4, code_[call].words.end());
    for (size_t word = 4; word < code_[call].words.size(); ++word) pass(call, word, passed);
  }

  // Passes the caller's variable instead of its copy if the copy is stored once, passed once and loaded once,
  // and the loaded value returns to the variable that the stored value came from.
  void pass(size_t call, size_t word, std::set<uint32_t>& passed) {
    const uint32_t copy = code_[call][word];
    const auto local = locals_.find(copy);
    // The copy has one definition and three uses.
    if (local == locals_.end() || !local->second || uses_[copy] != 4) return;
    uint32_t value = 0;
    const Code* const store = copy_in(call, copy, &value);
    if (!store || uses_[value] != 2) return;
    const size_t store_at = size_t(store - code_.data());
    size_t load_at = store_at;
    while (load_at-- > 0 && !ends_block(code_[load_at].op) &&
           !(code_[load_at].op == spv::Op::OpLoad && code_[load_at][2] == value)) {
    }
    if (load_at == size_t(-1) || ends_block(code_[load_at].op) || code_[load_at].words.size() != 4) return;
    const uint32_t variable = code_[load_at][3];
    if (!locals_.count(variable) || passed.count(variable) || !is_untouched(load_at, call, variable)) return;
    size_t back_at = call + 1;
    while (back_at < code_.size() && !ends_block(code_[back_at].op) &&
           !(code_[back_at].op == spv::Op::OpLoad && code_[back_at][3] == copy))
      ++back_at;
    if (back_at + 1 >= code_.size() || ends_block(code_[back_at].op)) return;
    const Code &back = code_[back_at], &put = code_[back_at + 1];
    if (put.op != spv::Op::OpStore || put[1] != variable || put[2] != back[2] || uses_[back[2]] != 2) return;
    if (!is_untouched(call, back_at, variable)) return;
    for (size_t gone : {load_at, store_at, back_at, back_at + 1}) dropped_.insert(code_[gone].at);
    arguments_[code_[call].at][word] = variable;
    passed.insert(variable);
  }

  const std::vector<uint32_t>& words_;
  std::vector<Code> code_;
  // Holds the ids of variables and parameters in Function storage. The value is true for a variable without
  // initialiser.
  std::map<uint32_t, bool> locals_;
  std::map<uint32_t, uint32_t> uses_;
  std::set<size_t> dropped_;  // first words of instructions
  // Maps the first word of a call to the words of its arguments and the variables to pass.
  std::map<size_t, std::map<size_t, uint32_t>> arguments_;
};

}  // namespace

std::vector<uint32_t> with_references(const std::vector<uint32_t>& spirv) {
  return Copies(spirv).run();
}

}  // namespace glint::frontend
